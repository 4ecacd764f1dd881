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
use crate::smooth_step::{smooth_step, smooth_step_slope};

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

/// Shares of the ways out through faces.
pub(crate) trait Share {
    /// The share of a face with an outward normal, from 0 to 1.
    fn of(&self, normal: DVec3) -> f64;
    /// Whether all normals in a cone certainly have share zero.
    fn is_zero_in(&self, cone: &NormalCone) -> bool;
}

/// The cosine of the angle between the way to the closest point of a face and its normal from which on the way is through the
/// face and not past it.
pub(crate) const THROUGH: f64 = 0.5;

/// Finds the triangle with the smallest weighted distance.
struct WeightedQuery<'a, S> {
    point: DVec3,
    share: &'a S,
    cones: &'a NormalCones,
    nearest: NearestQuery,
}

impl<S: Share> Query for WeightedQuery<'_, S> {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.nearest.limit()
    }

    #[inline(always)]
    fn leaves_out(&self, node: u32, lane: usize) -> bool {
        self.share.is_zero_in(self.cones.of_child(node, lane))
    }

    fn visit(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree) {
        let mut weighted = *squared;
        for (lane, squared) in weighted.iter_mut().enumerate() {
            if *squared <= self.nearest.squared {
                let frame = tree.frame(group as usize * WIDTH + lane);
                let part =
                    smooth_step(height_over_distance(&frame, self.point, *squared) / THROUGH);
                let share = if part > 0.0 { part * self.share.of(frame.normal) } else { 0.0 };
                *squared = if share > 0.0 { *squared / share } else { f64::INFINITY };
            }
        }
        self.nearest.visit(group, &weighted, tree);
    }
}

/// How far a point is below the plane of a triangle, over its distance from the triangle.
fn height_over_distance(frame: &Frame, point: DVec3, squared: f64) -> f64 {
    let height = (frame.origin - point).dot(frame.normal);
    if squared > 0.0 { height / squared.sqrt() } else { 1.0 }
}

impl SignedDistance {
    /// The part of the surface with the smallest weighted distance d/√(w s). w, between 0 and 1, depends on the outward
    /// normal of a triangle. s depends on the angle between the way there and that normal, is 1 up to 60°, and zero from a
    /// right angle on: in a concave body, most faces are seen from their outer side, and lead nowhere. `None` if no weighted
    /// distance is within a limit (m). The result is a continuous function of the point, and depends on mesh, point and
    /// shares alone.
    pub(crate) fn nearest_exit(
        &self,
        point: DVec3,
        within: f64,
        share: &impl Share,
    ) -> Option<Exit> {
        let nearest = NearestQuery::new(within * within);
        let mut query = WeightedQuery { point, share, cones: &self.cones, nearest };
        self.tree.run(self.level, point, NO_GROUP, &mut query);
        let Closest { slot, squared } = query.nearest.found()?;
        let frame = self.tree.frame(slot);
        let closest = frame.closest_point(point);
        let (distance, weighted) = (closest.squared.sqrt(), squared.sqrt());
        let normal = frame.normal;
        if closest.feature == FACE || distance == 0.0 {
            let gradient = normal / share.of(normal).sqrt();
            return Some(Exit { distance: weighted, gradient, normal });
        }
        let outward = frame.world_vector(closest.offset) / -distance;
        let cosine = height_over_distance(&frame, point, closest.squared);
        let x = cosine / THROUGH;
        let slope = smooth_step_slope(x) / (THROUGH * smooth_step(x));
        // the derivative of the cosine as the point moves outwards, times the distance
        let turn = outward * cosine - normal;
        let gradient = outward * (weighted / distance) + turn * (0.5 * weighted * slope / distance);
        Some(Exit { distance: weighted, gradient, normal })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::Primitive;

    /// A share above a height of the normal, or below it.
    struct Above(f64, f64);

    impl Share for Above {
        fn of(&self, normal: DVec3) -> f64 {
            self.1 * f64::from(normal.y > self.0)
        }

        fn is_zero_in(&self, cone: &NormalCone) -> bool {
            cone.least_cosine(-DVec3::Y) > -self.0
        }
    }

    #[test]
    fn a_point_near_the_side_of_a_box_leaves_through_the_face_with_a_share() {
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
            // a quarter of the share is twice the distance
            let half = distance.nearest_exit(point, 0.1, &Above(0.5, 0.25)).unwrap();
            assert!((half.distance - 0.02).abs() < 1e-15 && half.gradient == DVec3::Y * 2.0);
            // behind no face: outside
            assert!(distance.nearest_exit(DVec3::Y * 1.1, 0.2, &Above(0.5, 1.0)).is_none());
        }
    }
}
