//! `energy.csv`: the energy ledger, one row per frame.

use std::io::{self, Write};

use tumble::{Energy, Integrator};

use super::trajectory::write_row;
use crate::plot::EnergyRow;
use crate::scene::Scene;

/// The columns of `energy.csv` that every run has.
pub const ENERGY_HEADER: &str =
    "time,kinetic,gravitational,elastic,drag,dashpot,slip,total,residual";

/// The columns of `energy.csv` that only some runs have, after the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnergyColumns {
    /// `numerical`, with the integrator `implicit`.
    pub numerical: bool,
    /// `work`, if [`Scene::does_work`].
    pub work: bool,
    /// `spring`, `motor` and `joint_friction`, if there are joints.
    pub joints: bool,
}

impl EnergyColumns {
    /// Those of the runs of a scene.
    pub fn new(scene: &Scene) -> Self {
        let numerical = scene.integrator == Integrator::Implicit;
        Self { numerical, work: scene.does_work(), joints: !scene.joints.is_empty() }
    }

    /// The first line of `energy.csv`.
    pub fn header(self) -> String {
        let names = [
            (self.numerical, ",numerical"),
            (self.work, ",work"),
            (self.joints, ",spring,motor,joint_friction"),
        ];
        let names = names.into_iter().filter_map(|(is_there, name)| is_there.then_some(name));
        ENERGY_HEADER.to_owned() + &names.collect::<String>()
    }
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
        numerical: energy.numerical,
        work: energy.work,
        spring: energy.spring,
        motor: energy.motor,
        joint_friction: energy.joint_friction,
        total: energy.total(),
        residual: energy.total() - energy_start,
    }
}

/// Writes a ledger row.
pub(super) fn write_energy(
    out: &mut impl Write,
    row: &EnergyRow,
    columns: EnergyColumns,
) -> io::Result<()> {
    let EnergyRow { kinetic, gravitational, elastic, drag, dashpot, slip, .. } = *row;
    let EnergyRow { time, numerical, work, total, residual, .. } = *row;
    let common = [kinetic, gravitational, elastic, drag, dashpot, slip, total, residual];
    let EnergyRow { spring, motor, joint_friction, .. } = *row;
    let others = [
        (columns.numerical, numerical),
        (columns.work, work),
        (columns.joints, spring),
        (columns.joints, motor),
        (columns.joints, joint_friction),
    ];
    let others = others.into_iter().filter_map(|(is_there, value)| is_there.then_some(value));
    let numbers: Vec<f64> = common.into_iter().chain(others).collect();
    write_row(out, (time, None), &numbers)
}
