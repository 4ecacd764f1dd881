//! Geometry of contacts: normals, depths and arms.

use fearless_simd::{Simd, f64x8, prelude::*};

use super::contact_lanes::{ContactLanes, LaneInput};
use crate::ContactKind;
use crate::lanes::Vec3x8;

impl ContactLanes {
    /// Computes normals, depths and arms. Lanes that do not touch get a negative depth: minus the gap.
    #[inline(always)]
    pub fn compute_geometry<S: Simd>(&mut self, simd: S, input: &LaneInput) {
        let separation = Vec3x8::load(simd, &input.separation_or_normal);
        let contact_distance = f64x8::simd_from(simd, input.contact_distance_or_depth);
        let is_spheres = self.is_kind(simd, ContactKind::SphereSphere);
        let distance = separation.dot(separation).sqrt();
        let depth = is_spheres.select(contact_distance - distance, contact_distance);
        let one = f64x8::splat(simd, 1.0);
        // for a wall or mesh the separation is n already
        let n = separation.divided_by(is_spheres.select(distance, one));
        self.normal = n.store();
        self.depth = depth.into();
        let [offset, other_offset] = self.contact_offsets(simd, depth);
        let is_mesh_point = self.is_kind(simd, ContactKind::MeshPoint);
        let zero = f64x8::splat(simd, 0.0);
        let offset = is_mesh_point.select(zero - other_offset, offset);
        let point = Vec3x8::load(simd, &input.particle_position) - n * offset;
        self.arm = (point - Vec3x8::load(simd, &input.position)).store();
        self.other_arm = (point - Vec3x8::load(simd, &input.other_position)).store();
    }
}
