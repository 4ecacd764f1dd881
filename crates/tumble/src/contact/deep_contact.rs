//! Contacts so deep that bodies could pass through each other.
//!
//! A contact is judged by its depth relative to what one body would have to pass through to come out on the other side of
//! the other: half of the thickness of a mesh next to the particle, plus the radius of a sphere; of two spheres the sum of
//! their radii. Beyond that length l the contact would push the wrong way.
//!
//! A depth above 3/4 l is an error, or a warning where the mesh is much thinner than elsewhere. A particle of a body that
//! passes through a plate is deeper than l − s/2 in at least one step, with s the displacement in a step, which is at most l
//! ([`tunnelling`](super::tunnelling)); so this is an error too. In a
//! wedge the faces are nearer than the thickness tells: up to an angle of 50° between them, no particle comes out on the
//! other side unnoticed.

use glam::DVec3;

use super::contact_lanes::ContactLanes;
use super::pair::{Pair, sphere_radius};
use super::pose::BodyPose;
use crate::lanes::vector;
use crate::{BodyModel, ContactKind, Model};

/// A depth above this part of what a body would have to pass through is an error.
pub(crate) const LARGEST_DEPTH: f64 = 0.75;
/// A part of a mesh is thin if its thickness is below this part of the median thickness.
const THIN: f64 = 0.5;
/// A depth above this part is a reason for a warning. The displacement in a step lowers the limit to no less than this.
pub(crate) const WARNING_DEPTH: f64 = 0.5 * LARGEST_DEPTH;

/// The deepest contact of two bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeepContact {
    pub first: u32,
    pub second: u32,
    pub(super) kind: ContactKind,
    /// From the centre of mass of the first body to the contact (m).
    pub(super) arm: DVec3,
    /// Unit normal, from the second body to the first.
    pub normal: DVec3,
    /// Depth (m).
    pub depth: f64,
    /// What a body would have to pass through (m).
    pub passage: f64,
    /// The depth above which the bodies may pass through each other (m).
    pub limit: f64,
    /// Whether a thin part of a mesh is concerned, as a limb is.
    pub is_thin: bool,
    /// Sum of the forces of the springs of this pair (N).
    pub load: f64,
    /// Stiffness of the contact law (N/m).
    pub stiffness: f64,
    /// Time (s).
    pub time: f64,
}

impl DeepContact {
    /// For a pair; its contacts are to be added.
    pub(super) fn new(pair: &Pair) -> Self {
        let Pair { first, second, kind, tunnelling_limit, law, .. } = *pair;
        Self {
            first,
            second,
            kind,
            arm: DVec3::ZERO,
            normal: DVec3::ZERO,
            depth: 0.0,
            passage: tunnelling_limit,
            limit: LARGEST_DEPTH * tunnelling_limit,
            is_thin: false,
            load: 0.0,
            stiffness: law.stiffness,
            time: 0.0,
        }
    }

    /// Adds one contact of the pair.
    pub(super) fn add(&mut self, lanes: &ContactLanes, lane: usize) {
        let depth = lanes.depth[lane];
        self.load += lanes.stiffness[lane] * depth;
        if depth > self.depth {
            self.depth = depth;
            (self.arm, self.normal) = (vector(&lanes.arm, lane), vector(&lanes.normal, lane));
        }
    }

    /// Depth relative to what a body would have to pass through.
    pub fn share(&self) -> f64 {
        self.depth / self.passage
    }

    /// Whether the bodies may pass through each other. Where a tip goes through an ear, other contacts hold them apart: that is
    /// only a reason for a warning.
    pub fn is_too_deep(&self) -> bool {
        self.depth > self.limit && !self.is_thin
    }

    /// The same with limits that hold for this place and speed: the thickness of a mesh next to the particle, where it is
    /// thicker than the thin parts after which the limit of the pair is chosen, and the displacement in a step.
    pub(super) fn with_local_limit(&self, model: &Model, poses: &[BodyPose]) -> Self {
        let body = |index: u32| (&*model.bodies[index as usize], &poses[index as usize]);
        let (first, second) = (body(self.first), body(self.second));
        let (local, is_thin) = match self.kind {
            ContactKind::PointMesh => self.thickness(first, second, first.1),
            ContactKind::MeshPoint => self.thickness(second, first, first.1),
            ContactKind::SphereSphere | ContactKind::SphereWall => (self.passage, false),
        };
        let passage = self.passage.max(local);
        let rim_speed =
            |(body, pose): (&BodyModel, &BodyPose)| pose.angular_velocity.length() * body.extent;
        let speed = (first.1.velocity - second.1.velocity).length();
        let step = model.dt * (speed + rim_speed(first) + rim_speed(second));
        let limit = (LARGEST_DEPTH * passage).min(passage - 0.5 * step);
        Self { passage, limit, is_thin, ..*self }
    }

    /// Half of the thickness of the mesh next to the particle, plus the radius of a sphere (m); and whether it is thin there.
    fn thickness(
        &self,
        (body, _): (&BodyModel, &BodyPose),
        (mesh, mesh_pose): (&BodyModel, &BodyPose),
        first: &BodyPose,
    ) -> (f64, bool) {
        let offset = first.position + self.arm - mesh_pose.position;
        let local = mesh_pose.rotation.transpose() * offset;
        let found = mesh.signed_distance.as_ref().and_then(|distance| {
            let thickness = distance.thickness_near(local)?;
            let is_thin = thickness < THIN * distance.median_thickness();
            Some((sphere_radius(body) + 0.5 * thickness, is_thin))
        });
        found.unwrap_or((0.0, false))
    }
}
