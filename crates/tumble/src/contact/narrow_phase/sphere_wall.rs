//! Spheres or particles of a body and a wall.

use glam::DVec3;

use super::pair_poses::{PairPoses, PointGeometry};
use crate::contact::pair::{ListedContact, Pair};

/// Geometry of a sphere and a wall {n·x = d}: the depth is r + d − n·x, along n.
#[inline(always)]
pub(super) fn geometry(poses: &PairPoses, pair: &Pair, point: &ListedContact) -> PointGeometry {
    let PairPoses { model, first, .. } = poses;
    let particles = model.bodies[pair.first as usize].shape.particles();
    let position = first.position + first.rotation * particles.at(point.particle);
    let wall = &model.walls[pair.second as usize];
    PointGeometry {
        position,
        separation_or_normal: wall.normal,
        contact_distance_or_depth: pair.contact_distance + wall.depth(position),
        weight: 1.0,
        couple: DVec3::ZERO,
    }
}
