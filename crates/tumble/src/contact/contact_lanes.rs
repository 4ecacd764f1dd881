//! Contacts between bodies and of spheres with walls, eight side by side.
//!
//! The data of eight contacts, with accessors. Each step of the pipeline has its own file: [`geometry`](super::geometry) computes normals and
//! depths, [`friction`](super::friction) advances the tangential springs, [`forces`](super::forces) evaluates the law.

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*};
use glam::DVec3;

use super::law::linear::LinearSpringDashpot;
use super::pair::Pair;
use super::pose::{BodyPose, pose_or_wall};
use crate::lanes::{Columns, LANES, set, vector};
use crate::{ContactKind, PairSpring};

/// Up to eight contacts, one per lane. Lanes without a contact have depth zero.
#[derive(Clone, Debug)]
pub(super) struct ContactLanes {
    /// Number of lanes in use.
    pub count: usize,
    /// Which pair each contact belongs to, as an index into
    /// [`ChunkContacts::pairs`](super::chunk_contacts::ChunkContacts::pairs).
    pub pair: [u32; LANES],
    /// Index of the point in the neighbour list.
    pub point: [u32; LANES],
    /// The bodies; [`WALL_BODY`](super::pair::WALL_BODY) as second body for a wall.
    pub first: [u32; LANES],
    pub second: [u32; LANES],
    /// Index of the particle, and of the particle of the other body that it touches.
    pub particle: [u32; LANES],
    pub other: [u32; LANES],
    /// The [`ContactKind`], as a number.
    pub kind: [f64; LANES],
    /// Radii of the spheres of the first and the second body; 0 where it is not a sphere that touches (m).
    pub radius: [f64; LANES],
    pub other_radius: [f64; LANES],
    /// Unit normal n, from the second body to the first.
    pub normal: Columns,
    /// Penetration depth δ (m).
    pub depth: [f64; LANES],
    /// For the implicit solver: the gap, minus the depth, of contacts within reach; infinite in other lanes (m).
    pub gap: [f64; LANES],
    /// Torque on the first body in addition to that of the force (N·m); for the implicit solver, over the force (m).
    pub couple: Columns,
    /// For the implicit solver: index of the spring of the latest kick, or [`NO_SPRING`].
    pub spring: [u32; LANES],
    /// From the centre of mass of the first body to the point of contact (m).
    pub arm: Columns,
    /// From the centre of mass of the second body to the same point (m).
    pub other_arm: Columns,
    /// Parameters of the law; all but μ are multiplied by the weight of the particle. The dashpots are complete after the first
    /// evaluation.
    pub stiffness: [f64; LANES],
    pub damping: [f64; LANES],
    pub friction: [f64; LANES],
    pub friction_spring: [f64; LANES],
    pub friction_damping: [f64; LANES],
    /// 1 where the dashpots of a contact act from its own touch on, 0 where from that of its patch.
    pub touches_alone: [f64; LANES],
    /// Whether the dashpots of any of the contacts depend on its patch.
    pub has_patch: bool,
    /// Whether any of the contacts has friction.
    pub has_friction: bool,
    /// Whether any of the bodies has a surface velocity.
    pub has_surface_velocity: bool,
    /// Whether no kick comes before this one.
    pub is_first_kick: bool,
    /// Stretch of the tangential spring at the latest kick, turned with the contact (m).
    pub old_stretch: Columns,
    /// Its stretch now, before the friction limit (m).
    pub stretch: Columns,
    /// The stretch that the friction limit allows (m).
    pub held: Columns,
}

/// Marks a contact without a spring of the latest kick.
pub(super) const NO_SPRING: u32 = u32::MAX;

/// What the geometry of eight contacts is computed from.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneInput {
    /// Position of the particle (m).
    pub particle_position: Columns,
    /// Vector from the second sphere to the first (m); for a wall or mesh, n.
    pub separation_or_normal: Columns,
    /// Distance at which the spheres touch (m); for a wall or mesh, the depth (m).
    pub contact_distance_or_depth: [f64; LANES],
    /// Centres of mass (m).
    pub position: Columns,
    pub other_position: Columns,
    /// Relative velocity and both angular velocities, in the middle of the latest flight.
    pub drift_velocity: Columns,
    pub drift_angular_velocity: Columns,
    pub other_drift_angular_velocity: Columns,
    /// Above zero where the contact has a spring from the latest kick.
    pub has_spring: [f64; LANES],
}

/// Velocities and angular velocities of the first and the second bodies, by lane.
pub(super) struct LaneVelocities {
    pub velocity: [Columns; 2],
    pub angular_velocity: [Columns; 2],
}

impl Default for ContactLanes {
    /// No lane in use.
    fn default() -> Self {
        let (none, zero, vectors) = ([u32::MAX; LANES], [0.0; LANES], Columns::default());
        Self {
            count: 0,
            pair: none,
            point: none,
            first: none,
            second: none,
            particle: none,
            other: none,
            kind: zero,
            radius: zero,
            other_radius: zero,
            normal: vectors,
            depth: zero,
            gap: zero,
            couple: vectors,
            spring: none,
            arm: vectors,
            other_arm: vectors,
            stiffness: zero,
            damping: zero,
            friction: zero,
            friction_spring: zero,
            friction_damping: zero,
            touches_alone: zero,
            has_patch: false,
            has_friction: false,
            has_surface_velocity: false,
            is_first_kick: false,
            old_stretch: vectors,
            stretch: vectors,
            held: vectors,
        }
    }
}

impl ContactLanes {
    /// The law for the normal force.
    #[inline(always)]
    pub fn normal_law<S: Simd>(&self, simd: S) -> LinearSpringDashpot<S> {
        LinearSpringDashpot {
            stiffness: f64x8::simd_from(simd, self.stiffness),
            damping: f64x8::simd_from(simd, self.damping),
        }
    }

    /// The lanes with contacts of a kind.
    #[inline(always)]
    pub fn is_kind<S: Simd>(&self, simd: S, kind: ContactKind) -> mask64x8<S> {
        f64x8::simd_from(simd, self.kind).simd_eq(f64x8::splat(simd, f64::from(kind as u8)))
    }

    /// Distance from the centre of the sphere of the first body to the point of contact, against n, and from that of the second
    /// body, along n (m). Between two spheres each has half of the depth.
    #[inline(always)]
    pub fn contact_offsets<S: Simd>(&self, simd: S, depth: f64x8<S>) -> [f64x8<S>; 2] {
        let zero = f64x8::splat(simd, 0.0);
        let half = self.is_kind(simd, ContactKind::SphereSphere).select(depth * 0.5, zero);
        [
            f64x8::simd_from(simd, self.radius) - half,
            f64x8::simd_from(simd, self.other_radius) - half,
        ]
    }

    /// The lanes in contact.
    #[inline(always)]
    pub fn in_contact(&self) -> impl Iterator<Item = usize> {
        (0..self.count).filter(|&lane| self.depth[lane] > 0.0)
    }

    /// The lanes within reach.
    #[inline(always)]
    pub fn within_reach(&self) -> impl Iterator<Item = usize> {
        (0..self.count).filter(|&lane| self.gap[lane] < f64::INFINITY)
    }

    /// Velocities of the bodies, as their poses have them; with `DRIFT` those in the middle of the flight since the latest kick.
    #[inline(always)]
    pub fn velocities<const DRIFT: bool>(&self, poses: &[BodyPose]) -> LaneVelocities {
        let zero = [[[0.0; LANES]; 3]; 2];
        let mut all = LaneVelocities { velocity: zero, angular_velocity: zero };
        for lane in 0..self.count {
            for (body, index) in [self.first[lane], self.second[lane]].into_iter().enumerate() {
                let pose = pose_or_wall(poses, index);
                let (velocity, angular_velocity) = if DRIFT {
                    (pose.drift_velocity, pose.drift_angular_velocity)
                } else {
                    (pose.velocity, pose.angular_velocity)
                };
                set(&mut all.velocity[body], lane, velocity);
                set(&mut all.angular_velocity[body], lane, angular_velocity);
            }
        }
        all
    }

    /// Surface velocities of the first bodies, less those of the second (m/s).
    pub fn surface_velocity(&self, poses: &[BodyPose]) -> Columns {
        let mut velocity = Columns::default();
        for lane in 0..self.count {
            let of_body = |index: u32| pose_or_wall(poses, index).surface_velocity;
            set(&mut velocity, lane, of_body(self.first[lane]) - of_body(self.second[lane]));
        }
        velocity
    }

    /// Energy in the springs of one contact of the implicit solver (J): its friction spring lasts from kick to kick, although the
    /// bodies may be apart in between.
    pub fn elastic_energy_within_reach(&self, lane: usize) -> f64 {
        let (depth, stretch) = (self.depth[lane], vector(&self.stretch, lane));
        let normal = self.stiffness[lane] * depth * depth;
        let has_spring = self.friction[lane] > 0.0 && self.spring[lane] != NO_SPRING;
        let spring = if has_spring { self.friction_spring[lane] } else { 0.0 };
        0.5 * (normal + spring * stretch.length_squared())
    }

    /// Energy in the springs of one contact (J).
    pub fn elastic_energy(&self, lane: usize) -> f64 {
        let (depth, stretch) = (self.depth[lane], vector(&self.stretch, lane));
        let normal = self.stiffness[lane] * depth * depth;
        // without friction the stretch is not computed
        if self.friction[lane] > 0.0 {
            0.5 * (normal + self.friction_spring[lane] * stretch.length_squared())
        } else {
            0.5 * normal
        }
    }

    /// The key of the friction spring of a contact of a pair, with zero stretch.
    #[inline(always)]
    pub fn spring_key(&self, lane: usize, pair: &Pair) -> PairSpring {
        let Pair { first, second, kind, .. } = *pair;
        let (particle, other) = (self.particle[lane], self.other[lane]);
        PairSpring { first, second, kind, particle, other, stretch: DVec3::ZERO }
    }

    /// Stretch of a friction spring after the latest evaluation (m).
    pub fn kept_stretch(&self, lane: usize) -> DVec3 {
        vector(&self.held, lane)
    }
}
