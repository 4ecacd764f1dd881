//! Lines 5 to 7 of the basic system: semi-implicit Euler for position, explicit Euler for orientation.

use glam::{DMat3, DQuat, DVec3};

use super::kick::kinematic_totals;
use crate::state::NO_COMPENSATION;
use crate::{Batch, BodyForces, BodyModel, BodyState, RunTotals, Wrench};

/// Advances every free body by h with the forces of the start of the step.
pub fn euler(batch: &mut Batch) {
    let h = batch.model.dt;
    let mut totals = *batch.totals();
    let bodies = batch.model.bodies[batch.first..].iter().zip(&mut *batch.bodies);
    let springs = batch.springs.iter_mut().zip(&mut *batch.next_springs);
    for (((body, state), forces), (springs, next_springs)) in
        bodies.zip(&*batch.forces).zip(springs)
    {
        if body.is_free() {
            advance(body, state, forces, h, &mut totals);
            std::mem::swap(springs, next_springs);
        } else {
            totals += kinematic_totals(body, state, forces, h);
        }
    }
    *batch.totals() = totals;
}

/// Advances one body.
fn advance(
    body: &BodyModel,
    state: &mut BodyState,
    forces: &BodyForces,
    h: f64,
    totals: &mut RunTotals,
) {
    let old_velocity = state.velocity;
    let old_omega = angular_velocity(body, state);
    let total = forces.total();

    // 5: velocity first, then position with the new velocity
    state.velocity += total.force / body.mass * h;
    state.position += state.velocity * h;
    state.position_compensation = DVec3::ZERO;

    // 6: quaternion update with the angular velocity of the start of the step
    let omega = DQuat::from_xyzw(old_omega.x, old_omega.y, old_omega.z, 0.0);
    state.orientation = (state.orientation + omega * state.orientation * (0.5 * h)).normalize();
    state.orientation_compensation = NO_COMPENSATION;

    // 7: angular momentum; ω follows from it through the inertia in the new orientation
    state.angular_momentum += total.torque * h;
    *totals += RunTotals {
        slip: forces.slip_loss,
        work: h * forces.surface_power,
        dashpot: h * forces.surface_dashpot_power,
        max_depth: forces.max_depth,
        evaluations: u64::from(forces.max_depth > 0.0),
        ..RunTotals::default()
    };
    if forces.drag == Wrench::default() && forces.dashpot == Wrench::default() {
        return;
    }

    // F·h times the mean velocity is exactly the kinetic energy that a force adds over the step
    let new_omega = angular_velocity(body, state);
    let mean_velocity = 0.5 * (old_velocity + state.velocity);
    let mean_omega = 0.5 * (old_omega + new_omega);
    let dissipated =
        |wrench: &Wrench| -h * (wrench.force.dot(mean_velocity) + wrench.torque.dot(mean_omega));
    totals.drag += dissipated(&forces.drag);
    totals.dashpot += dissipated(&forces.dashpot);
}

/// 7: I⁻¹ = R I₀⁻¹ Rᵀ, ω = I⁻¹ L.
fn angular_velocity(body: &BodyModel, state: &BodyState) -> DVec3 {
    body.angular_velocity(DMat3::from_quat(state.orientation), state.angular_momentum)
}
