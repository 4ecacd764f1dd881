//! `energy.csv`: where every joule is, one row a frame.

use std::io::{self, Write};

use tumble::Energy;

use super::trajectory::write_row;
use crate::plot::EnergyRow;

/// The columns of a scene in which nothing does work.
pub const LEDGER_HEADER: &str =
    "time,kinetic,gravitational,elastic,drag,dashpot,slip,total,residual";

/// The columns of a scene with bodies that do work.
const HEADER_WITH_WORK: &str =
    "time,kinetic,gravitational,elastic,drag,dashpot,slip,total,residual,work";

/// The columns; `work` only where bodies do some (see [`Scene::does_work`](crate::scene::Scene::does_work)).
pub fn ledger_header(has_work: bool) -> &'static str {
    if has_work { HEADER_WITH_WORK } else { LEDGER_HEADER }
}

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
        work: energy.work,
        total: energy.total(),
        residual: energy.total() - start,
    }
}

/// Writes the row, numbers in the shortest form that reads back to the same double.
pub(super) fn write_ledger(
    out: &mut impl Write,
    row: &EnergyRow,
    has_work: bool,
) -> io::Result<()> {
    let EnergyRow { time, kinetic, gravitational, elastic, drag, .. } = *row;
    let EnergyRow { dashpot, slip, work, total, residual, .. } = *row;
    let numbers = [kinetic, gravitational, elastic, drag, dashpot, slip, total, residual, work];
    let count = if has_work { 9 } else { 8 };
    write_row(out, (time, None), &numbers[..count])
}
