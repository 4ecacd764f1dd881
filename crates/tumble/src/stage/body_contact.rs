//! Contact between bodies, and of spheres with walls: where bodies of different batches act on each other.

use std::sync::Arc;

use super::implicit_steps::ImplicitStep;
use super::wall_contact::wall_contact_again;
use crate::contact::{Outcome, SinceKick, gather};
use crate::{Batch, BodyModel, Integrator, Model, Scratch, State, for_each_batch, parallel};

/// Runs the stages `before` on all batches, computes the contact forces between bodies, and runs the stages `after`.
///
/// The module `contact` describes the pipeline. Where no two bodies can touch, every batch goes through both groups
/// of stages at once.
pub fn around_body_contact(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    before: impl Fn(&mut Batch) + Sync,
    after: impl Fn(&mut Batch) + Sync,
) {
    if !model.has_body_contact {
        return for_each_batch(model, state, scratch, |batch| {
            before(batch);
            after(batch);
        });
    }
    for_each_batch(model, state, scratch, |batch| {
        before(batch);
        let Batch { model, time, first, bodies, poses, .. } = batch;
        let since_kick = SinceKick::at_kick(model, *time);
        gather::update_poses(model, *first, poses, bodies, &since_kick);
    });
    contact_forces(model, state, scratch);
    for_each_batch(model, state, scratch, |batch| {
        if model.integrator == Integrator::Splitting {
            wall_contact_again(batch);
        }
        let Batch { first, forces, contact_results, .. } = batch;
        gather::gather_forces(*contact_results, *first, forces);
        after(batch);
    });
    scratch.body_contacts.store_friction_springs(&mut state.pair_springs);
}

/// The same with an implicit solution of the contact law, in place of forces, for one part of a step. Returns how it ended; `None`
/// where nothing can touch.
pub(crate) fn around_implicit_contact(
    (model, state, scratch): (&Model, &mut State, &mut Scratch),
    ImplicitStep { length, fastest }: ImplicitStep,
    before: impl Fn(&mut Batch) + Sync,
    after: impl Fn(&mut Batch) + Sync,
) -> Option<Outcome> {
    let since_kick = SinceKick::at_implicit_kick(state, length, fastest);
    for_each_batch(model, state, scratch, |batch| {
        before(batch);
        let Batch { model, first, bodies, poses, .. } = batch;
        gather::update_poses(model, *first, poses, bodies, &since_kick);
    });
    let outcome = model.has_body_contact.then(|| {
        let Scratch { body_contacts, solver, forces, joints, .. } = scratch;
        body_contacts.solve(model, state, (solver, joints), forces, since_kick)
    });
    for_each_batch(model, state, scratch, after);
    outcome
}

/// Neighbour lists, narrow phase and contact forces, for a kick over the time step.
///
/// Under `splitting`, dashpots see the mean of the velocities before and after the kick: a first evaluation of all contacts, with
/// walls and between bodies, predicts these, and a second one uses them. Under `euler`, dashpots see the velocities as they are.
fn contact_forces(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let h = model.dt;
    let contacts = &mut scratch.body_contacts;
    let since_kick = SinceKick::at_kick(model, state.time);
    contacts.update_neighbour_lists(model, state, &since_kick);
    contacts.use_start_velocities(model, &scratch.before.bodies);
    let is_damped = |body: &Arc<BodyModel>| body.pair_material.is_damped() || body.is_damped;
    if model.integrator != Integrator::Splitting || !model.bodies.iter().any(is_damped) {
        contacts.evaluate::<false>(model, &state.pair_springs, since_kick);
    } else if parallel::is_single_threaded() && !model.has_joints_or_loads() {
        contacts.predict_and_evaluate(model, &state.pair_springs, &scratch.forces, since_kick);
    } else {
        contacts.evaluate::<true>(model, &state.pair_springs, since_kick);
        for_each_batch(model, state, scratch, |batch| {
            let Batch { model, first, poses, forces, contact_results, .. } = batch;
            gather::predict_velocities(model, *first, poses, forces, *contact_results, h);
        });
        let Scratch { body_contacts, joints, .. } = scratch;
        if !model.joints.is_empty() {
            body_contacts.predict_joined(model, state, joints);
        }
        body_contacts.evaluate_again();
    }
}
