//! The contacts of the latest step, one by one.
//!
//! A step keeps only sums over contacts. For the integrators `splitting` and `euler` the kick is therefore evaluated once more, from
//! the state before the step; `implicit` still has its impulses.

use glam::DVec3;

use crate::contact::wall::WallKick;
use crate::contact::{Kick, SinceKick};
use crate::{
    Batch, BodyForces, BodyModel, Integrator, Model, Scratch, State, Wrench, for_each_batch, stage,
};

/// What a body touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ContactPartner {
    /// A wall, by its index in [`Model::walls`].
    Wall(usize),
    /// Another body, by its index.
    Body(usize),
}

/// One contact: a point of a body that is in a wall or in another body. World axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the body.
    pub body: usize,
    /// What it touches.
    pub other: ContactPartner,
    /// Where the force acts (m).
    pub point: DVec3,
    /// Unit normal, from the other to the body.
    pub normal: DVec3,
    /// Penetration depth (m). It is 0 under [`Integrator::Implicit`] for a contact that closes after the kick.
    pub depth: f64,
    /// Force on the body (N): springs, dashpots and friction. The opposite force acts on the other.
    pub force: DVec3,
    /// Torque on the body about its centre of mass (N·m). At edges of meshes it is more than that of the force at the point: such a contact
    /// moves along the edge as the body turns.
    pub torque: DVec3,
    /// Torque on the other body about its centre of mass (N·m).
    pub other_torque: DVec3,
}

impl Contact {
    /// The wrench of this contact on a body; zero on a body that has no part in it.
    pub fn wrench_on(&self, body: usize) -> Wrench {
        if self.body == body {
            Wrench { force: self.force, torque: self.torque }
        } else if self.other == ContactPartner::Body(body) {
            Wrench { force: -self.force, torque: self.other_torque }
        } else {
            Wrench::default()
        }
    }
}

/// Sorts contacts by body and what it touches. Those of the same two keep their order.
pub(crate) fn sorted(mut contacts: Vec<Contact>) -> Vec<Contact> {
    contacts.sort_by_key(|contact| (contact.body, contact.other));
    contacts
}

/// The contacts of the latest step under [`Integrator::Implicit`].
pub(crate) fn solved_contacts(state: &State, scratch: &Scratch) -> Vec<Contact> {
    let mut listed = Vec::new();
    // the part of the step that was the latest one, of which the state keeps half
    let h = 2.0 * state.since_kick;
    scratch.body_contacts.list_solved(&scratch.solver, h, &mut listed);
    sorted(listed)
}

/// The contacts at the kick of the step that begins with the state `before`, under the other integrators. The kick is that of a whole
/// step, also with [`Model::energy_tolerance`].
pub(crate) fn contacts_of_step(model: &Model, before: &State) -> Vec<Contact> {
    // as in `step`: dashpots of `euler` see the velocities as they are
    let h = if model.integrator == Integrator::Euler { 0.0 } else { model.dt };
    let (mut state, mut scratch) = (before.clone(), Scratch::default());
    scratch.joints.begin_step(model);
    stage::begin_joints(model, &state, &mut scratch);
    for_each_batch(model, &mut state, &mut scratch, |batch| {
        move_to_kick(batch, h);
        stage::load(batch, h);
    });
    stage::fly_joined(model, &mut state, &mut scratch, 0.5 * h);
    let since_kick = SinceKick::at_kick(model, before.time);
    let mut walls: Vec<Option<WallKick>> = Vec::with_capacity(model.bodies.len());
    for (index, body) in model.bodies.iter().enumerate() {
        let meets = scratch.may_touch[index] && !body.has_spheres();
        let body: (&BodyModel, _) = (body, &state.bodies[index]);
        let start = before.bodies.get(index).filter(|_| model.joints.acts_on(index));
        let kick = Kick { length: h, since_last: &since_kick, start };
        let at_walls = || WallKick::new(model, body, &before.springs[index], kick);
        walls.push(if meets { at_walls() } else { None });
    }
    if model.has_body_contact {
        evaluate_body_contacts((model, &state, &mut scratch), &mut walls, since_kick);
    } else if h > 0.0 {
        walls.iter_mut().flatten().for_each(|wall| wall.evaluate_at_mid_kick(model, h));
    }
    let mut listed = Vec::new();
    for (index, wall) in walls.iter().enumerate() {
        if let Some(wall) = wall {
            wall.list(model, index, &mut listed);
        }
    }
    scratch.body_contacts.list(&mut listed);
    sorted(listed)
}

/// The stages of a step before its kick.
fn move_to_kick(batch: &mut Batch, h: f64) {
    stage::find_free_flight(batch, h);
    if h > 0.0 {
        stage::drift_free_flight(batch, h);
        stage::drift(batch, 0.5 * h);
        stage::move_kinematic(batch, 0.0, 0.5 * h);
    }
}

/// Evaluates contacts between bodies, and dashpots at walls at the velocities that they lead to.
fn evaluate_body_contacts(
    (model, state, scratch): (&Model, &State, &mut Scratch),
    walls: &mut [Option<WallKick>],
    since_kick: SinceKick,
) {
    let Scratch { body_contacts: contacts, joints, forces: others, before, .. } = scratch;
    contacts.update_neighbour_lists(model, state, &since_kick);
    contacts.use_start_velocities(model, &before.bodies);
    let is_damped = |body: &BodyModel| body.pair_material.is_damped() || body.is_damped;
    let predicts = model.integrator == Integrator::Splitting
        && model.bodies.iter().any(|body| is_damped(body));
    if !predicts {
        return contacts.evaluate::<false>(model, &state.pair_springs, since_kick);
    }
    contacts.evaluate::<true>(model, &state.pair_springs, since_kick);
    let forces = walls.iter().zip(&*others).map(|(wall, others)| {
        let of_walls = wall.as_ref().map_or_else(BodyForces::default, |wall| wall.forces);
        BodyForces { load: others.load, ..of_walls }
    });
    contacts.predict_velocities(model, &forces.collect::<Vec<_>>(), model.dt);
    if !model.joints.is_empty() {
        contacts.predict_joined(model, state, joints);
    }
    contacts.evaluate_again();
    for (wall, pose) in walls.iter_mut().zip(contacts.poses()) {
        if let Some(wall) = wall {
            wall.evaluate_at_velocities(model, pose);
        }
    }
}
