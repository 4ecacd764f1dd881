//! Line 9 of the basic system and beyond: contact of particles with walls.

use crate::Batch;
use crate::contact::SinceKick;
use crate::contact::wall::{WallContactOutput, wall_contact_forces};

/// Sets the wall contact forces on every body that may touch a wall, for a kick over the time `h` (s): dashpots see the mean
/// of the velocities before and after the kick. With h = 0 they see the velocities as they are.
///
/// Bodies of spheres meet walls in [`around_body_contact`](super::around_body_contact).
pub fn wall_contact(batch: &mut Batch, h: f64) {
    let since_kick = SinceKick::at_kick(batch.model, batch.time);
    let Batch {
        model, first, bodies, springs, may_touch, forces, next_springs, workspaces, ..
    } = batch;
    let bodies = model.bodies[*first..].iter().zip(&**bodies).zip(&**springs).zip(&**may_touch);
    let friction_contacts = &mut workspaces[0].friction_contacts;
    for ((((body, state), springs), &may_touch), (forces, next_springs)) in
        bodies.zip(forces.iter_mut().zip(next_springs.iter_mut()))
    {
        if may_touch && !body.has_spheres() {
            let output = WallContactOutput { forces, next_springs, friction_contacts };
            wall_contact_forces(model, body, state, springs, output, h, &since_kick);
        } else {
            forces.clear_contact();
            next_springs.clear();
        }
    }
}
