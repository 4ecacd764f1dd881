//! A smooth step from 0 to 1.

/// x² (3 − 2 x) between 0 and 1.
pub(crate) fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The derivative of [`smooth_step`].
pub(crate) fn smooth_step_slope(x: f64) -> f64 {
    if (0.0..=1.0).contains(&x) { 6.0 * x * (1.0 - x) } else { 0.0 }
}
