//! The time step, as a list of stages.

use crate::contact::Outcome;
use crate::stage::{
    self, ImplicitStep, ImplicitSteps, around_body_contact, around_implicit_contact,
};
use crate::{Batch, Integrator, Model, Scratch, State, StepError, for_each_batch, parallel};

/// Advances `state` by one step of `model.dt`, or returns a [`StepError`] when the new state fails a check.
pub fn step(model: &Model, state: &mut State, scratch: &mut Scratch) -> Result<(), StepError> {
    parallel::run(model.bodies.len(), || {
        match (model.integrator, model.energy_tolerance) {
            (Integrator::Splitting, None) => drift_kick_drift(model, state, scratch),
            (Integrator::Splitting, Some(tolerance)) => adaptive(model, state, scratch, tolerance),
            (Integrator::Implicit, _) => implicit(model, state, scratch),
            (Integrator::Euler, _) => semi_implicit_euler(model, state, scratch),
        }
        state.step += 1;
        state.time = state.step as f64 * model.dt;
        stage::report_failure(model, state, scratch)
    })
}

/// Strang splitting: exact flight for h/2, a kick by the contact forces at that position, exact flight for h/2.
fn drift_kick_drift(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let h = model.dt;
    if model.has_joints_or_loads() {
        return drift_kick_drift_together(model, state, scratch);
    }
    let before = |batch: &mut Batch| {
        fly_to_kick(batch, h);
        stage::wall_contact(batch, h);
    };
    around_body_contact(model, state, scratch, before, |batch| {
        stage::kick(batch, h);
        stage::drift(batch, 0.5 * h);
        stage::move_kinematic(batch, 0.5 * h, h);
        stage::check(batch);
    });
}

/// The same with joints, which act on several bodies at once, and loads.
fn drift_kick_drift_together(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let h = model.dt;
    scratch.joints.begin_step(model);
    stage::begin_joints(model, state, scratch);
    for_each_batch(model, state, scratch, |batch| fly_to_kick(batch, h));
    stage::fly_joined(model, state, scratch, 0.5 * h);
    let before = |batch: &mut Batch| {
        stage::load(batch, h);
        stage::wall_contact(batch, h);
    };
    around_body_contact(model, state, scratch, before, |_| {});
    stage::kick_joined(model, state, scratch, h);
    for_each_batch(model, state, scratch, |batch| stage::kick(batch, h));
    fly_after_kick(model, state, scratch, h);
}

/// The flight of the bodies without joints to the middle of a step of length `h` (s).
fn fly_to_kick(batch: &mut Batch, h: f64) {
    stage::find_free_flight(batch, h);
    stage::drift_free_flight(batch, h); // nothing within reach: the whole step at once
    stage::drift(batch, 0.5 * h);
    stage::move_kinematic(batch, 0.0, 0.5 * h);
}

/// The flight of all bodies from the middle of a step to its end.
fn fly_after_kick(model: &Model, state: &mut State, scratch: &mut Scratch, h: f64) {
    stage::begin_flight(model, state, scratch);
    for_each_batch(model, state, scratch, |batch| {
        stage::drift(batch, 0.5 * h);
        stage::move_kinematic(batch, 0.5 * h, h);
    });
    stage::fly_joined(model, state, scratch, 0.5 * h);
    for_each_batch(model, state, scratch, stage::check);
}

/// The same with a kick that satisfies the contact law at the end of the step: stable at any step. A long step of fast bodies is
/// divided, so that none passes another.
fn implicit(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let mut parts = ImplicitSteps::new(state);
    scratch.joints.begin_step(model);
    while let Some(part) = parts.next(model, state) {
        scratch.before.copy_from(state);
        scratch.joints.begin_part();
        let outcome = implicit_step(model, state, scratch, part);
        let is_repeated = parts.finish(model, (state, &mut scratch.before), outcome, part.length);
        if is_repeated {
            scratch.joints.undo_part();
        }
    }
}

fn implicit_step(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    part: ImplicitStep,
) -> Option<Outcome> {
    let h = part.length;
    if model.has_joints_or_loads() {
        return implicit_step_together(model, state, scratch, part);
    }
    let before = |batch: &mut Batch| fly_to_kick(batch, h);
    around_implicit_contact((model, state, scratch), part, before, |batch| {
        stage::drift(batch, 0.5 * h);
        stage::move_kinematic(batch, 0.5 * h, h);
        stage::check(batch);
    })
}

/// The same with joints and loads.
fn implicit_step_together(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    part: ImplicitStep,
) -> Option<Outcome> {
    let h = part.length;
    stage::begin_flight(model, state, scratch);
    for_each_batch(model, state, scratch, |batch| fly_to_kick(batch, h));
    stage::fly_joined(model, state, scratch, 0.5 * h);
    let before = |batch: &mut Batch| stage::load(batch, h);
    let outcome = around_implicit_contact((model, state, scratch), part, before, |_| {});
    fly_after_kick(model, state, scratch, h);
    let has_failed = scratch.joints.failure.is_some();
    outcome
        .map(|outcome| Outcome { has_converged: outcome.has_converged && !has_failed, ..outcome })
}

/// The same in sub-steps that bound the energy error. The builder allows it only without contact between bodies.
fn adaptive(model: &Model, state: &mut State, scratch: &mut Scratch, tolerance: f64) {
    for_each_batch(model, state, scratch, |batch| {
        stage::find_free_flight(batch, model.dt);
        stage::drift_free_flight(batch, model.dt);
        stage::substep(batch, tolerance);
        stage::move_kinematic(batch, 0.0, model.dt);
        stage::check(batch);
    });
}

/// The basic system: semi-implicit Euler in translation, explicit in rotation. Numbers are its lines in `docs/theory.md`.
fn semi_implicit_euler(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let before = |batch: &mut Batch| {
        stage::gravity(batch); // 2
        stage::drag(batch); // 8
        stage::find_free_flight(batch, 0.0);
        stage::wall_contact(batch, 0.0); // 9, with 3 and 4; h = 0: at the current velocities
    };
    around_body_contact(model, state, scratch, before, |batch| {
        stage::euler(batch); // 5: velocity, position; 6: quaternion; 7: angular momentum, inertia
        stage::move_kinematic(batch, 0.0, model.dt);
        stage::check(batch);
    });
}
