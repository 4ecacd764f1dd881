//! The last stage of every step: is the state still one that physics could have made?

use crate::{BodyState, Model, State, StepError};

/// Refuses a state with a number that is NaN or infinite, or an orientation that is no rotation.
///
/// # Errors
/// [`StepError`] names the step, time, body, quantity and value.
pub fn check(model: &Model, state: &State) -> Result<(), StepError> {
    for (body, body_state) in model.bodies.iter().zip(&state.bodies) {
        if let Some((quantity, value)) = impossible(body_state) {
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

/// The first quantity that cannot be, and its value.
fn impossible(state: &BodyState) -> Option<(&'static str, f64)> {
    let [qx, qy, qz, qw] = state.orientation.to_array();
    let quantities: [(&str, &[f64]); 4] = [
        ("position", &state.position.to_array()),
        ("velocity", &state.velocity.to_array()),
        ("orientation", &[qw, qx, qy, qz]),
        ("angular_momentum", &state.angular_momentum.to_array()),
    ];
    let not_finite = quantities.iter().find_map(|(name, values)| {
        values.iter().find(|v| !v.is_finite()).map(|&value| (*name, value))
    });
    // an angular velocity whose square overflows leaves no orientation at all
    let length = state.orientation.length();
    not_finite.or(((length - 1.0).abs() > 1e-6).then_some(("length of orientation", length)))
}
