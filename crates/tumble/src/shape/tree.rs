//! A bounding volume tree over the particles of a shape, with moments in its nodes.
//!
//! A tree sums affine functions of position: the depth of a particle behind a wall is one, the force of
//! its spring and dashpot another. Over particles at which a function δ is positive, the sums Σ δ, Σ δ r and Σ δ²
//! follow from the count, mean and covariance of the particles. Each node of the tree stores these moments
//! and bounds, and only nodes cut by the zero plane of the function have to be opened. The result is exact.

use glam::{DMat3, DVec3};

use super::mass::outer;
use crate::lanes::LANES;

/// Groups of [`LANES`] slots per leaf.
pub(super) const LEAF_GROUPS: usize = 4;
/// Particles per leaf; the last leaf may have fewer.
pub(super) const LEAF_SIZE: usize = LEAF_GROUPS * LANES;

/// The affine function f(r) = `offset` − `slope`·r, zero on a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AffineFunction {
    /// The value at the origin.
    pub offset: f64,
    /// The negative gradient.
    pub slope: DVec3,
}

impl AffineFunction {
    /// The value at a position.
    #[inline(always)]
    pub fn at(&self, place: DVec3) -> f64 {
        self.offset - self.slope.dot(place)
    }
}

/// A node of the tree: a set of nearby particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// Centre of the bounding box (m).
    centre: DVec3,
    /// Half the edges of the bounding box (m).
    half: DVec3,
    /// Unweighted moments; the bounds depend on them.
    pub moments: Moments,
}

/// Moments of a set of particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moments {
    /// The number of particles N, or the sum of their weights Σ w.
    pub count: f64,
    /// The mean r̄ (m).
    pub mean: DVec3,
    /// The scatter matrix Σ w (r − r̄)(r − r̄)ᵀ (m²), as xx, yy, zz, xy, yz, zx.
    scatter: [f64; 6],
}

/// For which particles of a node a function is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coverage {
    /// For all.
    All,
    /// For none.
    None,
    /// Possibly for some.
    Some,
}

impl Coverage {
    /// The coverage of the intersection of two half-spaces.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::None, _) | (_, Self::None) => Self::None,
            (Self::All, Self::All) => Self::All,
            _ => Self::Some,
        }
    }
}

impl Node {
    fn new(places: &[DVec3]) -> Self {
        let count = places.len() as f64;
        let (mut low, mut high, mut sum) = (DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO);
        for &place in places {
            low = low.min(place);
            high = high.max(place);
            sum += place;
        }
        let mean = sum / count;
        let scatter = places.iter().map(|&p| outer(p - mean, p - mean)).sum();
        let moments = Moments { count, mean, scatter: upper_triangle(scatter) };
        Self { moments, ..Self::from_bounds(low, high) }
    }

    /// The union of two nodes.
    fn union(a: &Self, b: &Self) -> Self {
        let low = (a.centre - a.half).min(b.centre - b.half);
        let high = (a.centre + a.half).max(b.centre + b.half);
        Self { moments: Moments::union(&a.moments, &b.moments), ..Self::from_bounds(low, high) }
    }

    fn from_bounds(low: DVec3, high: DVec3) -> Self {
        let centre = 0.5 * (low + high);
        let half = (high - centre).max(centre - low);
        let moments = Moments { count: 0.0, mean: centre, scatter: [0.0; 6] };
        Self { centre, half, moments }
    }

    /// Centre and radius (m) of a bounding sphere, with a margin for rounding.
    pub fn bounding_sphere(&self) -> (DVec3, f64) {
        (self.centre, self.half.length() * (1.0 + 1e-12))
    }

    /// For which particles of the node the function is positive. A leaf is tested by its box only, since
    /// opening it is as cheap as the second test.
    #[inline(always)]
    pub fn coverage(&self, function: &AffineFunction, is_leaf: bool) -> Coverage {
        let middle = function.at(self.centre);
        let extent = function.slope.abs().dot(self.half);
        // within rounding of zero the particles are tested one by one
        let rounding = 4.0 * f64::EPSILON * (function.offset.abs() + middle.abs() + extent);
        if middle + extent < -rounding {
            return Coverage::None;
        }
        if middle - extent > rounding {
            return Coverage::All;
        }
        if is_leaf {
            return Coverage::Some;
        }
        let (middle, extent) = (function.at(self.moments.mean), self.deviation(function.slope));
        if middle + extent < -rounding {
            Coverage::None
        } else if middle - extent > rounding {
            Coverage::All
        } else {
            Coverage::Some
        }
    }

    /// An upper bound of the function over the node, from its scatter; close for planar nodes of any orientation.
    #[inline(always)]
    pub fn upper_bound_from_scatter(&self, function: &AffineFunction) -> f64 {
        function.at(self.moments.mean) + self.deviation(function.slope)
    }

    /// An upper bound of the function over the node, from its box.
    #[inline(always)]
    pub fn upper_bound_from_box(&self, function: &AffineFunction) -> f64 {
        function.at(self.centre) + function.slope.abs().dot(self.half)
    }

    /// A bound on the deviation of a function with this slope from its value at the mean.
    ///
    /// No value of a set deviates from the mean by more than the root of the sum of squared deviations, so
    /// the bound is small across a planar set of any orientation. It does not hold for weighted squares;
    /// hence nodes store unweighted moments too.
    #[inline(always)]
    fn deviation(&self, slope: DVec3) -> f64 {
        // normalised first, since the square of a small slope may underflow
        let size = slope.abs().max_element();
        let slope = slope / size.max(f64::MIN_POSITIVE);
        let [xx, yy, zz, ..] = self.moments.scatter;
        // the error of the scatter by rounding
        let rounding = 16.0 * f64::EPSILON * (xx + yy + zz) * slope.length_squared();
        (slope.dot(self.moments.scatter_times(slope)).max(0.0) + rounding).sqrt() * size
    }
}

impl Moments {
    /// The moments of weighted particles; all zero if the weights sum to zero.
    fn weighted(places: &[DVec3], weights: &[f64]) -> Self {
        let each = || places.iter().copied().zip(weights.iter().copied());
        let count: f64 = weights.iter().sum();
        let mean = each().map(|(p, w)| p * w).sum::<DVec3>() / count;
        if !(count > 0.0 && mean.is_finite()) {
            return Self { count: 0.0, mean: places[0], scatter: [0.0; 6] };
        }
        let scatter = each().map(|(p, w)| outer(p - mean, p - mean) * w).sum();
        Self { count, mean, scatter: upper_triangle(scatter) }
    }

    /// The moments of the union of two sets, by the parallel axis theorem.
    fn union(a: &Self, b: &Self) -> Self {
        let count = a.count + b.count;
        if count == 0.0 {
            return *a;
        }
        let apart = b.mean - a.mean;
        let mean = a.mean + apart * (b.count / count);
        let between = upper_triangle(outer(apart, apart) * (a.count * b.count / count));
        let scatter = [0, 1, 2, 3, 4, 5].map(|i| a.scatter[i] + b.scatter[i] + between[i]);
        Self { count, mean, scatter }
    }

    /// The scatter matrix times a vector.
    #[inline(always)]
    pub fn scatter_times(&self, v: DVec3) -> DVec3 {
        let [xx, yy, zz, xy, yz, zx] = self.scatter;
        DVec3::new(
            xx * v.x + xy * v.y + zx * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            zx * v.x + yz * v.y + zz * v.z,
        )
    }
}

/// The weighted moments of every node of a tree; `places` and `weights` are in the order of its leaves.
pub(super) fn weighted_moments(nodes: &[Node], places: &[DVec3], weights: &[f64]) -> Vec<Moments> {
    fn fill(subtree: Subtree, places: &[DVec3], weights: &[f64], all: &mut [Moments]) -> Moments {
        let moments = match subtree.children() {
            Some([a, b]) => {
                let a = fill(a, places, weights, all);
                Moments::union(&a, &fill(b, places, weights, all))
            }
            None => {
                let start = subtree.first_leaf as usize * LEAF_SIZE;
                let end = (start + LEAF_SIZE).min(places.len());
                Moments::weighted(&places[start..end], &weights[start..end])
            }
        };
        all[subtree.node as usize] = moments;
        moments
    }
    let mut all: Vec<Moments> = nodes.iter().map(|node| node.moments).collect();
    if !nodes.is_empty() {
        fill(Subtree::root(nodes), places, weights, &mut all);
    }
    all
}

fn upper_triangle(m: DMat3) -> [f64; 6] {
    [m.x_axis.x, m.y_axis.y, m.z_axis.z, m.x_axis.y, m.y_axis.z, m.z_axis.x]
}

/// The indices of the particles in the order of the leaves, and the nodes in preorder.
pub(super) fn build(places: &[DVec3]) -> (Vec<u32>, Vec<Node>) {
    let mut sorted: Vec<(DVec3, u32)> = places.iter().copied().zip(0..).collect();
    let leaves = places.len().div_ceil(LEAF_SIZE);
    let mut nodes = Vec::with_capacity((2 * leaves).saturating_sub(1));
    if leaves > 0 {
        build_subtree(&mut sorted, &mut nodes);
    }
    (sorted.into_iter().map(|(_, index)| index).collect(), nodes)
}

/// Splits the particles recursively across the longest side of their box, half of the leaves to each side;
/// returns the root of the subtree.
fn build_subtree(sorted: &mut [(DVec3, u32)], nodes: &mut Vec<Node>) -> Node {
    let leaves = sorted.len().div_ceil(LEAF_SIZE);
    if leaves == 1 {
        // a fixed order within the leaf, since the selection above leaves it open
        sorted.sort_unstable_by_key(|&(_, index)| index);
        let mut places = [DVec3::ZERO; LEAF_SIZE];
        for (place, (sorted, _)) in places.iter_mut().zip(sorted.iter()) {
            *place = *sorted;
        }
        nodes.push(Node::new(&places[..sorted.len()]));
        return nodes[nodes.len() - 1];
    }
    let low = sorted.iter().fold(DVec3::INFINITY, |low, (p, _)| low.min(*p));
    let high = sorted.iter().fold(DVec3::NEG_INFINITY, |high, (p, _)| high.max(*p));
    let axis = (high - low).max_position();
    let middle = left_leaves(leaves) * LEAF_SIZE;
    // ties are broken by index, so that the order is the same on every machine
    sorted.select_nth_unstable_by(middle, |(a, i), (b, j)| {
        a[axis].total_cmp(&b[axis]).then(i.cmp(j))
    });
    let here = nodes.len();
    nodes.push(Node::from_bounds(low, high));
    let (left, right) = sorted.split_at_mut(middle);
    let left = build_subtree(left, nodes);
    let right = build_subtree(right, nodes);
    nodes[here] = Node::union(&left, &right);
    nodes[here]
}

/// The number of leaves under the left child of a node.
#[inline(always)]
fn left_leaves(leaves: usize) -> usize {
    leaves / 2
}

/// A subtree: a node and the leaves under it.
#[derive(Clone, Copy, Default)]
pub(super) struct Subtree {
    /// The index of the node.
    pub node: u32,
    /// The index of its first leaf.
    pub first_leaf: u32,
    /// The number of its leaves.
    pub leaves: u32,
}

impl Subtree {
    /// The whole tree.
    #[inline(always)]
    pub fn root(nodes: &[Node]) -> Self {
        Self { node: 0, first_leaf: 0, leaves: nodes.len().div_ceil(2) as u32 }
    }

    /// Whether it is a leaf.
    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.leaves == 1
    }

    /// The children, or `None` for a leaf.
    #[inline(always)]
    pub fn children(self) -> Option<[Self; 2]> {
        if self.is_leaf() {
            return None;
        }
        let left = left_leaves(self.leaves as usize) as u32;
        let Self { node, first_leaf, leaves } = self;
        Some([
            Self { node: node + 1, first_leaf, leaves: left },
            // a tree of n leaves has 2 n − 1 nodes
            Self { node: node + 2 * left, first_leaf: first_leaf + left, leaves: leaves - left },
        ])
    }
}
