//! `energy.csv`: where every joule is, one row a frame.

use tumble::Energy;

use crate::plot::EnergyRow;

/// The columns.
pub const LEDGER_HEADER: &str =
    "time,kinetic,gravitational,elastic,drag,dashpot,slip,total,residual";

/// The row of one frame; the residual is what the total has moved away from `start` (J).
pub fn ledger_row(time: f64, energy: &Energy, start: f64) -> EnergyRow {
    EnergyRow {
        time,
        kinetic: energy.kinetic,
        gravitational: energy.gravitational,
        elastic: energy.elastic,
        drag: energy.drag,
        dashpot: energy.dashpot,
        slip: energy.slip,
        total: energy.total(),
        residual: energy.total() - start,
    }
}

/// The row as text, numbers in the shortest form that reads back to the same double.
pub(super) fn line(row: &EnergyRow) -> String {
    let EnergyRow { time, kinetic, gravitational, elastic, drag, dashpot, slip, total, residual } =
        row;
    format!(
        "{time:?},{kinetic:?},{gravitational:?},{elastic:?},{drag:?},{dashpot:?},{slip:?},{total:?},{residual:?}"
    )
}
