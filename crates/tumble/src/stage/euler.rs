//! Lines 5 to 7: the basic system's way to advance a body.

use glam::{DMat3, DQuat, DVec3};

use crate::{BodyForces, BodyModel, BodyState, Model, Scratch, State};

/// Advances every body by h with the forces of the start of the step.
pub fn euler(model: &Model, state: &mut State, scratch: &Scratch) {
    for ((body, body_state), forces) in
        model.bodies.iter().zip(&mut state.bodies).zip(&scratch.forces)
    {
        state.tally.drag += advance(body, body_state, forces, model.dt);
        state.tally.max_depth = state.tally.max_depth.max(forces.max_depth);
    }
}

/// Advances one body and returns the energy that drag took from it (J).
fn advance(body: &BodyModel, state: &mut BodyState, forces: &BodyForces, h: f64) -> f64 {
    let old_velocity = state.velocity;
    let old_omega = angular_velocity(body, state);
    let total = forces.total();

    // 5: velocity first, then position with the new velocity
    state.velocity += total.force / body.mass * h;
    state.position += state.velocity * h;

    // 6: the quaternion turns with the angular velocity of the start of the step
    let spin = DQuat::from_xyzw(old_omega.x, old_omega.y, old_omega.z, 0.0);
    state.orientation = (state.orientation + spin * state.orientation * (0.5 * h)).normalize();

    // 7: angular momentum; ω follows from it through the inertia turned by the new orientation
    state.angular_momentum += total.torque * h;
    let new_omega = angular_velocity(body, state);

    // the work of a force over the step is F·h times the mean velocity: exactly its kinetic energy
    let mean_velocity = 0.5 * (old_velocity + state.velocity);
    let mean_omega = 0.5 * (old_omega + new_omega);
    -h * (forces.drag.force.dot(mean_velocity) + forces.drag.torque.dot(mean_omega))
}

/// 7: I⁻¹ = R I₀⁻¹ Rᵀ, ω = I⁻¹ L.
fn angular_velocity(body: &BodyModel, state: &BodyState) -> DVec3 {
    body.angular_velocity(DMat3::from_quat(state.orientation), state.angular_momentum)
}
