//! Line 9 of the basic system and beyond: contact of particles with walls.

use crate::Batch;
use crate::contact::wall::{WallContactOutput, WallContacts, wall_contact_forces};
use crate::contact::{Kick, SinceKick};
use crate::kinematics::Kinematics;

/// Sets the wall contact forces on every body that may touch a wall, for a kick over the time `h` (s): dashpots see the mean
/// of the velocities before and after the kick. With h = 0 they see the velocities as they are.
///
/// Where bodies touch each other, the kick is not known yet. The forces then serve to predict it, and `wall_contact_again`
/// follows. Bodies of spheres meet walls in [`around_body_contact`](super::around_body_contact).
pub fn wall_contact(batch: &mut Batch, h: f64) {
    let since_kick = SinceKick::at_kick(batch.model, batch.time);
    let Batch {
        model,
        first,
        bodies,
        springs,
        may_touch,
        forces,
        next_springs,
        workspaces,
        start,
        ..
    } = batch;
    let predicts = model.has_body_contact && h != 0.0;
    let workspace = &mut workspaces[0];
    if predicts {
        workspace.wall_contacts.resize_with(bodies.len(), WallContacts::default);
    }
    let bodies = model.bodies[*first..].iter().zip(&**bodies).zip(&**springs).zip(&**may_touch);
    let outputs = forces.iter_mut().zip(next_springs.iter_mut());
    for (index, ((((body, state), springs), &may_touch), (forces, next_springs))) in
        bodies.zip(outputs).enumerate()
    {
        let start = start.get(*first + index).filter(|_| model.joints.acts_on(*first + index));
        let kick = Kick { length: h, since_last: &since_kick, start };
        if !may_touch || body.has_spheres() {
            forces.clear_contact();
            next_springs.clear();
        } else if predicts {
            let contacts = &mut workspace.wall_contacts[index];
            contacts.predict(model, body, state, springs, (forces, next_springs), kick);
        } else {
            let contacts = &mut workspace.contacts;
            let output = WallContactOutput { forces, next_springs, contacts };
            wall_contact_forces(model, body, state, springs, output, kick);
        }
    }
}

/// Sets the forces of the same wall contacts again, at the velocities that the poses have: those in the middle of the kick by
/// the contact forces of walls and of other bodies.
pub fn wall_contact_again(batch: &mut Batch) {
    let Batch { model, first, bodies, poses, forces, next_springs, workspaces, .. } = batch;
    let contacts = &mut workspaces[0].wall_contacts;
    let bodies = model.bodies[*first..].iter().zip(&**bodies).zip(&**poses);
    let outputs = forces.iter_mut().zip(next_springs.iter_mut());
    for ((((body, state), pose), contacts), (forces, next_springs)) in
        bodies.zip(contacts).zip(outputs)
    {
        // forces are those of walls alone
        if forces.max_depth > 0.0 && body.is_damped {
            let (velocity, angular_velocity) = (pose.velocity, pose.angular_velocity);
            let kinematics =
                Kinematics { velocity, angular_velocity, ..Kinematics::new(body, state) };
            contacts.evaluate_again(model, &kinematics, forces, next_springs);
        }
    }
}
