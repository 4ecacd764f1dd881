//! Whether two balls overlap.

use glam::DVec3;

/// The sum of two radii is enlarged by this factor: more than any rounding error, less than the tolerance that the caller is
/// promised.
const ROUNDING: f64 = 1.0 + 5e-13;

/// Sums of two radii (m) whose squares neither overflow nor underflow.
const ORDINARY: std::ops::Range<f64> = 1e-140..1e140;

/// Centre and radius (m).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sphere {
    pub centre: DVec3,
    pub radius: f64,
}

/// Whether all sums of two radii between these are ordinary, so that squares can be compared without scaling.
pub(super) fn are_ordinary(smallest: f64, largest: f64) -> bool {
    ORDINARY.contains(&smallest) && ORDINARY.contains(&largest)
}

/// Whether two spheres overlap whose sum of radii is ordinary. A squared distance that overflows or underflows still compares
/// correctly with the square of that sum.
#[inline(always)]
pub(super) fn overlaps_ordinary(a: &Sphere, b: &Sphere) -> bool {
    let separation = a.centre - b.centre;
    let sum = (a.radius + b.radius) * ROUNDING;
    separation.length_squared() <= sum * sum
}

/// Whether two spheres overlap, of any magnitude.
pub(super) fn overlaps(a: &Sphere, b: &Sphere) -> bool {
    let (mut separation, mut sum) = (a.centre - b.centre, a.radius + b.radius);
    if !(separation.is_finite() && sum.is_finite()) {
        (separation, sum) = (0.25 * a.centre - 0.25 * b.centre, 0.25 * a.radius + 0.25 * b.radius);
    }
    let unit = separation.abs().max_element().max(sum);
    if unit == 0.0 {
        return true;
    }
    let (separation, sum) = (separation / unit, sum / unit * ROUNDING);
    separation.length_squared() <= sum * sum
}
