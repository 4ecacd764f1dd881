//! Lines 5 to 7: the basic system's way to advance a body.

use glam::{DMat3, DQuat, DVec3};

use super::kick::resist;
use crate::state::NO_REST;
use crate::{Batch, BodyForces, BodyModel, BodyState, Tally, Wrench};

/// Advances every body by h with the forces of the start of the step.
pub fn euler(batch: &mut Batch) {
    let h = batch.model.dt;
    let mut tally = *batch.tally();
    let bodies = batch.model.bodies[batch.first..].iter().zip(&mut *batch.bodies);
    let springs = batch.springs.iter_mut().zip(&mut *batch.next);
    for (((body, state), forces), (springs, next)) in bodies.zip(&*batch.forces).zip(springs) {
        if body.is_free() {
            advance(body, state, forces, h, &mut tally);
            std::mem::swap(springs, next);
        } else {
            tally += resist(body, state, forces, h);
        }
    }
    *batch.tally() = tally;
}

/// Advances one body.
fn advance(
    body: &BodyModel,
    state: &mut BodyState,
    forces: &BodyForces,
    h: f64,
    tally: &mut Tally,
) {
    let old_velocity = state.velocity;
    let old_omega = angular_velocity(body, state);
    let total = forces.total();

    // 5: velocity first, then position with the new velocity
    state.velocity += total.force / body.mass * h;
    state.position += state.velocity * h;

    // 6: the quaternion turns with the angular velocity of the start of the step
    let spin = DQuat::from_xyzw(old_omega.x, old_omega.y, old_omega.z, 0.0);
    state.orientation = (state.orientation + spin * state.orientation * (0.5 * h)).normalize();
    state.orientation_rest = NO_REST;

    // 7: angular momentum; ω follows from it through the inertia turned by the new orientation
    state.angular_momentum += total.torque * h;
    *tally += Tally {
        slip: forces.slip,
        work: h * forces.belt_power,
        dashpot: h * forces.belt_loss,
        max_depth: forces.max_depth,
        evaluations: u64::from(forces.max_depth > 0.0),
        ..Tally::default()
    };
    if forces.drag == Wrench::default() && forces.dashpot == Wrench::default() {
        return;
    }

    // the work of a force over the step is F·h times the mean velocity: exactly its kinetic energy
    let new_omega = angular_velocity(body, state);
    let mean_velocity = 0.5 * (old_velocity + state.velocity);
    let mean_omega = 0.5 * (old_omega + new_omega);
    let lost =
        |wrench: &Wrench| -h * (wrench.force.dot(mean_velocity) + wrench.torque.dot(mean_omega));
    tally.drag += lost(&forces.drag);
    tally.dashpot += lost(&forces.dashpot);
}

/// 7: I⁻¹ = R I₀⁻¹ Rᵀ, ω = I⁻¹ L.
fn angular_velocity(body: &BodyModel, state: &BodyState) -> DVec3 {
    body.angular_velocity(DMat3::from_quat(state.orientation), state.angular_momentum)
}
