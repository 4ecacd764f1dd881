//! A point of a surface and the mesh of another body: its contact now, or one that it will have within a step.

use glam::{DMat3, DVec3};

use super::surface_point::{PointContact, SurfacePoint};
use crate::contact::pose::BodyPose;
use crate::{Nearest, SignedDistance};

/// A point and a mesh, in the frame of the mesh.
pub(super) struct PointView<'a> {
    pub surface: SurfacePoint<'a>,
    pub mesh: &'a SignedDistance,
    /// The rotation into the frame of the mesh.
    pub to_mesh: DMat3,
    /// The place of the point (m).
    pub place: DVec3,
    /// The distance at which it may touch (m).
    pub contact_distance: f64,
    /// Whether a step is short enough for the forces of rims.
    pub resolves_rims: bool,
}

impl PointView<'_> {
    /// The contact now, and the vector from the place of the point to that of the contact (m), given the result of a query.
    #[inline(always)]
    pub fn touching(&self, nearest: &Nearest) -> Option<(DVec3, PointContact)> {
        if nearest.distance >= self.contact_distance {
            return None;
        }
        self.surface.contact(self.mesh, self.to_mesh, self.place, nearest)
    }

    /// The contact now, or else that which the point may have within a `step` (s) and at a gap up to `reach` (m), with minus the gap as
    /// its depth. The nearest point of a mesh does not tell from which side it will be touched: of a convex mesh it is the plane that
    /// separates them, of another that which the point gets to at the velocities of the two poses.
    ///
    /// The couple is that over the force, in m.
    pub fn within(
        &self,
        (step, reach): (f64, f64),
        nearest: &Nearest,
        [pose, mesh_pose]: [&BodyPose; 2],
        position: DVec3,
    ) -> Option<(DVec3, PointContact)> {
        let per_force = |contact: PointContact| {
            let couple = contact.couple / (contact.weight * contact.depth);
            PointContact { couple, ..contact }
        };
        if !self.resolves_rims
            && let Some(found) =
                self.surface.with_planes(self.mesh, self.to_mesh, self.place, reach)
        {
            return found;
        }
        if let Some((offset, contact)) = self.touching(nearest) {
            return Some((offset, per_force(contact)));
        }
        let apart = self.surface.apart(self.mesh, self.to_mesh, self.place, reach);
        if apart.is_some() {
            return apart;
        }
        let velocity_at = |pose: &BodyPose, at: DVec3| {
            pose.velocity + pose.angular_velocity.cross(at - pose.position)
        };
        let approach = |at: DVec3| {
            mesh_pose.rotation.transpose() * (velocity_at(pose, at) - velocity_at(mesh_pose, at))
        };
        let place = self.place + approach(position) * step;
        let nearest = self.mesh.query(place, nearest.triangle, f64::INFINITY)?;
        let later = PointView { place, surface: self.surface, ..*self };
        let (offset, contact) = later.touching(&nearest).filter(|(_, c)| c.depth > 0.0)?;
        let contact = per_force(contact);
        let at = position + mesh_pose.rotation * offset;
        let gap = -(contact.depth + approach(at).dot(contact.outward) * step);
        Some((offset, PointContact { depth: -gap.max(0.0), ..contact }))
    }
}
