//! The kick: the impulse of the contact forces at fixed position and orientation.

use crate::kinematics::Kinematics;
use crate::{Batch, BodyForces, BodyModel, BodyState, RunTotals};

/// Applies the contact forces for the time `h` (s): v ← v + F h/M, L ← L + τ h.
pub fn kick(batch: &mut Batch, h: f64) {
    let mut totals = *batch.totals();
    let bodies = batch.model.bodies[batch.first..].iter().zip(&mut *batch.bodies);
    for (((body, state), forces), &may_touch) in bodies.zip(&*batch.forces).zip(&*batch.may_touch) {
        if !body.is_free() {
            totals += kinematic_totals(body, state, forces, h);
        } else if may_touch {
            totals += kick_body(body, state, forces, h);
        }
    }
    *batch.totals() = totals;
    // bodies in free flight have no springs
    let springs = batch.springs.iter_mut().zip(&mut *batch.next_springs);
    for ((springs, next_springs), _) in
        springs.zip(&*batch.may_touch).filter(|(_, may_touch)| **may_touch)
    {
        std::mem::swap(springs, next_springs);
    }
}

/// Kicks one body; returns what its contacts dissipate.
///
/// The pose is fixed, so the work of a wrench is exactly its power at the mean of the old and new velocities, times h.
pub(super) fn kick_body(
    body: &BodyModel,
    state: &mut BodyState,
    forces: &BodyForces,
    h: f64,
) -> RunTotals {
    if forces.max_depth == 0.0 && !forces.has_others() {
        return RunTotals { slip: forces.slip_loss, ..RunTotals::default() };
    }
    let total = forces.kick();
    let mean = Kinematics::new(body, state).at_mid_kick(&total, h);
    state.velocity += total.force * (h / body.mass);
    state.angular_momentum += total.torque * h;
    RunTotals {
        dashpot: h * (mean.dissipated_power(&forces.dashpot) + forces.surface_dashpot_power),
        slip: forces.slip_loss,
        work: h * (forces.surface_power - mean.dissipated_power(&forces.given_load())),
        max_depth: forces.max_depth,
        evaluations: u64::from(forces.max_depth > 0.0),
        ..RunTotals::default()
    }
}

/// What a kinematic body adds to the totals: the work that it does against its contact forces, and the part of the
/// dissipation in dashpots that is due to its own velocity.
pub(super) fn kinematic_totals(
    body: &BodyModel,
    state: &BodyState,
    forces: &BodyForces,
    h: f64,
) -> RunTotals {
    let kinematics = Kinematics::new(body, state);
    RunTotals {
        work: h * (kinematics.dissipated_power(&forces.of_others()) + forces.surface_power),
        dashpot: h * (kinematics.dissipated_power(&forces.dashpot) + forces.surface_dashpot_power),
        slip: forces.slip_loss,
        max_depth: forces.max_depth,
        ..RunTotals::default()
    }
}
