//! The closest part of a surface that faces a given way.
//!
//! A point of one body that is inside another has to leave through a face that opposes its own surface. Near an edge of
//! the other body, the closest face of all may be one beside it.

use glam::DVec3;

use super::normal_cones::{NormalCone, NormalCones};
use super::search::{Closest, NO_GROUP, NearestQuery, Query};
use super::signed_distance::SignedDistance;
use super::tree::Tree;
use super::triangle::{FACE, Frame, WIDTH};

/// A part of the surface in front of a point inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exit {
    /// The weighted distance (m).
    pub distance: f64,
    /// How fast it shrinks as the point moves, along the way there.
    pub gradient: DVec3,
    /// The normal of the triangle.
    pub normal: DVec3,
}

/// Weights of the ways out through faces.
pub(crate) trait WayWeight {
    /// The weight of a face with an outward normal, from 0 to 1.
    fn of(&self, normal: DVec3) -> f64;
    /// Whether all normals in a cone certainly have weight zero.
    fn is_zero_in(&self, cone: &NormalCone) -> bool;
}

/// Finds the triangle with the smallest distance over its weight, among those that have the point behind them.
struct WeightedQuery<'a, W> {
    point: DVec3,
    weight: &'a W,
    cones: &'a NormalCones,
    nearest: NearestQuery,
}

impl<W: WayWeight> Query for WeightedQuery<'_, W> {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.nearest.limit()
    }

    #[inline(always)]
    fn leaves_out(&self, node: u32, lane: usize) -> bool {
        self.weight.is_zero_in(self.cones.of_child(node, lane))
    }

    fn visit(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree) {
        let mut weighted = *squared;
        for (lane, squared) in weighted.iter_mut().enumerate() {
            if *squared <= self.nearest.squared {
                let frame = tree.frame(group as usize * WIDTH + lane);
                let weight =
                    if is_behind(&frame, self.point) { self.weight.of(frame.normal) } else { 0.0 };
                *squared = if weight > 0.0 { *squared / (weight * weight) } else { f64::INFINITY };
            }
        }
        self.nearest.visit(group, &weighted, tree);
    }
}

/// Whether a point is on the inner side of the plane of a triangle.
fn is_behind(frame: &Frame, point: DVec3) -> bool {
    (point - frame.origin).dot(frame.normal) <= 0.0
}

impl SignedDistance {
    /// The part of the surface with the smallest weighted distance d/w, among the triangles that have the point behind them;
    /// w is a function of the outward normal, between 0 and 1. `None` if no weighted distance is within a limit (m). The
    /// result depends on mesh, point and weights alone.
    pub(crate) fn nearest_exit(
        &self,
        point: DVec3,
        within: f64,
        weight: &impl WayWeight,
    ) -> Option<Exit> {
        let nearest = NearestQuery::new(within * within);
        let mut query = WeightedQuery { point, weight, cones: &self.cones, nearest };
        self.tree.run(self.level, point, NO_GROUP, &mut query);
        let Closest { slot, squared } = query.nearest.found()?;
        let frame = self.tree.frame(slot);
        let closest = frame.closest_point(point);
        let distance = closest.squared.sqrt();
        let outward = if closest.feature == FACE || distance == 0.0 {
            frame.normal
        } else {
            frame.world_vector(closest.offset) / -distance
        };
        let weighted = squared.sqrt();
        let factor =
            if distance > 0.0 { weighted / distance } else { 1.0 / weight.of(frame.normal) };
        Some(Exit { distance: weighted, gradient: outward * factor, normal: frame.normal })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::Primitive;

    /// Weight above a height of the normal, or below it.
    struct Above(f64, f64);

    impl WayWeight for Above {
        fn of(&self, normal: DVec3) -> f64 {
            self.1 * f64::from(normal.y > self.0)
        }

        fn is_zero_in(&self, cone: &NormalCone) -> bool {
            cone.least_cosine(-DVec3::Y) > -self.0
        }
    }

    #[test]
    fn a_point_near_the_side_of_a_box_leaves_through_the_face_with_weight() {
        let size = DVec3::new(2.0, 2.0, 2.0);
        for divisions in [1, 8] {
            let mesh = Primitive::Box { size, divisions }.mesh().unwrap();
            let distance = SignedDistance::new(&mesh).unwrap();
            let point = DVec3::new(0.999, 0.99, 0.1);
            let up = distance.nearest_exit(point, f64::INFINITY, &Above(0.5, 1.0)).unwrap();
            assert!((up.distance - 0.01).abs() < 1e-15 && up.gradient == DVec3::Y);
            let any = distance.nearest_exit(point, 0.1, &Above(-0.5, 1.0)).unwrap();
            assert!((any.distance - 0.001).abs() < 1e-15 && any.gradient == DVec3::X);
            assert!(distance.nearest_exit(point, 0.1, &Above(1.5, 1.0)).is_none());
            // half the weight is twice the distance
            let half = distance.nearest_exit(point, 0.1, &Above(0.5, 0.5)).unwrap();
            assert!((half.distance - 0.02).abs() < 1e-15 && half.gradient == DVec3::Y * 2.0);
            // behind no face: outside
            assert!(distance.nearest_exit(DVec3::Y * 1.1, 0.2, &Above(0.5, 1.0)).is_none());
        }
    }
}
