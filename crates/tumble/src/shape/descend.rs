//! What is asked of the tree: sums over the particles behind walls, the deepest of them, and which they are.

use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};
use glam::DVec3;

use super::particles::{Group, Particles};
use super::tree::{Branch, Moments, Node, Ramp, Side};
use crate::lanes::{LANES, Vec3x8, largest, positive, sum};

/// Branches that can wait at once: a tree of 2³² particles is no deeper.
const WAITING: usize = 32;

/// How close to the largest value is close enough. The particles of a flat face that lies on a wall are
/// equally deep but for rounding, and need not all be looked at.
const CLOSE: f64 = 1e-4;

/// Sums of a ramp f over some particles; each counts as often as it weighs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RampSums {
    /// Σ f.
    pub sum: f64,
    /// Σ f r.
    pub moment: DVec3,
    /// Σ f².
    pub squares: f64,
    /// The largest f, where no node was summed whole, and so each particle was looked at.
    pub largest: Option<f64>,
}

impl Particles {
    /// Sums of `ramp` over the particles where it is above zero, and `within` too if there is one.
    pub(crate) fn sums(&self, level: Level, ramp: &Ramp, within: Option<&Ramp>) -> RampSums {
        match (within, self.is_weighted()) {
            (None, false) => {
                dispatch!(level, simd => self.sums_in::<_, 0, false>(simd, ramp, &[]))
            }
            (Some(within), false) => {
                dispatch!(level, simd => self.sums_in::<_, 1, false>(simd, ramp, &[*within]))
            }
            (None, true) => {
                dispatch!(level, simd => self.sums_in::<_, 0, true>(simd, ramp, &[]))
            }
            (Some(within), true) => {
                dispatch!(level, simd => self.sums_in::<_, 1, true>(simd, ramp, &[*within]))
            }
        }
    }

    /// Compiled once for particles that weigh and once for those that do not, which pay nothing for it.
    #[inline(always)]
    fn sums_in<S: Simd, const N: usize, const WEIGHTED: bool>(
        &self,
        simd: S,
        ramp: &Ramp,
        within: &[Ramp; N],
    ) -> RampSums {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut whole = RampSums { largest: Some(0.0), ..RampSums::default() };
                let mut lanes = LaneSums::zero(simd);
                let mut waiting = Waiting::new(self.nodes());
                while let Some((branch, _)) = waiting.next() {
                    let node = self.node(branch);
                    let mut side = node.side(ramp, branch.is_leaf());
                    for ramp in within {
                        side = side.and(node.side(ramp, branch.is_leaf()));
                    }
                    match side {
                        Side::Outside => {}
                        Side::Inside if WEIGHTED => whole.add(self.weighted(branch), ramp),
                        Side::Inside => whole.add(&node.moments, ramp),
                        Side::Cut => match branch.children() {
                            Some([a, b]) => waiting.both((a, 0.0), (b, 0.0)),
                            None => {
                                for group in self.groups(simd, branch) {
                                    let value = LaneRamp::above(simd, &group, ramp, within);
                                    let mut share = value;
                                    if WEIGHTED {
                                        share *= self.weights(simd, &group);
                                    }
                                    lanes.add(&group, value, share);
                                }
                            }
                        },
                    }
                }
                whole.plus(&lanes)
            },
        )
    }

    /// The largest value of `ramp` over the particles, to a part in ten thousand; zero where it is nowhere above.
    pub(crate) fn largest(&self, level: Level, ramp: &Ramp) -> f64 {
        dispatch!(level, simd => self.largest_in(simd, ramp))
    }

    #[inline(always)]
    fn largest_in<S: Simd>(&self, simd: S, ramp: &Ramp) -> f64 {
        simd.vectorize(
            #[inline(always)]
            || {
                let values = LaneRamp::over(simd, ramp);
                let mut best = 0.0f64;
                let mut waiting = Waiting::new(self.nodes());
                while let Some((branch, most)) = waiting.next() {
                    // a bound that ends on its particle may be a rounding above it
                    let rounding = 4.0 * f64::EPSILON * (ramp.offset.abs() + best);
                    let enough = best * (1.0 + CLOSE) + rounding;
                    if most <= enough || self.node(branch).most_by_spread(ramp) <= enough {
                        continue;
                    }
                    match branch.children() {
                        Some([a, b]) => {
                            let (of_a, of_b) = (self.most(a, ramp), self.most(b, ramp));
                            if of_a < of_b {
                                waiting.both((b, of_b), (a, of_a));
                            } else {
                                waiting.both((a, of_a), (b, of_b));
                            }
                        }
                        None => {
                            for group in self.groups(simd, branch) {
                                best = best.max(largest(values.real(simd, &group)));
                            }
                        }
                    }
                }
                best
            },
        )
    }

    /// Appends the slots of all particles where `ramp` is above zero, in their order.
    pub(crate) fn list_positive(&self, level: Level, ramp: &Ramp, slots: &mut Vec<u32>) {
        dispatch!(level, simd => self.list_positive_in(simd, ramp, slots));
    }

    #[inline(always)]
    fn list_positive_in<S: Simd>(&self, simd: S, ramp: &Ramp, slots: &mut Vec<u32>) {
        simd.vectorize(
            #[inline(always)]
            || {
                let values = LaneRamp::over(simd, ramp);
                let mut waiting = Waiting::new(self.nodes());
                while let Some((branch, _)) = waiting.next() {
                    let node = self.node(branch);
                    match (node.side(ramp, branch.is_leaf()), branch.children()) {
                        (Side::Outside, _) => {}
                        (Side::Cut, Some([a, b])) => waiting.both((a, 0.0), (b, 0.0)),
                        _ => {
                            for group in self.groups(simd, branch) {
                                let values = values.real(simd, &group);
                                let above = values.simd_gt(f64x8::splat(simd, 0.0));
                                let mut bits = above.to_bitmask();
                                while bits != 0 {
                                    slots.push(group.first + bits.trailing_zeros());
                                    bits &= bits - 1;
                                }
                            }
                        }
                    }
                }
            },
        );
    }

    #[inline(always)]
    fn most(&self, branch: Branch, ramp: &Ramp) -> f64 {
        self.node(branch).most(ramp)
    }

    #[inline(always)]
    fn node(&self, branch: Branch) -> &Node {
        &self.nodes()[branch.node as usize]
    }
}

/// The branches still to be visited, the next one last, each with a number to remember.
struct Waiting {
    branches: [(Branch, f64); WAITING],
    count: usize,
}

impl Waiting {
    #[inline(always)]
    fn new(nodes: &[Node]) -> Self {
        let mut branches = [(Branch::default(), 0.0); WAITING];
        branches[0] = (Branch::root(nodes), f64::INFINITY);
        Self { branches, count: usize::from(!nodes.is_empty()) }
    }

    #[inline(always)]
    fn next(&mut self) -> Option<(Branch, f64)> {
        self.count = self.count.checked_sub(1)?;
        Some(self.branches[self.count])
    }

    /// Both are to be visited, the first of them first.
    #[inline(always)]
    fn both(&mut self, first: (Branch, f64), second: (Branch, f64)) {
        self.branches[self.count] = second;
        self.branches[self.count + 1] = first;
        self.count += 2;
    }
}

impl RampSums {
    /// Adds all particles of a node: f(r) = f(r̄) − slope·(r − r̄), and Σ (r − r̄) = 0.
    #[inline(always)]
    fn add(&mut self, moments: &Moments, ramp: &Ramp) {
        let Moments { count, mean: place, .. } = *moments;
        let mean = ramp.at(place);
        let turned = moments.spread_times(ramp.slope);
        self.sum += count * mean;
        self.moment += place * (count * mean) - turned;
        self.squares += count * mean * mean + ramp.slope.dot(turned);
        self.largest = None;
    }

    #[inline(always)]
    fn plus<S: Simd>(self, lanes: &LaneSums<S>) -> Self {
        Self {
            sum: self.sum + sum(lanes.sum),
            moment: self.moment + lanes.moment.sum(),
            squares: self.squares + sum(lanes.squares),
            largest: self.largest.map(|_| largest(lanes.largest)),
        }
    }
}

/// [`RampSums`], eight side by side.
struct LaneSums<S: Simd> {
    sum: f64x8<S>,
    moment: Vec3x8<S>,
    squares: f64x8<S>,
    largest: f64x8<S>,
}

impl<S: Simd> LaneSums<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        Self { sum: zero, moment: Vec3x8::splat(simd, DVec3::ZERO), squares: zero, largest: zero }
    }

    /// Adds the values of a group; `share` is each times what its particle weighs.
    #[inline(always)]
    fn add(&mut self, group: &Group<S>, value: f64x8<S>, share: f64x8<S>) {
        self.sum += share;
        self.moment += group.place * share;
        self.squares += value * share;
        self.largest = value.simd_gt(self.largest).select(value, self.largest);
    }
}

/// A ramp, the same in each lane.
struct LaneRamp<S: Simd> {
    offset: f64x8<S>,
    slope: Vec3x8<S>,
}

impl<S: Simd> LaneRamp<S> {
    #[inline(always)]
    fn over(simd: S, ramp: &Ramp) -> Self {
        Self { offset: f64x8::splat(simd, ramp.offset), slope: Vec3x8::splat(simd, ramp.slope) }
    }

    #[inline(always)]
    fn at(&self, place: Vec3x8<S>) -> f64x8<S> {
        self.offset - self.slope.dot(place)
    }

    /// The ramp at the places of a group where it is above zero, and `within` too if there is one; else zero.
    #[inline(always)]
    fn above<const N: usize>(
        simd: S,
        group: &Group<S>,
        ramp: &Ramp,
        within: &[Ramp; N],
    ) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let mut value = positive(simd, LaneRamp::over(simd, ramp).real(simd, group));
        for ramp in within {
            let counts = LaneRamp::over(simd, ramp).at(group.place).simd_gt(zero);
            value = counts.select(value, zero);
        }
        value
    }

    /// The values of the particles, and zero where there is none.
    #[inline(always)]
    fn real(&self, simd: S, group: &Group<S>) -> f64x8<S> {
        let values = self.at(group.place);
        if group.count == LANES {
            return values;
        }
        let mut values: [f64; LANES] = values.into();
        values[group.count..].fill(0.0);
        f64x8::simd_from(simd, values)
    }
}

#[cfg(test)]
#[path = "descend_tests.rs"]
mod tests;
