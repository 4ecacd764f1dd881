//! Free flight: bodies that no wall can reach within the step. None of their particles is looked at.

use crate::kinematics::Kinematics;
use crate::{Batch, BodyModel, BodyState, Model, WallPlane};

/// Marks the bodies that may touch something within the next `h` seconds; the others are in free flight.
///
/// Where bodies can touch each other every free body is marked: the neighbour lists decide later. Otherwise a body is in
/// free flight when no particle can get to a wall. Drag only takes energy, so no particle moves farther than
/// (v + |g| h) h, with v = |v|, or with v = √(2 E/M) where drag can turn spin into speed (mass that is not carried by equal
/// particles).
pub fn find_free_flight(batch: &mut Batch, h: f64) {
    let model = batch.model;
    let bodies = model.bodies[batch.first..].iter().zip(&*batch.bodies).zip(&*batch.springs);
    let derived = batch.may_touch.iter_mut().zip(&mut *batch.forces).zip(&mut *batch.next_springs);
    for (((body, state), springs), ((may_touch, forces), next_springs)) in bodies.zip(derived) {
        if model.has_body_contact {
            *may_touch = body.is_free();
            continue;
        }
        // bodies in free flight and kinematic bodies have no contact forces in this step
        forces.clear_contact();
        next_springs.clear();
        *may_touch =
            body.is_free() && !(springs.is_empty() && is_out_of_reach(model, body, state, h));
    }
}

fn is_out_of_reach(model: &Model, body: &BodyModel, state: &BodyState, h: f64) -> bool {
    let speed = if body.drag_modes.is_some() {
        let kinematics = Kinematics::new(body, state);
        (2.0 * kinematics.kinetic_energy(state.angular_momentum) / body.mass).sqrt()
    } else {
        state.velocity.length()
    };
    let displacement = h * (speed + h * model.gravity.length());
    let distance = body.bounding_radius() + displacement * (1.0 + 1e-9);
    let is_far = |wall: &WallPlane| wall.depth(state.position) < -distance;
    model.walls.iter().all(is_far)
}
