//! Where an edge is deepest in another body: the minimum, or all extrema, of a function on a segment.
//!
//! The depth is piecewise linear where a body is flat. So the place where the tangents at two points meet is the next one to
//! try (J. E. Kelley, J. SIAM 8 (1960) 703), and few tries are enough.

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

/// The number of parts in which extrema are sought, and how often a part is divided where it may hide more.
const PARTS: [f64; 2] = [2.0, 8.0];
const DIVISIONS: u32 = 8;
/// A change of the slope, per length, up to which a function is taken to be linear, and a relative error of its value.
const LINEAR: f64 = 3e-3;
const CLOSE: f64 = 1e-6;
/// A relative change of the slope up to which a part is taken to be monotonic, and how far, in units of its rise, a monotonic
/// part may deviate from a parabola.
const EVEN: f64 = 0.3;
const UNEVEN: f64 = 0.01;
/// How far from a kink its sides are tried, in units of the part in which it is.
const KINK: f64 = 1e-4;
/// An upper bound of the slope of the function per length.
const STEEPEST: f64 = 2.5;

/// Value (m) and derivatives of a function at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub value: f64,
    pub gradient: DVec3,
    /// The derivative with respect to a rotation of the segment that leaves the point in place (m/rad).
    pub turn: DVec3,
}

/// An extremum on a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extremum {
    /// Vector from the middle of the segment to it (m).
    pub offset: DVec3,
    /// The function plus the centring term (m).
    pub value: f64,
    /// The gradient of `value` as the segment moves.
    pub gradient: DVec3,
    /// See [`Sample::turn`].
    pub turn: DVec3,
    /// Or a maximum.
    pub is_minimum: bool,
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

/// A function on a segment, with the centring term.
struct OnSegment<F> {
    /// Vector from the middle to one end (m), and its length.
    half: DVec3,
    length: f64,
    /// The function at a vector from the middle.
    evaluate: F,
}

impl<F: FnMut(DVec3) -> Option<Sample>> OnSegment<F> {
    fn new(half: DVec3, evaluate: F) -> Self {
        Self { half, length: half.length(), evaluate }
    }

    fn at(&mut self, t: f64) -> Option<Try> {
        let Sample { value, gradient, turn } = (self.evaluate)(self.half * t)?;
        let centring = CENTRING * self.length;
        let slope = gradient.dot(self.half) + centring * t;
        Some(Try { t, value: value + 0.5 * centring * t * t, slope, gradient, turn })
    }

    fn single(&self, point: &Try, is_minimum: bool) -> Extremum {
        let Try { t, value, gradient, turn, .. } = *point;
        Extremum { offset: self.half * t, value, gradient, turn, is_minimum }
    }

    /// The extremum where two tangents meet: as the segment moves it follows both, weighted so that the slope along the
    /// segment is zero.
    fn crest(&self, low: &Try, high: &Try) -> Extremum {
        let (t, value) = crossing(low, high);
        let weight = high.slope / (high.slope - low.slope);
        let gradient = low.gradient * weight + high.gradient * (1.0 - weight);
        let turn = low.turn * weight + high.turn * (1.0 - weight);
        Extremum { offset: self.half * t, value, gradient, turn, is_minimum: low.slope < 0.0 }
    }
}

/// Where the tangents at two points meet, and their value there (m).
fn crossing(low: &Try, high: &Try) -> (f64, f64) {
    let rise = low.value - high.value + high.slope * high.t - low.slope * low.t;
    let t = rise / (high.slope - low.slope);
    (t, low.value + low.slope * (t - low.t))
}

/// The minimum of a convex function on the segment from −`half` to `half`; `evaluate` returns it at a vector from the middle.
/// `None` if it is not below `limit` (m), 0 or more.
pub(super) fn minimum(
    half: DVec3,
    limit: f64,
    evaluate: impl FnMut(DVec3) -> Option<Sample>,
) -> Option<Extremum> {
    let mut function = OnSegment::new(half, evaluate);
    let length = function.length;
    let below_limit = |found: Extremum| (found.value < limit).then_some(found);
    let first = function.at(0.0)?;
    if first.slope.abs() <= NEGLIGIBLE * length {
        return below_limit(function.single(&first, true));
    }
    let end = function.at(-first.slope.signum())?;
    if end.slope * first.slope >= 0.0 {
        return below_limit(function.single(&end, true));
    }
    let (mut low, mut high) = if first.slope < 0.0 { (first, end) } else { (end, first) };
    let mut best = if end.value < first.value { end } else { first };
    for number in 0..TRIES {
        // the tangents at both ends are lower bounds
        let (t, bound) = crossing(&low, &high);
        if bound > limit - NEGLIGIBLE * length {
            return None;
        }
        // where the function is curved, tangents at one end alone converge slowly: halve the interval now and then
        let t = if number % 2 == 1 { 0.5 * (low.t + high.t) } else { t.clamp(low.t, high.t) };
        let tried = function.at(t)?;
        if tried.value < best.value {
            best = tried;
        }
        // even the last one: its gradient counts where the function is curved
        if tried.slope < 0.0 {
            low = tried
        } else {
            high = tried
        }
        if tried.value - bound <= TOLERANCE * bound.abs() {
            break;
        }
    }
    if low.turn != DVec3::ZERO || high.turn != DVec3::ZERO {
        // the derivative at a distance from the minimum is another, also where the function is linear
        let (t, _) = crossing(&low, &high);
        low = function.at((t - BESIDE).max(low.t))?;
        high = function.at((t + BESIDE).min(high.t))?;
        if low.slope >= 0.0 || high.slope <= 0.0 {
            return below_limit(function.single(if low.slope >= 0.0 { &low } else { &high }, true));
        }
    }
    let (t, value) = crossing(&low, &high);
    let is_bound = (low.t..=high.t).contains(&t) && best.value - value <= SLACK * value.abs();
    below_limit(if is_bound { function.crest(&low, &high) } else { function.single(&best, true) })
}

/// Visits the minima below zero on the segment, and the maxima below zero between them. Two minima are certainly told apart
/// only if they are farther from each other than `size` (m).
pub(super) fn extrema(
    half: DVec3,
    size: f64,
    evaluate: impl FnMut(DVec3) -> Option<Sample>,
    visit: impl FnMut(Extremum),
) {
    let function = OnSegment::new(half, evaluate);
    let parts = (2.0 * function.length / size).ceil().clamp(PARTS[0], PARTS[1]);
    // a function that is nowhere defined has no extrema
    let _ = Search { function, visit }.run(parts as u32);
}

/// The search for all extrema.
struct Search<F, V> {
    function: OnSegment<F>,
    visit: V,
}

impl<F: FnMut(DVec3) -> Option<Sample>, V: FnMut(Extremum)> Search<F, V> {
    fn run(&mut self, parts: u32) -> Option<()> {
        let mut low = self.function.at(-1.0)?;
        if low.slope >= 0.0 {
            self.found(self.function.single(&low, true));
        }
        for part in 1..=parts {
            let high = self.function.at(2.0 * f64::from(part) / f64::from(parts) - 1.0)?;
            self.between(&low, &high, DIVISIONS)?;
            low = high;
        }
        if low.slope < 0.0 {
            self.found(self.function.single(&low, true));
        }
        Some(())
    }

    fn found(&mut self, extremum: Extremum) {
        if extremum.value < 0.0 {
            (self.visit)(extremum);
        }
    }

    /// Finds the extrema between two points.
    fn between(&mut self, low: &Try, high: &Try, divisions: u32) -> Option<()> {
        let is_end = divisions == 0 || high.t - low.t <= TOLERANCE;
        if self.is_outside(low, high) || self.is_monotonic(low, high) {
            return Some(());
        }
        if is_end {
            self.closing_in(low, high);
            return Some(());
        }
        let range = high.t - low.t;
        let (t, _) = crossing(low, high);
        let beside = KINK * range;
        if !(t > low.t + beside && t < high.t - beside) {
            let middle = self.function.at(low.t + 0.5 * range)?;
            self.between(low, &middle, divisions - 1)?;
            return self.between(&middle, high, divisions - 1);
        }
        // two linear parts have a kink where their tangents meet
        let [left, right] = [self.function.at(t - beside)?, self.function.at(t + beside)?];
        let are_monotonic = [self.is_monotonic(low, &left), self.is_monotonic(&right, high)];
        if are_monotonic[0] || self.between(low, &left, divisions - 1).is_some() {
            self.closing_in(&left, &right);
        }
        if are_monotonic[1] { Some(()) } else { self.between(&right, high, divisions - 1) }
    }

    /// Visits the extremum between two points that are close to each other, if there is one.
    fn closing_in(&mut self, low: &Try, high: &Try) {
        if is_rising(low) == is_rising(high) {
            return;
        }
        let mut crest = self.function.crest(low, high);
        let (t, _) = crossing(low, high);
        if !(low.t..=high.t).contains(&t) {
            let best = if (low.value < high.value) == is_rising(high) { low } else { high };
            (crest.offset, crest.value) = (self.function.half * best.t, best.value);
        }
        self.found(crest);
    }

    /// Whether the function seems to be monotonic between two points: its slope changes little, and evenly.
    fn is_monotonic(&self, low: &Try, high: &Try) -> bool {
        let rise = 0.5 * (low.slope + high.slope) * (high.t - low.t);
        let change = (high.slope - low.slope).abs();
        let deviation = (high.value - low.value - rise).abs();
        let negligible = CLOSE * high.value.abs();
        is_rising(low) == is_rising(high)
            && change <= LINEAR * self.function.length + EVEN * low.slope.abs()
            && deviation <= negligible.max(UNEVEN * rise.abs())
    }

    /// Whether the function is above zero between two points.
    fn is_outside(&self, low: &Try, high: &Try) -> bool {
        let steepest = STEEPEST * self.function.length * (high.t - low.t);
        low.value > 0.0 && high.value > 0.0 && low.value + high.value > steepest
    }
}

fn is_rising(point: &Try) -> bool {
    point.slope >= 0.0
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

    fn deepest(cube: &SignedDistance, middle: DVec3, half: DVec3) -> Option<Extremum> {
        minimum(half, 0.0, |offset| {
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
