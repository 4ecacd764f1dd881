//! `energy.csv`: the energy ledger, one row per frame.

use std::io::{self, Write};

use tumble::Energy;

use super::trajectory::write_row;
use crate::plot::EnergyRow;

/// Columns of `energy.csv` for a scene in which nothing does work.
pub const ENERGY_HEADER: &str =
    "time,kinetic,gravitational,elastic,drag,dashpot,slip,total,residual";

/// Columns of `energy.csv` for a scene in which a body or belt may do work.
const HEADER_WITH_WORK: &str =
    "time,kinetic,gravitational,elastic,drag,dashpot,slip,total,residual,work";

/// Columns of `energy.csv`.
///
/// The column `work` exists only if [`Scene::does_work`](crate::scene::Scene::does_work).
pub fn energy_header(has_work: bool) -> &'static str {
    if has_work { HEADER_WITH_WORK } else { ENERGY_HEADER }
}

/// The ledger row at `time` (s). The residual is the total minus `energy_start` (J).
pub fn energy_row(time: f64, energy: &Energy, energy_start: f64) -> EnergyRow {
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
        residual: energy.total() - energy_start,
    }
}

/// Writes a ledger row.
pub(super) fn write_energy(
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
