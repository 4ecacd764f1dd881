//! Whether two balls overlap.

use glam::DVec3;

/// The sum of two radii is taken larger by this factor: more than all rounding, less than what the caller is promised.
const ROUNDING: f64 = 1.0 + 5e-13;

/// Sums of two radii (m) whose squares are far from overflow and underflow.
const ORDINARY: std::ops::Range<f64> = 1e-140..1e140;

/// Centre and radius (m).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sphere {
    pub centre: DVec3,
    pub radius: f64,
}

/// Whether squares may be compared as they are, for all sums of two radii between these.
pub(super) fn are_ordinary(least: f64, largest: f64) -> bool {
    ORDINARY.contains(&least) && ORDINARY.contains(&largest)
}

/// Whether two spheres overlap whose sum of radii is ordinary. Where the distance overflows or vanishes, its square
/// still is on the right side of the square of the sum.
#[inline(always)]
pub(super) fn overlaps_ordinary(a: &Sphere, b: &Sphere) -> bool {
    let apart = a.centre - b.centre;
    let sum = (a.radius + b.radius) * ROUNDING;
    apart.length_squared() <= sum * sum
}

/// Whether two spheres overlap, of any magnitude.
pub(super) fn overlaps(a: &Sphere, b: &Sphere) -> bool {
    let (mut apart, mut sum) = (a.centre - b.centre, a.radius + b.radius);
    if !(apart.is_finite() && sum.is_finite()) {
        (apart, sum) = (0.25 * a.centre - 0.25 * b.centre, 0.25 * a.radius + 0.25 * b.radius);
    }
    let unit = apart.abs().max_element().max(sum);
    if unit == 0.0 {
        return true;
    }
    let (apart, sum) = (apart / unit, sum / unit * ROUNDING);
    apart.length_squared() <= sum * sum
}
