//! The minimum of a convex function on a segment: where an edge is deepest in another body.
//!
//! The depth is piecewise linear where a body is flat. So the place where the tangents at two points meet is the next one to
//! try (J. E. Kelley, J. SIAM 8 (1960) 703), and few tries are enough. Of a function that is not convex the result is a local
//! minimum.

use glam::DVec3;

/// Slope, per half-length, of the term that draws the point to the middle of the segment. It decides where a segment that
/// lies flat on a face touches, so that the point moves continuously as the segment tilts.
const CENTRING: f64 = 1e-3;
/// A minimum this close to zero is none, and a slope this small is zero, in units of the half-length of the segment.
const NEGLIGIBLE: f64 = 1e-8;
/// The relative error of the value at which the search ends.
const TOLERANCE: f64 = 1e-7;
/// The largest number of tries between the ends.
const TRIES: usize = 60;

/// How far above the tangents the best try may be, relative to its value, for them to be a bound: the function is convex.
const SLACK: f64 = 1e-4;
/// Distance from the minimum at which the derivatives on both sides are taken, in units of the half-length.
const BESIDE: f64 = 1e-6;

/// Value (m) and derivatives of a function at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub value: f64,
    pub gradient: DVec3,
    /// The derivative with respect to a rotation of the segment that leaves the point in place (m/rad).
    pub turn: DVec3,
}

/// The minimum on a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Minimum {
    /// Vector from the middle of the segment to it (m).
    pub offset: DVec3,
    /// The function plus the centring term (m), below zero.
    pub value: f64,
    /// The gradient of `value` as the segment moves.
    pub gradient: DVec3,
    /// See [`Sample::turn`].
    pub turn: DVec3,
}

/// A point of the segment.
#[derive(Clone, Copy)]
struct Try {
    /// Its place, −1 at the one end and 1 at the other.
    t: f64,
    value: f64,
    slope: f64,
    gradient: DVec3,
    turn: DVec3,
}

/// The minimum on the segment from `middle` − `half` to `middle` + `half`; `evaluate` returns the function at a vector from
/// the middle. `None` if it is not below zero. If the function is convex, fewer tries are enough.
pub(super) fn minimum(
    half: DVec3,
    is_convex: bool,
    mut evaluate: impl FnMut(DVec3) -> Option<Sample>,
) -> Option<Minimum> {
    let length = half.length();
    let centring = CENTRING * length;
    let mut at = |t: f64| {
        let Sample { value, gradient, turn } = evaluate(half * t)?;
        let (value, slope) = (value + 0.5 * centring * t * t, gradient.dot(half) + centring * t);
        Some(Try { t, value, slope, gradient, turn })
    };
    let first = at(0.0)?;
    if first.slope.abs() <= NEGLIGIBLE * length {
        return below_zero(single(&first, half));
    }
    let end = at(-first.slope.signum())?;
    if end.slope * first.slope >= 0.0 {
        return below_zero(single(&end, half));
    }
    let (mut low, mut high) = if first.slope < 0.0 { (first, end) } else { (end, first) };
    let mut best = if end.value < first.value { end } else { first };
    for number in 0..TRIES {
        // the tangents at both ends are lower bounds
        let (t, bound) = crossing(&low, &high);
        if is_convex && bound > -NEGLIGIBLE * length {
            return None;
        }
        // where the function is curved, tangents at one end alone converge slowly: halve the interval now and then
        let t = if number % 2 == 1 { 0.5 * (low.t + high.t) } else { t.clamp(low.t, high.t) };
        let tried = at(t)?;
        if tried.value < best.value {
            best = tried;
        }
        // even the last one: its gradient counts where the function is curved
        if tried.slope < 0.0 {
            low = tried
        } else {
            high = tried
        }
        let is_found = if is_convex {
            tried.value - bound <= TOLERANCE * bound.abs()
        } else {
            high.t - low.t <= TOLERANCE
        };
        if is_found {
            break;
        }
    }
    if is_convex && (low.turn != DVec3::ZERO || high.turn != DVec3::ZERO) {
        // the derivative at a distance from the minimum is another, also where the function is linear
        let (t, _) = crossing(&low, &high);
        low = at((t - BESIDE).max(low.t))?;
        high = at((t + BESIDE).min(high.t))?;
        if low.slope >= 0.0 || high.slope <= 0.0 {
            return below_zero(single(if low.slope >= 0.0 { &low } else { &high }, half));
        }
    }
    let (t, value) = crossing(&low, &high);
    let is_bound = (low.t..=high.t).contains(&t) && best.value - value <= SLACK * value.abs();
    below_zero(if is_bound { crest(&low, &high, half) } else { single(&best, half) })
}

fn below_zero(minimum: Minimum) -> Option<Minimum> {
    (minimum.value < 0.0).then_some(minimum)
}

fn single(point: &Try, half: DVec3) -> Minimum {
    let Try { t, value, gradient, turn, .. } = *point;
    Minimum { offset: half * t, value, gradient, turn }
}

/// Where the tangents at two points meet, and their value there (m).
fn crossing(low: &Try, high: &Try) -> (f64, f64) {
    let rise = low.value - high.value + high.slope * high.t - low.slope * low.t;
    let t = rise / (high.slope - low.slope);
    (t, low.value + low.slope * (t - low.t))
}

/// The minimum where two tangents meet: as the segment moves it follows both, weighted so that the slope along the segment
/// is zero.
fn crest(low: &Try, high: &Try, half: DVec3) -> Minimum {
    let (t, value) = crossing(low, high);
    let weight = high.slope / (high.slope - low.slope);
    let gradient = low.gradient * weight + high.gradient * (1.0 - weight);
    let turn = low.turn * weight + high.turn * (1.0 - weight);
    Minimum { offset: half * t, value, gradient, turn }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::{Primitive, SignedDistance};

    fn cube() -> SignedDistance {
        let mesh = Primitive::Box { size: DVec3::splat(2.0), divisions: 1 }.mesh().unwrap();
        SignedDistance::new(&mesh).unwrap()
    }

    fn deepest(cube: &SignedDistance, middle: DVec3, half: DVec3) -> Option<Minimum> {
        minimum(half, true, |offset| {
            let nearest = cube.query(middle + offset, 0, f64::INFINITY)?;
            Some(Sample { value: nearest.distance, gradient: nearest.gradient, turn: DVec3::ZERO })
        })
    }

    #[test]
    fn a_segment_across_an_edge_is_deepest_below_it() {
        // the edge of the cube along z, at x = y = 1; the segment crosses it at 45°, 0.01 below
        let half = DVec3::new(0.5, -0.5, 0.0);
        let middle = DVec3::new(1.0, 1.0, 0.3) - DVec3::new(1.0, 1.0, 0.0) * 0.01 + half * 0.3;
        let found = deepest(&cube(), middle, half).unwrap();
        assert!((found.offset + half * 0.3).length() < 2e-3, "{found:?}");
        let centring = 0.5 * CENTRING * half.length() * 0.3 * 0.3;
        assert!((found.value + 0.01 - centring).abs() < 1e-6, "{found:?}");
        // the gradient is along the diagonal, but for the centring
        assert!((found.gradient - DVec3::new(0.5, 0.5, 0.0)).length() < 1e-3, "{found:?}");
    }

    #[test]
    fn the_gradient_is_that_of_the_value() {
        let cube = cube();
        let half = DVec3::new(0.4, -0.5, 0.2);
        let at = |shift: DVec3| deepest(&cube, DVec3::new(0.93, 1.08, 0.1) + shift, half).unwrap();
        let found = at(DVec3::ZERO);
        for axis in DVec3::AXES {
            let change = at(axis * 1e-6).value - at(axis * -1e-6).value;
            assert!((change / 2e-6 - found.gradient.dot(axis)).abs() < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn a_flat_segment_touches_in_its_middle_and_one_outside_nowhere() {
        let found = deepest(&cube(), DVec3::new(0.1, 0.999, 0.0), DVec3::X * 0.5).unwrap();
        assert_eq!((found.offset, found.gradient), (DVec3::ZERO, DVec3::Y));
        assert!(deepest(&cube(), DVec3::new(0.0, 1.001, 0.0), DVec3::X * 3.0).is_none());
        assert!(
            deepest(&cube(), DVec3::new(1.01, 1.01, 0.0), DVec3::new(0.5, -0.5, 0.0)).is_none()
        );
    }
}
