//! Tangential springs between bodies: how they turn and stretch from one kick to the next.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

use super::contact_lanes::{ContactLanes, LaneInput};
use super::pose::BodyPose;
use crate::ContactKind;
use crate::lanes::{Vec3x8, set};

impl ContactLanes {
    /// Sets the stretch that the spring of a lane had at the latest kick (m).
    #[inline(always)]
    pub fn set_old_stretch(&mut self, lane: usize, stretch: DVec3) {
        set(&mut self.old_stretch, lane, stretch);
    }

    /// Advances the tangential springs over the time `h` (s) since the latest kick.
    ///
    /// A spring turns with the normal and with the surface that holds it, keeps its length, and stretches by the relative
    /// displacement of the bodies, with velocities and arms as they were in the middle of that time. A new spring starts
    /// without stretch.
    #[inline(always)]
    pub fn advance_friction<S: Simd>(
        &mut self,
        simd: S,
        input: &LaneInput,
        poses: &[BodyPose],
        h: f64,
    ) {
        let n = Vec3x8::load(simd, &self.normal);
        let (omega, other_omega) = (
            Vec3x8::load(simd, &input.drift_angular_velocity),
            Vec3x8::load(simd, &input.other_drift_angular_velocity),
        );
        let zero = f64x8::splat(simd, 0.0);

        // the old stretch, turned about n with the surface, then into the tangent plane at its old length
        let has_spring = f64x8::simd_from(simd, input.has_spring).simd_gt(zero);
        let zeros = Vec3x8::splat(simd, DVec3::ZERO);
        let old = Vec3x8::select(has_spring, Vec3x8::load(simd, &self.old_stretch), zeros);
        let spin = self
            .is_kind(simd, ContactKind::SphereSphere)
            .select((omega + other_omega).dot(n) * 0.5, zero);
        let spin = self.is_kind(simd, ContactKind::PointMesh).select(other_omega.dot(n), spin);
        let spin = self.is_kind(simd, ContactKind::MeshPoint).select(omega.dot(n), spin);
        let tangential = (old + n.cross(old) * (spin * h)).perpendicular_to(n);
        let (old_square, new_square) = (old.dot(old), tangential.dot(tangential));
        // nothing is left of a stretch whose normal turned by a right angle
        let old =
            tangential * new_square.simd_gt(zero).select((old_square / new_square).sqrt(), zero);
        self.old_stretch = old.store();

        // arms in the middle of the flight: spheres turn with their bodies; on a mesh, the point below the particle counts
        let arm = Vec3x8::load(simd, &self.arm);
        let other_arm = Vec3x8::load(simd, &self.other_arm);
        let depth = f64x8::simd_from(simd, self.depth);
        let [offset, other_offset] = self.contact_offsets(simd, depth);
        let half_back = f64x8::splat(simd, -0.5 * h);
        let drift = Vec3x8::load(simd, &input.drift_velocity);
        let mid_arm = arm + omega.cross(arm + n * offset) * half_back;
        let other_mid_arm = other_arm + other_omega.cross(other_arm - n * other_offset) * half_back;
        let half = f64x8::splat(simd, 0.5 * h);
        let on_mesh = other_arm - (drift + omega.cross(mid_arm)) * half;
        let first_is_point = self.is_kind(simd, ContactKind::PointMesh)
            | self.is_kind(simd, ContactKind::SphereWall);
        let other_mid_arm = Vec3x8::select(first_is_point, on_mesh, other_mid_arm);
        let on_mesh = arm + (drift - other_omega.cross(other_mid_arm)) * half;
        let mid_arm = Vec3x8::select(self.is_kind(simd, ContactKind::MeshPoint), on_mesh, mid_arm);

        let mut u = drift + (omega.cross(mid_arm) - other_omega.cross(other_mid_arm));
        if self.has_surface_velocity {
            u += Vec3x8::load(simd, &self.surface_velocity(poses)).perpendicular_to(n);
        }
        self.stretch =
            Vec3x8::select(has_spring, old + u.perpendicular_to(n) * f64x8::splat(simd, h), zeros)
                .store();
    }
}
