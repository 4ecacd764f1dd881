//! How often a long implicit step is divided.

use crate::contact::sphere_radius;
use crate::kinematics::Kinematics;
use crate::{Model, State, Surface};

/// A step is divided into at most this many.
const MOST: u32 = 32;

/// The number of parts that a step is divided into: so many that no body moves farther in one than the smallest radius of a sphere, or a
/// quarter of the smallest thickness of a mesh. Contacts are found anew in each part.
pub fn implicit_step_count(model: &Model, state: &State) -> u32 {
    let reaches = model.bodies.iter().filter(|body| body.surface != Surface::None);
    let reaches = reaches.map(|body| match &body.signed_distance {
        Some(distance) => 0.25 * distance.thickness(),
        None => sphere_radius(body),
    });
    let reach = reaches.filter(|&reach| reach > 0.0).fold(f64::INFINITY, f64::min);
    if reach == f64::INFINITY {
        return 1;
    }
    let bodies = model.bodies.iter().zip(&state.bodies);
    let speeds = bodies.filter(|(body, _)| body.surface != Surface::None).map(|(body, state)| {
        let omega = Kinematics::new(body, state).angular_velocity;
        state.velocity.length() + omega.length() * body.extent
    });
    let speed = speeds.fold(0.0, f64::max) + model.gravity.length() * model.dt;
    let parts = (model.dt * speed / reach).ceil();
    // NaN and infinity are found by the check at the end of the step
    if parts > 1.0 { (parts as u32).min(MOST) } else { 1 }
}
