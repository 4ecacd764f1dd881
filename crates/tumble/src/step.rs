//! The step, as a list of stages.

use crate::{Integrator, Model, Scratch, State, StepError, parallel, stage};

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
    scratch.fit(model.bodies.len());
    match (model.integrator, model.energy_tolerance) {
        (Integrator::Splitting, None) => {
            stage::reach(model, state, scratch, h);
            stage::cruise(model, state, scratch, h);
            stage::fly(model, state, scratch, 0.5 * h);
            stage::carry(model, state, 0.0, 0.5 * h);
            stage::contact(model, state, scratch, h);
            stage::meet(model, state, scratch, h);
            stage::kick(model, state, scratch, h);
            stage::fly(model, state, scratch, 0.5 * h);
            stage::carry(model, state, 0.5 * h, h);
        }
        (Integrator::Splitting, Some(tolerance)) => {
            stage::reach(model, state, scratch, h);
            stage::cruise(model, state, scratch, h);
            stage::refine(model, state, scratch, tolerance); // the rest of the above, in parts
            stage::carry(model, state, 0.0, h);
        }
        (Integrator::Euler, _) => {
            stage::gravity(model, scratch); // 2
            stage::drag(model, state, scratch); // 8
            stage::reach(model, state, scratch, 0.0);
            stage::contact(model, state, scratch, 0.0); // 9, with 3 and 4
            stage::meet(model, state, scratch, h);
            stage::euler(model, state, scratch); // 5 to 7
            stage::carry(model, state, 0.0, h);
        }
    }
    state.step += 1;
    state.time = state.step as f64 * model.dt;
    stage::check(model, state, scratch)
}
