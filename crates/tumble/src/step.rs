//! The step: every line of the basic system, in its order.

use crate::{Integrator, Model, Scratch, State, StepError, stage};

/// Advances `state` by one step of `model.dt`.
///
/// The numbers are those of `docs/theory.md`; line 1, the mass properties, is done once per shape.
///
/// # Errors
/// [`StepError`] when the new state cannot be trusted.
pub fn step(model: &Model, state: &mut State, scratch: &mut Scratch) -> Result<(), StepError> {
    match model.integrator {
        Integrator::Euler => {
            scratch.clear(model.bodies.len());
            stage::gravity(model, scratch); // 2
            stage::drag(model, state, scratch); // 8
            stage::contact(model, state, scratch); // 9, with 3 and 4
            stage::euler(model, state, scratch); // 5 to 7
        }
    }
    state.step += 1;
    state.time = state.step as f64 * model.dt;
    stage::check(model, state)
}
