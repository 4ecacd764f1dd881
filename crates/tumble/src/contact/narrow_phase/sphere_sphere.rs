//! Spheres of two bodies.

use glam::DVec3;

use super::pair_poses::{PairPoses, PointGeometry};
use crate::contact::pair::{ListedContact, Pair};

/// Geometry of two spheres: they touch where |x₁ − x₂| < r₁ + r₂, with the normal along x₁ − x₂.
#[inline(always)]
pub(super) fn geometry(poses: &PairPoses, pair: &Pair, point: &ListedContact) -> PointGeometry {
    let PairPoses { model, first, second, .. } = poses;
    let position = first.particle_position(&model.bodies[pair.first as usize], point.particle);
    let other = second.particle_position(&model.bodies[pair.second as usize], point.other);
    let separation = separation_or_fallback(poses, position - other);
    PointGeometry {
        position,
        separation_or_normal: separation,
        contact_distance_or_depth: pair.contact_distance,
        weight: 1.0,
        couple: DVec3::ZERO,
    }
}

/// Coincident centres are separated along the line between the bodies, or upwards where these coincide too.
#[inline(always)]
fn separation_or_fallback(poses: &PairPoses, separation: DVec3) -> DVec3 {
    if separation.length_squared() > 0.0 {
        return separation;
    }
    let between_bodies = poses.first.position - poses.second.position;
    between_bodies.try_normalize().unwrap_or(DVec3::Y) * f64::MIN_POSITIVE.sqrt()
}
