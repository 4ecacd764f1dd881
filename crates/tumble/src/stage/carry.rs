//! Bodies whose motion is prescribed go where it says.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};

use crate::{Batch, BodyModel, BodyState, Motion, Oscillation};

/// Moves every body whose motion is prescribed from `from` to `until` (s) after the beginning of the step.
pub fn carry(batch: &mut Batch, from: f64, until: f64) {
    let time = batch.time;
    for (body, state) in batch.model.bodies[batch.first..].iter().zip(&mut *batch.bodies) {
        if let Motion::Prescribed(given) = &body.motion {
            let swing = given.oscillation.as_ref();
            advance(body, state, swing, (time + from, time + until));
        }
    }
}

/// From one time (s) to another.
fn advance(
    body: &BodyModel,
    state: &mut BodyState,
    swing: Option<&Oscillation>,
    (from, until): (f64, f64),
) {
    let h = until - from;
    let zero = (DVec3::ZERO, DVec3::ZERO);
    let (old_place, old_velocity) = swing.map_or(zero, |swing| swing.at(from));
    let (place, velocity) = swing.map_or(zero, |swing| swing.at(until));
    let steady = state.velocity - old_velocity;
    state.position += steady * h + (place - old_place);
    state.velocity = steady + velocity;
    let rotation = DMat3::from_quat(state.orientation);
    let omega = body.angular_velocity(rotation, state.angular_momentum);
    if omega != DVec3::ZERO {
        let turn = DQuat::from_scaled_axis(omega * h);
        state.orientation = (turn * state.orientation).normalize();
        // L follows the inertia, so that ω stays
        let rotation = DMat3::from_quat(state.orientation);
        state.angular_momentum = rotation * (body.inertia * (rotation.transpose() * omega));
    }
}

impl Oscillation {
    /// A (sin(2π f t + φ) − sin φ) (m) and its rate (m/s).
    pub fn at(&self, time: f64) -> (DVec3, DVec3) {
        let rate = TAU * self.frequency;
        let (sin, cos) = libm::sincos(rate * time + self.phase);
        let start = libm::sin(self.phase);
        (self.amplitude * (sin - start), self.amplitude * (rate * cos))
    }
}
