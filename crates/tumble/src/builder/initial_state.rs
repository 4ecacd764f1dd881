//! The initial state of a body.

use glam::{DMat3, DVec3};

use super::body::Body;
use crate::{BodyModel, BodyState, BuildError, Motion, Prescribed};

/// The initial state of a body, with L = R I₀ Rᵀ ω.
pub(super) fn body_state(
    model: &BodyModel,
    name: &str,
    body: &Body,
) -> Result<BodyState, BuildError> {
    let refuse = |quantity, value: &dyn std::fmt::Display, allowed| {
        Err(BuildError::Body { body: name.to_owned(), quantity, value: value.to_string(), allowed })
    };
    let position = body.position.unwrap_or(body.shape.centre());
    let three = "three finite numbers";
    if !position.is_finite() {
        return refuse("position", &position, three);
    }
    let body_velocity = body.velocity.unwrap_or(DVec3::ZERO);
    let body_omega = body.angular_velocity.unwrap_or(DVec3::ZERO);
    if !body_velocity.is_finite() {
        return refuse("initial_velocity", &body_velocity, three);
    }
    let q = body.orientation;
    let largest = q.to_array().iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if !(q.is_finite() && largest > 0.0) {
        return refuse("orientation", &q, "four finite numbers w, x, y, z, not all 0");
    }
    let orientation = if q.is_normalized() { q } else { (q / largest).normalize() };
    let rotation = DMat3::from_quat(orientation);
    let angular_momentum = rotation * (model.inertia * (rotation.transpose() * body_omega));
    if !angular_momentum.is_finite() {
        return refuse("initial_angular_velocity", &body_omega, three);
    }
    // a free body may have it: it does not turn about an axis without inertia
    let lost = model.angular_velocity(rotation, angular_momentum) - body_omega;
    if !model.is_free() && lost.length() > 1e-9 * body_omega.length() {
        let allowed =
            "about an axis about which the body has inertia; mass_model = \"solid\" gives it some";
        return refuse("initial_angular_velocity", &body_omega, allowed);
    }
    let oscillation_velocity = match &body.motion {
        Motion::Prescribed(Prescribed { oscillation: Some(oscillation), .. }) => {
            oscillation.at(0.0).1
        }
        _ => DVec3::ZERO,
    };
    let velocity = body_velocity + oscillation_velocity;
    if !velocity.is_finite() {
        return refuse("oscillation", &oscillation_velocity, "no faster than a double can hold");
    }
    Ok(BodyState { position, velocity, orientation, angular_momentum, ..BodyState::default() })
}
