//! Kinematic bodies: bodies whose motion is prescribed.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};

use crate::{Batch, BodyModel, BodyState, Motion, Oscillation};

/// Moves every kinematic body from `from` to `until`, both in seconds after the beginning of the step.
pub fn move_kinematic(batch: &mut Batch, from: f64, until: f64) {
    let time = batch.time;
    for (body, state) in batch.model.bodies[batch.first..].iter().zip(&mut *batch.bodies) {
        if let Motion::Prescribed(prescribed) = &body.motion {
            let oscillation = prescribed.oscillation.as_ref();
            advance(body, state, oscillation, (time + from, time + until));
        }
    }
}

/// Moves one body from one time (s) to another.
fn advance(
    body: &BodyModel,
    state: &mut BodyState,
    oscillation: Option<&Oscillation>,
    (from, until): (f64, f64),
) {
    let h = until - from;
    let zero = (DVec3::ZERO, DVec3::ZERO);
    let (old_offset, old_velocity) = oscillation.map_or(zero, |oscillation| oscillation.at(from));
    let (offset, velocity) = oscillation.map_or(zero, |oscillation| oscillation.at(until));
    let steady = state.velocity - old_velocity;
    state.move_by(steady * h + (offset - old_offset));
    state.velocity = steady + velocity;
    let rotation = DMat3::from_quat(state.orientation);
    let omega = body.angular_velocity(rotation, state.angular_momentum);
    if omega != DVec3::ZERO {
        let turn = DQuat::from_scaled_axis(omega * h);
        state.orientation = (turn * state.orientation).normalize();
        // L follows the inertia, so that ω stays constant
        let rotation = DMat3::from_quat(state.orientation);
        state.angular_momentum = rotation * (body.inertia * (rotation.transpose() * omega));
    }
}

impl Oscillation {
    /// Displacement A (sin(2π f t + φ) − sin φ) (m) and its rate (m/s) at a time (s).
    pub fn at(&self, time: f64) -> (DVec3, DVec3) {
        let rate = TAU * self.frequency;
        let (sin, cos) = libm::sincos(rate * time + self.phase);
        let start = libm::sin(self.phase);
        (self.amplitude * (sin - start), self.amplitude * (rate * cos))
    }
}
