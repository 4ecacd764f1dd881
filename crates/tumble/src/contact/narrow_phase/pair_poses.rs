//! The poses of a pair, as the narrow phase reads them.

use glam::DVec3;

use crate::contact::contact_lanes::{ContactLanes, LaneInput};
use crate::contact::context::ContactContext;
use crate::contact::pair::{ListedContact, Pair, contact_particles, wall_weight};
use crate::contact::pose::{BodyPose, pose_or_wall};
use crate::lanes::set;
use crate::{ContactKind, Model, Particles};

/// Where a particle is relative to what it touches.
#[derive(Clone, Copy)]
pub(super) struct PointGeometry {
    /// Position of the particle (m).
    pub position: DVec3,
    /// Vector from the second sphere to the first (m); for a wall or mesh, n.
    pub separation_or_normal: DVec3,
    /// Distance at which the spheres touch (m); for a wall or mesh, the depth (m).
    pub contact_distance_or_depth: f64,
    /// Factor on the stiffness of the normal spring and dashpot.
    pub weight: f64,
    /// Torque on the first body in addition to that of the force, over the stiffness (m²); for the implicit solver over the
    /// force (m).
    pub couple: DVec3,
}

/// The poses of the two bodies of a pair.
pub(super) struct PairPoses<'a> {
    pub model: &'a Model,
    pub first: &'a BodyPose,
    pub second: &'a BodyPose,
    /// Sum of the path lengths of both bodies (m).
    pub path: f64,
    /// An upper bound on how far the bodies move relative to each other in a step (m).
    pub step_displacement: f64,
    /// Contacts are found up to this gap (m).
    pub reach: f64,
}

impl<'a> PairPoses<'a> {
    #[inline(always)]
    pub fn new(context: &ContactContext<'a>, pair: &Pair) -> Self {
        let first = pose_or_wall(context.poses, pair.first);
        let second = pose_or_wall(context.poses, pair.second_body());
        let path = first.path + second.path;
        let step_displacement = first.step_displacement + second.step_displacement;
        let reach = first.reach + second.reach;
        let poses = Self { model: context.model, first, second, path, step_displacement, reach };
        if step_displacement <= pair.tunnelling_limit {
            poses
        } else {
            // motion that both bodies share does not count
            let h = context.since_kick.step;
            Self { step_displacement: poses.relative_step_displacement(pair, h), ..poses }
        }
    }

    fn relative_step_displacement(&self, pair: &Pair, h: f64) -> f64 {
        let Self { model, first, second, .. } = self;
        let rim_speed = |pose: &BodyPose, body: u32| {
            pose.angular_velocity.length() * model.bodies[body as usize].extent
        };
        let rotation = rim_speed(first, pair.first) + rim_speed(second, pair.second);
        h * ((first.velocity - second.velocity).length() + rotation)
    }

    /// Whether one body could pass through the other at a point within a step. The lists may hold an older value of
    /// `clear_until`; such a point is examined again before a step is refused.
    #[inline(always)]
    pub fn may_tunnel(&self, pair: &Pair, path: f64, clear_until: f64) -> bool {
        self.step_displacement > pair.tunnelling_limit
            && path + self.step_displacement > clear_until
    }

    /// Writes the input of a contact into a lane.
    #[inline(always)]
    pub fn write_input(&self, geometry: PointGeometry, lane: usize, input: &mut LaneInput) {
        let (first, second) = (self.first, self.second);
        set(&mut input.particle_position, lane, geometry.position);
        set(&mut input.separation_or_normal, lane, geometry.separation_or_normal);
        input.contact_distance_or_depth[lane] = geometry.contact_distance_or_depth;
        set(&mut input.position, lane, first.position);
        set(&mut input.other_position, lane, second.position);
        set(&mut input.drift_velocity, lane, first.drift_velocity - second.drift_velocity);
        set(&mut input.drift_angular_velocity, lane, first.drift_angular_velocity);
        set(&mut input.other_drift_angular_velocity, lane, second.drift_angular_velocity);
    }

    /// Writes bodies, particles and the parameters of the law into a lane.
    #[inline(always)]
    pub fn write_law(
        &self,
        pair: &Pair,
        point: &ListedContact,
        lane: usize,
        lanes: &mut ContactLanes,
    ) {
        let Pair { first, second, kind, law, .. } = pair;
        let index = |body: u32, slot| {
            contact_particles(&self.model.bodies[body as usize], *kind).index_of_slot(slot)
        };
        let (particle, other) = match kind {
            ContactKind::SphereSphere => {
                (index(*first, point.particle), index(*second, point.other))
            }
            ContactKind::MeshPoint => (index(*second, point.particle), 0),
            ContactKind::SphereWall | ContactKind::PointMesh => (index(*first, point.particle), 0),
        };
        (lanes.particle[lane], lanes.other[lane]) = (particle, other);
        (lanes.first[lane], lanes.second[lane]) = (*first, pair.second_body());
        let weight = match kind {
            ContactKind::SphereSphere => 1.0,
            ContactKind::SphereWall => wall_weight(&self.model.bodies[*first as usize], particle),
            ContactKind::PointMesh => self.particles(*first).weight(particle as usize),
            ContactKind::MeshPoint => self.particles(*second).weight(particle as usize),
        };
        [lanes.radius[lane], lanes.other_radius[lane]] = pair.radii;
        lanes.kind[lane] = f64::from(*kind as u8);
        lanes.stiffness[lane] = weight * law.stiffness;
        lanes.damping[lane] = weight * law.damping;
        lanes.friction[lane] = law.friction;
        lanes.friction_spring[lane] = weight * law.friction_spring;
        lanes.friction_damping[lane] = weight * law.friction_damping;
        lanes.touches_alone[lane] = f64::from(u8::from(!law.depends_on_patch()));
        lanes.has_patch |= law.depends_on_patch();
        lanes.has_friction |= law.friction > 0.0;
        lanes.has_surface_velocity |= pair.has_surface_velocity;
    }

    fn particles(&self, body: u32) -> &Particles {
        self.model.bodies[body as usize].points()
    }
}
