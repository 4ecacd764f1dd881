//! `energy.csv`: where every joule is, one row a frame.

use std::io::{self, Write};

use tumble::Energy;

use super::trajectory::write_row;
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

/// Writes the row, numbers in the shortest form that reads back to the same double.
pub(super) fn write_ledger(out: &mut impl Write, row: &EnergyRow) -> io::Result<()> {
    let EnergyRow { time, kinetic, gravitational, elastic, drag, dashpot, slip, total, residual } =
        *row;
    let numbers = [kinetic, gravitational, elastic, drag, dashpot, slip, total, residual];
    write_row(out, (time, None), &numbers)
}
