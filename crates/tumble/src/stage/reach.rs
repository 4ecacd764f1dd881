//! Which bodies can touch a wall within a step: no particle of the others is looked at.

use crate::{Model, Scratch, State};

/// Marks the bodies that a wall may be within reach of during the next `h` seconds.
///
/// Drag takes energy and gives none, so no particle gets farther than radius + (v + |g| h) h, with v = |v|, or
/// with v = √(2 E/M) where drag may turn spin into speed (mass that is not carried by equal particles).
pub fn reach(model: &Model, state: &State, scratch: &mut Scratch, h: f64) {
    for (index, body) in model.bodies.iter().enumerate() {
        if model.meets {
            // where others are is not asked here
            scratch.near[index] = body.is_free();
            continue;
        }
        if !body.is_free() {
            // walls and forces do nothing to it
            scratch.forces[index].clear_contact();
            scratch.springs[index].clear();
            scratch.near[index] = false;
            continue;
        }
        let body_state = &state.bodies[index];
        let speed = if body.drag_modes.is_some() {
            let place = super::Placed::new(body, body_state);
            (2.0 * place.kinetic_energy(body_state.angular_momentum) / body.mass).sqrt()
        } else {
            body_state.velocity.length()
        };
        let way = h * (speed + h * model.gravity.length());
        let reach = body.reach() + way * (1.0 + 1e-9);
        let far = |wall: &crate::WallPlane| wall.depth(body_state.position) < -reach;
        // who is far feels nothing
        scratch.forces[index].clear_contact();
        scratch.springs[index].clear();
        scratch.near[index] = !(state.springs[index].is_empty() && model.walls.iter().all(far));
    }
}
