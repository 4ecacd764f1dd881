//! A tree over the particles of a shape: bounds, moments, descend.
//!
//! A *ramp* is a function that falls evenly through space: the depth of a particle behind a wall is one,
//! the force of its spring and dashpot another. Summed over particles that all are on the positive side of a ramp,
//! Σ δ, Σ δ r and Σ δ² follow from count, mean and spread of the particles alone. So every node of the tree
//! keeps these, with bounds that tell on which side it is, and only nodes that are cut by the zero of a ramp need
//! to be opened. That is no approximation.

use glam::{DMat3, DVec3};

use super::mass::outer;
use crate::lanes::LANES;

/// Groups of [`LANES`] slots in a leaf.
pub(super) const GROUPS: usize = 4;
/// Particles in a leaf; the last may have fewer.
pub(super) const LEAF: usize = GROUPS * LANES;

/// f(r) = `offset` − `slope`·r: zero on a plane, and growing evenly behind it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ramp {
    /// Its value at the origin.
    pub offset: f64,
    /// How fast it falls, by direction.
    pub slope: DVec3,
}

impl Ramp {
    /// Its value at a place.
    #[inline(always)]
    pub fn at(&self, place: DVec3) -> f64 {
        self.offset - self.slope.dot(place)
    }
}

/// Some particles that are near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// Centre of their bounding box (m).
    centre: DVec3,
    /// Half the sides of the box (m).
    half: DVec3,
    /// Their moments, each counted once whatever it weighs: bounds rest on them.
    pub moments: Moments,
}

/// Sums over some particles, from which those of a ramp follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moments {
    /// How many there are, N, or what they weigh, Σ w.
    pub count: f64,
    /// Their mean r̄ (m).
    pub mean: DVec3,
    /// Their spread Σ w (r − r̄)(r − r̄)ᵀ (m²), as xx, yy, zz, xy, yz, zx.
    spread: [f64; 6],
}

/// Where a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// The ramp is above zero all over the node.
    Inside,
    /// The ramp is nowhere above zero in the node.
    Outside,
    /// Neither is known.
    Cut,
}

impl Side {
    /// The side of what is on this one and on another.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Outside, _) | (_, Self::Outside) => Self::Outside,
            (Self::Inside, Self::Inside) => Self::Inside,
            _ => Self::Cut,
        }
    }
}

impl Node {
    fn of(places: &[DVec3]) -> Self {
        let count = places.len() as f64;
        let (mut low, mut high, mut sum) = (DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO);
        for &place in places {
            low = low.min(place);
            high = high.max(place);
            sum += place;
        }
        let mean = sum / count;
        let spread = places.iter().map(|&p| outer(p - mean, p - mean)).sum();
        let moments = Moments { count, mean, spread: six(spread) };
        Self { moments, ..Self::boxed(low, high) }
    }

    /// Both together.
    fn join(a: &Self, b: &Self) -> Self {
        let low = (a.centre - a.half).min(b.centre - b.half);
        let high = (a.centre + a.half).max(b.centre + b.half);
        Self { moments: Moments::join(&a.moments, &b.moments), ..Self::boxed(low, high) }
    }

    fn boxed(low: DVec3, high: DVec3) -> Self {
        let centre = 0.5 * (low + high);
        let half = (high - centre).max(centre - low);
        let moments = Moments { count: 0.0, mean: centre, spread: [0.0; 6] };
        Self { centre, half, moments }
    }

    /// Centre and radius (m) of a ball about the particles, whatever rounding does.
    pub fn ball(&self) -> (DVec3, f64) {
        (self.centre, self.half.length() * (1.0 + 1e-12))
    }

    /// On which side of the zero of a ramp the node is. Leaves are as soon opened as looked at closely.
    #[inline(always)]
    pub fn side(&self, ramp: &Ramp, is_leaf: bool) -> Side {
        let middle = ramp.at(self.centre);
        let reach = ramp.slope.abs().dot(self.half);
        // what rounding could decide, the particles decide
        let rounding = 4.0 * f64::EPSILON * (ramp.offset.abs() + middle.abs() + reach);
        if middle + reach < -rounding {
            return Side::Outside;
        }
        if middle - reach > rounding {
            return Side::Inside;
        }
        if is_leaf {
            return Side::Cut;
        }
        let (middle, reach) = (ramp.at(self.moments.mean), self.thickness(ramp.slope));
        if middle + reach < -rounding {
            Side::Outside
        } else if middle - reach > rounding {
            Side::Inside
        } else {
            Side::Cut
        }
    }

    /// The ramp is nowhere in the node above this, by its spread; for flat nodes of any orientation close.
    #[inline(always)]
    pub fn most_by_spread(&self, ramp: &Ramp) -> f64 {
        ramp.at(self.moments.mean) + self.thickness(ramp.slope)
    }

    /// The ramp is nowhere in the node above this, by its box.
    #[inline(always)]
    pub fn most(&self, ramp: &Ramp) -> f64 {
        ramp.at(self.centre) + ramp.slope.abs().dot(self.half)
    }

    /// How much a function of this slope can differ over the node from its value at the mean: no value of a set is
    /// farther from their mean than the root of the sum of squares. By this, flat sets of any orientation are thin.
    /// Of weighted squares this is not so, which is why a node keeps the plain moments beside weighted ones.
    #[inline(always)]
    fn thickness(&self, slope: DVec3) -> f64 {
        // the square of a slope may underflow, its direction does not
        let size = slope.abs().max_element();
        let slope = slope / size.max(f64::MIN_POSITIVE);
        let [xx, yy, zz, ..] = self.moments.spread;
        // what rounding can hide in a spread
        let rounding = 16.0 * f64::EPSILON * (xx + yy + zz) * slope.length_squared();
        (slope.dot(self.moments.spread_times(slope)).max(0.0) + rounding).sqrt() * size
    }
}

impl Moments {
    /// Of particles that weigh `weights`; where that is nothing, so are the moments.
    fn weighted(places: &[DVec3], weights: &[f64]) -> Self {
        let each = || places.iter().copied().zip(weights.iter().copied());
        let count: f64 = weights.iter().sum();
        let mean = each().map(|(p, w)| p * w).sum::<DVec3>() / count;
        if !(count > 0.0 && mean.is_finite()) {
            return Self { count: 0.0, mean: places[0], spread: [0.0; 6] };
        }
        let spread = each().map(|(p, w)| outer(p - mean, p - mean) * w).sum();
        Self { count, mean, spread: six(spread) }
    }

    /// Both together, by the parallel axis theorem.
    fn join(a: &Self, b: &Self) -> Self {
        let count = a.count + b.count;
        if count == 0.0 {
            return *a;
        }
        let apart = b.mean - a.mean;
        let mean = a.mean + apart * (b.count / count);
        let between = six(outer(apart, apart) * (a.count * b.count / count));
        let spread = [0, 1, 2, 3, 4, 5].map(|i| a.spread[i] + b.spread[i] + between[i]);
        Self { count, mean, spread }
    }

    /// The spread times a vector.
    #[inline(always)]
    pub fn spread_times(&self, v: DVec3) -> DVec3 {
        let [xx, yy, zz, xy, yz, zx] = self.spread;
        DVec3::new(
            xx * v.x + xy * v.y + zx * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            zx * v.x + yz * v.y + zz * v.z,
        )
    }
}

/// The moments of every node of a tree over `places` that weigh `weights`, both in the order of its leaves.
pub(super) fn weigh(nodes: &[Node], places: &[DVec3], weights: &[f64]) -> Vec<Moments> {
    fn fill(branch: Branch, places: &[DVec3], weights: &[f64], all: &mut [Moments]) -> Moments {
        let moments = match branch.children() {
            Some([a, b]) => {
                let a = fill(a, places, weights, all);
                Moments::join(&a, &fill(b, places, weights, all))
            }
            None => {
                let start = branch.first as usize * LEAF;
                let end = (start + LEAF).min(places.len());
                Moments::weighted(&places[start..end], &weights[start..end])
            }
        };
        all[branch.node as usize] = moments;
        moments
    }
    let mut all: Vec<Moments> = nodes.iter().map(|node| node.moments).collect();
    if !nodes.is_empty() {
        fill(Branch::root(nodes), places, weights, &mut all);
    }
    all
}

fn six(m: DMat3) -> [f64; 6] {
    [m.x_axis.x, m.y_axis.y, m.z_axis.z, m.x_axis.y, m.y_axis.z, m.z_axis.x]
}

/// The order of particles by leaves, and the nodes over them: parents before children, and a left child,
/// with all that is under it, before its sister.
pub(super) fn build(places: &[DVec3]) -> (Vec<u32>, Vec<Node>) {
    let mut sorted: Vec<(DVec3, u32)> = places.iter().copied().zip(0..).collect();
    let leaves = places.len().div_ceil(LEAF);
    let mut nodes = Vec::with_capacity((2 * leaves).saturating_sub(1));
    if leaves > 0 {
        grow(&mut sorted, &mut nodes);
    }
    (sorted.into_iter().map(|(_, index)| index).collect(), nodes)
}

/// Splits the particles across the longest side of their box, half of the leaves to each side, down to leaves;
/// returns the node over all of them.
fn grow(sorted: &mut [(DVec3, u32)], nodes: &mut Vec<Node>) -> Node {
    let leaves = sorted.len().div_ceil(LEAF);
    if leaves == 1 {
        // the same order within the leaf whatever the selection above did
        sorted.sort_unstable_by_key(|&(_, index)| index);
        let mut places = [DVec3::ZERO; LEAF];
        for (place, (sorted, _)) in places.iter_mut().zip(sorted.iter()) {
            *place = *sorted;
        }
        nodes.push(Node::of(&places[..sorted.len()]));
        return nodes[nodes.len() - 1];
    }
    let low = sorted.iter().fold(DVec3::INFINITY, |low, (p, _)| low.min(*p));
    let high = sorted.iter().fold(DVec3::NEG_INFINITY, |high, (p, _)| high.max(*p));
    let axis = (high - low).max_position();
    let middle = left_leaves(leaves) * LEAF;
    // the index decides between equals: the order is the same on every machine
    sorted.select_nth_unstable_by(middle, |(a, i), (b, j)| {
        a[axis].total_cmp(&b[axis]).then(i.cmp(j))
    });
    let here = nodes.len();
    nodes.push(Node::boxed(low, high));
    let (left, right) = sorted.split_at_mut(middle);
    let left = grow(left, nodes);
    let right = grow(right, nodes);
    nodes[here] = Node::join(&left, &right);
    nodes[here]
}

/// How many of the leaves of a node are under its left child.
#[inline(always)]
fn left_leaves(leaves: usize) -> usize {
    leaves / 2
}

/// A place in the tree: a node, and the leaves under it.
#[derive(Clone, Copy, Default)]
pub(super) struct Branch {
    /// The node.
    pub node: u32,
    /// The first of its leaves.
    pub first: u32,
    /// How many leaves it has.
    pub leaves: u32,
}

impl Branch {
    /// The root of a tree.
    #[inline(always)]
    pub fn root(nodes: &[Node]) -> Self {
        Self { node: 0, first: 0, leaves: nodes.len().div_ceil(2) as u32 }
    }

    /// Whether it is a leaf.
    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.leaves == 1
    }

    /// Its children, or `None` for a leaf.
    #[inline(always)]
    pub fn children(self) -> Option<[Self; 2]> {
        if self.is_leaf() {
            return None;
        }
        let left = left_leaves(self.leaves as usize) as u32;
        let Self { node, first, leaves } = self;
        Some([
            Self { node: node + 1, first, leaves: left },
            // a tree of n leaves has 2 n − 1 nodes
            Self { node: node + 2 * left, first: first + left, leaves: leaves - left },
        ])
    }
}
