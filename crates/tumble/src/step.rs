//! The step, as a list of stages.

use crate::{Batch, Integrator, Model, Scratch, State, StepError, each_batch, parallel, stage};

/// Advances `state` by one step of `model.dt`.
///
/// The numbers are the lines of the basic system in `docs/theory.md`; line 1, the mass properties, is
/// done once per shape.
///
/// # Errors
/// [`StepError`] when the new state cannot be trusted.
pub fn step(model: &Model, state: &mut State, scratch: &mut Scratch) -> Result<(), StepError> {
    parallel::run(model.bodies.len(), || stages(model, state, scratch))
}

fn stages(model: &Model, state: &mut State, scratch: &mut Scratch) -> Result<(), StepError> {
    let h = model.dt;
    match (model.integrator, model.energy_tolerance) {
        (Integrator::Splitting, None) => {
            let push = |batch: &mut Batch| {
                stage::reach(batch, h);
                stage::cruise(batch, h);
                stage::fly(batch, 0.5 * h);
                stage::carry(batch, 0.0, 0.5 * h);
                stage::contact(batch, h);
            };
            let go_on = |batch: &mut Batch| {
                stage::kick(batch, h);
                stage::fly(batch, 0.5 * h);
                stage::carry(batch, 0.5 * h, h);
                stage::check(batch);
            };
            around_meeting(model, state, scratch, push, go_on);
        }
        (Integrator::Splitting, Some(tolerance)) => {
            each_batch(model, state, scratch, |batch| {
                stage::reach(batch, h);
                stage::cruise(batch, h);
                stage::refine(batch, tolerance); // the rest of the above, in parts
                stage::carry(batch, 0.0, h);
                stage::check(batch);
            });
        }
        (Integrator::Euler, _) => {
            let push = |batch: &mut Batch| {
                stage::gravity(batch); // 2
                stage::drag(batch); // 8
                stage::reach(batch, 0.0);
                stage::contact(batch, 0.0); // 9, with 3 and 4
            };
            let go_on = |batch: &mut Batch| {
                stage::euler(batch); // 5 to 7
                stage::carry(batch, 0.0, h);
                stage::check(batch);
            };
            around_meeting(model, state, scratch, push, go_on);
        }
    }
    state.step += 1;
    state.time = state.step as f64 * model.dt;
    stage::refuse(model, state, scratch)
}

/// What batches do by themselves before and after bodies meet; where none can meet, at once.
fn around_meeting(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    before: impl Fn(&mut Batch) + Sync,
    after: impl Fn(&mut Batch) + Sync,
) {
    if !model.meets {
        return each_batch(model, state, scratch, |batch| {
            before(batch);
            after(batch);
        });
    }
    each_batch(model, state, scratch, |batch| {
        before(batch);
        stage::arrive(batch);
    });
    stage::meet(model, state, scratch, model.dt);
    each_batch(model, state, scratch, |batch| {
        stage::feel(batch);
        after(batch);
    });
    stage::keep(state, scratch);
}
