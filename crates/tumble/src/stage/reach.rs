//! Which bodies can touch a wall within a step: no particle of the others is looked at.

use crate::{Batch, BodyModel, BodyState, Model, WallPlane};

/// Marks the bodies that a wall may be within reach of during the next `h` seconds.
///
/// Drag takes energy and gives none, so no particle gets farther than radius + (v + |g| h) h, with v = |v|, or
/// with v = √(2 E/M) where drag may turn spin into speed (mass that is not carried by equal particles).
pub fn reach(batch: &mut Batch, h: f64) {
    let model = batch.model;
    let bodies = model.bodies[batch.first..].iter().zip(&*batch.bodies).zip(&*batch.springs);
    let derived = batch.near.iter_mut().zip(&mut *batch.forces).zip(&mut *batch.next);
    for (((body, state), springs), ((near, forces), next)) in bodies.zip(derived) {
        if model.meets {
            // where others are is not asked here
            *near = body.is_free();
            continue;
        }
        // who is far feels nothing, and who is held neither
        forces.clear_contact();
        next.clear();
        *near = body.is_free() && !(springs.is_empty() && is_far(model, body, state, h));
    }
}

fn is_far(model: &Model, body: &BodyModel, state: &BodyState, h: f64) -> bool {
    let speed = if body.drag_modes.is_some() {
        let place = super::Placed::new(body, state);
        (2.0 * place.kinetic_energy(state.angular_momentum) / body.mass).sqrt()
    } else {
        state.velocity.length()
    };
    let way = h * (speed + h * model.gravity.length());
    let reach = body.reach() + way * (1.0 + 1e-9);
    let far = |wall: &WallPlane| wall.depth(state.position) < -reach;
    model.walls.iter().all(far)
}
