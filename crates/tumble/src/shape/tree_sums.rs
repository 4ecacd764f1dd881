//! Queries of the particle tree: sums over the particles behind a wall, the largest depth, and their list.

use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};
use glam::DVec3;

use super::particles::{Group, Particles};
use super::tree::{AffineFunction, Coverage, Moments, Node, Subtree};
use crate::lanes::{LANES, Vec3x8, largest, positive, sum};

/// Capacity of the traversal stack; a tree of 2³² particles needs no more.
const STACK_SIZE: usize = 32;

/// Relative tolerance of the largest value. The particles of a flat face on a wall are equally deep up to
/// rounding, and the tolerance avoids visiting them all.
const TOLERANCE: f64 = 1e-4;

/// Sums of a function f over a set of particles, each multiplied by its weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AffineSums {
    /// The number of particles.
    pub count: f64,
    /// Σ f.
    pub sum: f64,
    /// Σ f r.
    pub moment: DVec3,
    /// Σ f².
    pub squares: f64,
    /// The largest f; known only if no node was summed as a whole.
    pub largest: Option<f64>,
}

impl Particles {
    /// Sums of `function` over the particles at which it is positive; if `within` is given, it must be positive too.
    pub(crate) fn sums(
        &self,
        level: Level,
        function: &AffineFunction,
        within: Option<&AffineFunction>,
    ) -> AffineSums {
        match (within, self.is_weighted()) {
            (None, false) => {
                dispatch!(level, simd => self.sums_in::<_, 0, false>(simd, function, &[]))
            }
            (Some(within), false) => {
                dispatch!(level, simd => self.sums_in::<_, 1, false>(simd, function, &[*within]))
            }
            (None, true) => {
                dispatch!(level, simd => self.sums_in::<_, 0, true>(simd, function, &[]))
            }
            (Some(within), true) => {
                dispatch!(level, simd => self.sums_in::<_, 1, true>(simd, function, &[*within]))
            }
        }
    }

    /// Compiled with and without weights, so that unweighted particles have no extra cost.
    #[inline(always)]
    fn sums_in<S: Simd, const N: usize, const WEIGHTED: bool>(
        &self,
        simd: S,
        function: &AffineFunction,
        within: &[AffineFunction; N],
    ) -> AffineSums {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut whole = AffineSums { largest: Some(0.0), ..AffineSums::default() };
                let mut lanes = LaneSums::zero(simd);
                let mut stack = Stack::new(self.nodes());
                while let Some((subtree, _)) = stack.pop() {
                    let node = self.node(subtree);
                    let mut coverage = node.coverage(function, subtree.is_leaf());
                    for function in within {
                        coverage = coverage.and(node.coverage(function, subtree.is_leaf()));
                    }
                    match coverage {
                        Coverage::None => {}
                        Coverage::All if WEIGHTED => {
                            whole.add(self.weighted_moments(subtree), function);
                        }
                        Coverage::All => whole.add(&node.moments, function),
                        Coverage::Some => match subtree.children() {
                            Some([a, b]) => stack.push_both((a, 0.0), (b, 0.0)),
                            None => {
                                for group in self.groups(simd, subtree) {
                                    let value =
                                        LaneAffine::positive(simd, &group, function, within);
                                    let one = f64x8::splat(simd, 1.0);
                                    if WEIGHTED {
                                        let weights = self.weights(simd, &group);
                                        lanes.add(simd, &group, weights, value, value * weights);
                                    } else {
                                        lanes.add(simd, &group, one, value, value);
                                    }
                                }
                            }
                        },
                    }
                }
                whole.plus(&lanes)
            },
        )
    }

    /// The largest value of `function` over the particles, to a relative 10⁻⁴; zero if it is positive nowhere.
    pub(crate) fn largest(&self, level: Level, function: &AffineFunction) -> f64 {
        dispatch!(level, simd => self.largest_in(simd, function))
    }

    #[inline(always)]
    fn largest_in<S: Simd>(&self, simd: S, function: &AffineFunction) -> f64 {
        simd.vectorize(
            #[inline(always)]
            || {
                let values = LaneAffine::splat(simd, function);
                let mut best = 0.0f64;
                let mut stack = Stack::new(self.nodes());
                while let Some((subtree, bound)) = stack.pop() {
                    // a tight bound may exceed its particle by a rounding
                    let rounding = 4.0 * f64::EPSILON * (function.offset.abs() + best);
                    let enough = best * (1.0 + TOLERANCE) + rounding;
                    if bound <= enough
                        || self.node(subtree).upper_bound_from_scatter(function) <= enough
                    {
                        continue;
                    }
                    match subtree.children() {
                        Some([a, b]) => {
                            let (of_a, of_b) =
                                (self.upper_bound(a, function), self.upper_bound(b, function));
                            if of_a < of_b {
                                stack.push_both((b, of_b), (a, of_a));
                            } else {
                                stack.push_both((a, of_a), (b, of_b));
                            }
                        }
                        None => {
                            for group in self.groups(simd, subtree) {
                                best = best.max(largest(values.values(simd, &group)));
                            }
                        }
                    }
                }
                best
            },
        )
    }

    /// Appends the slots of all particles at which `function` is positive, in order.
    pub(crate) fn collect_positive_slots(
        &self,
        level: Level,
        function: &AffineFunction,
        slots: &mut Vec<u32>,
    ) {
        dispatch!(level, simd => self.list_positive_in(simd, function, slots));
    }

    #[inline(always)]
    fn list_positive_in<S: Simd>(&self, simd: S, function: &AffineFunction, slots: &mut Vec<u32>) {
        simd.vectorize(
            #[inline(always)]
            || {
                let values = LaneAffine::splat(simd, function);
                let mut stack = Stack::new(self.nodes());
                while let Some((subtree, _)) = stack.pop() {
                    let node = self.node(subtree);
                    match (node.coverage(function, subtree.is_leaf()), subtree.children()) {
                        (Coverage::None, _) => {}
                        (Coverage::Some, Some([a, b])) => stack.push_both((a, 0.0), (b, 0.0)),
                        _ => {
                            for group in self.groups(simd, subtree) {
                                let values = values.values(simd, &group);
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
    fn upper_bound(&self, subtree: Subtree, function: &AffineFunction) -> f64 {
        self.node(subtree).upper_bound_from_box(function)
    }

    #[inline(always)]
    fn node(&self, subtree: Subtree) -> &Node {
        &self.nodes()[subtree.node as usize]
    }
}

/// The traversal stack: subtrees still to be visited, each with a bound.
struct Stack {
    subtrees: [(Subtree, f64); STACK_SIZE],
    count: usize,
}

impl Stack {
    #[inline(always)]
    fn new(nodes: &[Node]) -> Self {
        let mut subtrees = [(Subtree::default(), 0.0); STACK_SIZE];
        subtrees[0] = (Subtree::root(nodes), f64::INFINITY);
        Self { subtrees, count: usize::from(!nodes.is_empty()) }
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<(Subtree, f64)> {
        self.count = self.count.checked_sub(1)?;
        Some(self.subtrees[self.count])
    }

    /// Pushes two subtrees, so that `first` is popped before `second`.
    #[inline(always)]
    fn push_both(&mut self, first: (Subtree, f64), second: (Subtree, f64)) {
        self.subtrees[self.count] = second;
        self.subtrees[self.count + 1] = first;
        self.count += 2;
    }
}

impl AffineSums {
    /// Adds all particles of a node, by f(r) = f(r̄) − slope·(r − r̄) and Σ (r − r̄) = 0.
    #[inline(always)]
    fn add(&mut self, moments: &Moments, function: &AffineFunction) {
        let Moments { count, mean: place, .. } = *moments;
        let mean = function.at(place);
        let scattered = moments.scatter_times(function.slope);
        self.count += count;
        self.sum += count * mean;
        self.moment += place * (count * mean) - scattered;
        self.squares += count * mean * mean + function.slope.dot(scattered);
        self.largest = None;
    }

    #[inline(always)]
    fn plus<S: Simd>(self, lanes: &LaneSums<S>) -> Self {
        Self {
            count: self.count + sum(lanes.count),
            sum: self.sum + sum(lanes.sum),
            moment: self.moment + lanes.moment.sum(),
            squares: self.squares + sum(lanes.squares),
            largest: self.largest.map(|_| largest(lanes.largest)),
        }
    }
}

/// [`AffineSums`] in eight lanes.
struct LaneSums<S: Simd> {
    count: f64x8<S>,
    sum: f64x8<S>,
    moment: Vec3x8<S>,
    squares: f64x8<S>,
    largest: f64x8<S>,
}

impl<S: Simd> LaneSums<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let moment = Vec3x8::splat(simd, DVec3::ZERO);
        Self { count: zero, sum: zero, moment, squares: zero, largest: zero }
    }

    /// Adds the values of a group; `weighted` is each value times the weight of its particle.
    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        group: &Group<S>,
        weight: f64x8<S>,
        value: f64x8<S>,
        weighted: f64x8<S>,
    ) {
        let zero = f64x8::splat(simd, 0.0);
        self.count += value.simd_gt(zero).select(weight, zero);
        self.sum += weighted;
        self.moment += group.place * weighted;
        self.squares += value * weighted;
        self.largest = value.simd_gt(self.largest).select(value, self.largest);
    }
}

/// A function, the same in each lane.
struct LaneAffine<S: Simd> {
    offset: f64x8<S>,
    slope: Vec3x8<S>,
}

impl<S: Simd> LaneAffine<S> {
    #[inline(always)]
    fn splat(simd: S, function: &AffineFunction) -> Self {
        Self {
            offset: f64x8::splat(simd, function.offset),
            slope: Vec3x8::splat(simd, function.slope),
        }
    }

    #[inline(always)]
    fn at(&self, place: Vec3x8<S>) -> f64x8<S> {
        self.offset - self.slope.dot(place)
    }

    /// The values of the function where it and `within`, if given, are positive; zero elsewhere.
    #[inline(always)]
    fn positive<const N: usize>(
        simd: S,
        group: &Group<S>,
        function: &AffineFunction,
        within: &[AffineFunction; N],
    ) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let mut value = positive(simd, LaneAffine::splat(simd, function).values(simd, group));
        for function in within {
            let is_within = LaneAffine::splat(simd, function).at(group.place).simd_gt(zero);
            value = is_within.select(value, zero);
        }
        value
    }

    /// The values at the particles of a group; zero in slots without a particle.
    #[inline(always)]
    fn values(&self, simd: S, group: &Group<S>) -> f64x8<S> {
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
#[path = "tree_sums_tests.rs"]
mod tests;
