//! Which bodies can touch a wall within a step.

use crate::{Model, Scratch, State};

/// Marks the bodies that a wall may be within reach of during the next `h` seconds.
///
/// Drag only slows down, so no particle gets farther than radius + (|v| + |g| h) h.
pub fn reach(model: &Model, state: &State, scratch: &mut Scratch, h: f64) {
    for (index, body) in model.bodies.iter().enumerate() {
        let body_state = &state.bodies[index];
        let way = h * (body_state.velocity.length() + h * model.gravity.length());
        let reach = body.reach() + way * (1.0 + 1e-9);
        let far = |wall: &crate::WallPlane| wall.depth(body_state.position) < -reach;
        scratch.near[index] = !(state.springs[index].is_empty() && model.walls.iter().all(far));
    }
}
