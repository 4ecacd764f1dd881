//! The step, as a list of stages.

use crate::{Integrator, Model, Scratch, State, StepError, each_batch, parallel, stage};

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
            each_batch(model, state, scratch, |batch| {
                stage::reach(batch, h);
                stage::cruise(batch, h);
                stage::fly(batch, 0.5 * h);
                stage::carry(batch, 0.0, 0.5 * h);
                stage::contact(batch, h);
                stage::arrive(batch);
            });
            stage::meet(model, state, scratch, h);
            each_batch(model, state, scratch, |batch| {
                stage::feel(batch);
                stage::kick(batch, h);
                stage::fly(batch, 0.5 * h);
                stage::carry(batch, 0.5 * h, h);
                stage::check(batch);
            });
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
            each_batch(model, state, scratch, |batch| {
                stage::gravity(batch); // 2
                stage::drag(batch); // 8
                stage::reach(batch, 0.0);
                stage::contact(batch, 0.0); // 9, with 3 and 4
                stage::arrive(batch);
            });
            stage::meet(model, state, scratch, h);
            each_batch(model, state, scratch, |batch| {
                stage::feel(batch);
                stage::euler(batch); // 5 to 7
                stage::carry(batch, 0.0, h);
                stage::check(batch);
            });
        }
    }
    stage::keep(state, scratch);
    state.step += 1;
    state.time = state.step as f64 * model.dt;
    stage::refuse(model, state, scratch)
}
