//! Bounds on the normals of the triangles below each node of the tree.

use glam::DVec3;

use super::tree::{LEAF, Tree};
use super::triangle::WIDTH;

/// A cone that contains the normals of a set of triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalCone {
    axis: DVec3,
    /// Cosine and sine of the half-angle; a cosine below zero stands for all directions.
    cosine: f64,
    sine: f64,
}

/// Allows for rounding.
const SLACK: f64 = 1e-9;

impl NormalCone {
    /// All directions.
    const ALL: Self = Self { axis: DVec3::ZERO, cosine: -1.0, sine: 0.0 };

    /// A lower bound on the dot product of a unit vector with the normals of the cone.
    #[inline]
    pub fn least_cosine(&self, direction: DVec3) -> f64 {
        let along = direction.dot(self.axis);
        let across = (1.0 - along * along).max(0.0).sqrt();
        let least = along * self.cosine - across * self.sine;
        // beyond a half turn the sum of the angles says nothing
        let is_known = self.cosine >= 0.0 && along >= -self.cosine;
        if is_known { least - SLACK } else { -1.0 }
    }
}

/// One cone per child of each node.
#[derive(Clone, Debug, Default)]
pub(super) struct NormalCones(Vec<[NormalCone; WIDTH]>);

impl NormalCones {
    pub fn new(tree: &Tree) -> Self {
        let mut cones = vec![[NormalCone::ALL; WIDTH]; tree.nodes.len()];
        for (node, cones) in tree.nodes.iter().zip(&mut cones) {
            for (cone, &child) in cones.iter_mut().zip(&node.child) {
                *cone = cone_below(tree, child);
            }
        }
        Self(cones)
    }

    #[inline(always)]
    pub fn of_child(&self, node: u32, lane: usize) -> &NormalCone {
        &self.0[node as usize][lane]
    }

    pub fn memory(&self) -> usize {
        size_of::<[NormalCone; WIDTH]>() * self.0.capacity()
    }
}

/// The cone about the mean of the normals below a child of a node.
fn cone_below(tree: &Tree, child: u32) -> NormalCone {
    let mut sum = DVec3::ZERO;
    each_normal(tree, child, &mut |normal| sum += normal);
    let Some(axis) = sum.try_normalize() else { return NormalCone::ALL };
    let mut cosine = 1.0f64;
    each_normal(tree, child, &mut |normal| cosine = cosine.min(normal.dot(axis)));
    NormalCone { axis, cosine, sine: (1.0 - cosine * cosine).max(0.0).sqrt() }
}

fn each_normal(tree: &Tree, child: u32, visit: &mut impl FnMut(DVec3)) {
    if child & LEAF != 0 {
        let group = (child & !LEAF) as usize;
        (0..WIDTH).for_each(|lane| visit(tree.groups[group].frame(lane).normal));
        return;
    }
    // the root is the child of no node, and stands for a missing one
    if child == 0 {
        return;
    }
    for &child in &tree.nodes[child as usize].child {
        each_normal(tree, child, visit);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::{Primitive, SignedDistance};

    #[test]
    fn cones_bound_the_normals_below_them() {
        let mesh = Primitive::Torus { radius: 1.0, tube_radius: 0.4, segments: 24 }.mesh().unwrap();
        let distance = SignedDistance::new(&mesh).unwrap();
        let (tree, cones) = (&distance.tree, NormalCones::new(&distance.tree));
        let mut narrow = 0;
        for (index, node) in (0..).zip(&tree.nodes) {
            for (lane, &child) in node.child.iter().enumerate().filter(|(_, child)| **child != 0) {
                for direction in [DVec3::X, DVec3::new(0.6, -0.48, 0.64), -DVec3::Z] {
                    let bound = cones.of_child(index, lane).least_cosine(direction);
                    narrow += u32::from(bound > 0.5);
                    each_normal(tree, child, &mut |normal| assert!(normal.dot(direction) >= bound));
                }
            }
        }
        assert!(narrow > 5, "{narrow}");
    }
}
