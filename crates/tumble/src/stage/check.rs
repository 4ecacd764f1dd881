//! The last stage of every step: is the state still one that physics could have made?

use crate::{BodyState, Model, State, StepError};

/// Refuses a state with a number that is NaN or infinite.
///
/// # Errors
/// [`StepError`] names the step, time, body, quantity and value.
pub fn check(model: &Model, state: &State) -> Result<(), StepError> {
    for (body, body_state) in model.bodies.iter().zip(&state.bodies) {
        if let Some((quantity, value)) = not_finite(body_state) {
            return Err(StepError {
                step: state.step,
                time: state.time,
                body: body.name.clone(),
                quantity,
                value,
            });
        }
    }
    Ok(())
}

/// The first quantity that is not finite, and its value.
fn not_finite(state: &BodyState) -> Option<(&'static str, f64)> {
    let [qx, qy, qz, qw] = state.orientation.to_array();
    let quantities: [(&str, &[f64]); 4] = [
        ("position", &state.position.to_array()),
        ("velocity", &state.velocity.to_array()),
        ("orientation", &[qw, qx, qy, qz]),
        ("angular_momentum", &state.angular_momentum.to_array()),
    ];
    quantities.iter().find_map(|(name, values)| {
        values.iter().find(|v| !v.is_finite()).map(|&value| (*name, value))
    })
}
