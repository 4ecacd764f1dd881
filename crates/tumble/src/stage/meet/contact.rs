//! Contacts, eight side by side: their geometry, their springs and their forces.

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*};
use glam::DVec3;

use super::find::Touching;
use super::list::Pair;
use super::pose::{self, Pose};
use crate::lanes::{Columns, LANES, Vec3x8, positive, set, vector};
use crate::stage::contact::within;
use crate::{ContactKind, PairSpring, Wrench};

/// Up to eight places where two bodies touch, or a sphere and a wall, one a lane. A lane without a contact has depth zero.
#[derive(Clone, Debug)]
pub(super) struct Eight {
    /// How many lanes are in use.
    pub count: usize,
    /// Which of the pairs that are near, as an index into [`Found::touching`](super::find::Found::touching).
    pub touching: [u32; LANES],
    /// Which point of the list.
    pub point: [u32; LANES],
    /// The bodies; for a wall as second body a number that no body has.
    pub first: [u32; LANES],
    pub second: [u32; LANES],
    /// Which particle touches, and which it touches.
    pub particle: [u32; LANES],
    pub other: [u32; LANES],
    /// The [`ContactKind`], as a number.
    pub kind: [f64; LANES],
    /// The radius of the sphere of the first body, if it is a sphere that touches, and of the second (m).
    pub radius: [f64; LANES],
    pub other_radius: [f64; LANES],
    /// Unit normal n, from the second body to the first.
    pub normal: Columns,
    /// Depth δ (m).
    pub depth: [f64; LANES],
    /// From the centre of mass of the first body to the point of contact (m).
    arm: Columns,
    /// From the centre of mass of the second body to the same point (m).
    other_arm: Columns,
    /// The laws, each of their terms but μ times the weight of the particle.
    pub stiffness: [f64; LANES],
    pub damping: [f64; LANES],
    pub friction: [f64; LANES],
    pub friction_spring: [f64; LANES],
    pub friction_damping: [f64; LANES],
    /// Whether one of them has friction.
    pub has_friction: bool,
    /// Whether one of the bodies has a surface that moves along itself.
    pub has_belt: bool,
    /// Stretch of the tangential spring at the latest kick, turned with the contact (m).
    before: Columns,
    /// Its stretch now, before the limit (m).
    stretch: Columns,
    /// What part of that is left after the latest push.
    held: [f64; LANES],
}

/// What eight contacts are found from.
#[derive(Clone, Debug, Default)]
pub(super) struct Approach {
    /// Where the particle is (m).
    pub place: Columns,
    /// From the one sphere to the other (m); against a wall or mesh, n.
    pub apart: Columns,
    /// How far apart spheres touch; against a wall or mesh, the depth (m).
    pub reach: [f64; LANES],
    /// Where the centres of mass are (m).
    pub position: Columns,
    pub other_position: Columns,
    /// Velocity of the one against the other, and both angular velocities, in the middle of the latest flight.
    pub drift: Columns,
    pub spin: Columns,
    pub other_spin: Columns,
    /// Above zero where there was a spring before.
    pub known: [f64; LANES],
}

/// What of the contacts of two bodies is kept and accounted for besides their forces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Losses {
    /// What the dashpots do to the first body, and the other way round to the second.
    pub dashpot: Couple,
    /// Energy lost to slip (J).
    pub slip: f64,
    /// The deepest contact (m).
    pub max_depth: f64,
    /// What the moving surface of a held body puts in (W).
    pub belt_power: f64,
    /// What dashpots take of that (W).
    pub belt_loss: f64,
}

/// A force at a point, and its torques about two centres of mass: to the first body as they are, to the second the other way
/// round.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Couple {
    pub force: DVec3,
    pub torque: DVec3,
    pub other_torque: DVec3,
}

impl Couple {
    /// On the first body.
    pub fn on_first(&self) -> Wrench {
        Wrench { force: self.force, torque: self.torque }
    }

    /// On the second body: the opposite force at the same point.
    pub fn on_second(&self) -> Wrench {
        Wrench { force: -self.force, torque: -self.other_torque }
    }
}

/// Forces at eight points, and their torques about two centres of mass.
struct Couples {
    force: Columns,
    torque: Columns,
    other_torque: Columns,
}

impl Couples {
    #[inline(always)]
    fn of<S: Simd>(force: Vec3x8<S>, arm: Vec3x8<S>, other_arm: Vec3x8<S>) -> Self {
        Self {
            force: force.store(),
            torque: arm.cross(force).store(),
            other_torque: other_arm.cross(force).store(),
        }
    }

    #[inline(always)]
    fn add_to(&self, lane: usize, sum: &mut Couple) {
        sum.force += vector(&self.force, lane);
        sum.torque += vector(&self.torque, lane);
        sum.other_torque += vector(&self.other_torque, lane);
    }
}

/// Vectors by lane and body.
struct Velocities {
    velocity: [Columns; 2],
    spin: [Columns; 2],
}

impl Default for Eight {
    /// No lane in use.
    fn default() -> Self {
        let (none, zero, vectors) = ([u32::MAX; LANES], [0.0; LANES], Columns::default());
        Self {
            count: 0,
            touching: none,
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
            arm: vectors,
            other_arm: vectors,
            stiffness: zero,
            damping: zero,
            friction: zero,
            friction_spring: zero,
            friction_damping: zero,
            has_friction: false,
            has_belt: false,
            before: vectors,
            stretch: vectors,
            held: zero,
        }
    }
}

impl Eight {
    /// Where the contacts are, and how deep; a lane that does not touch has a negative depth, what it lacks.
    #[inline(always)]
    pub fn touch<S: Simd>(&mut self, simd: S, approach: &Approach) {
        let apart = Vec3x8::load(simd, &approach.apart);
        let reach = f64x8::simd_from(simd, approach.reach);
        let spheres = self.is(simd, ContactKind::Spheres);
        let distance = apart.dot(apart).sqrt();
        let depth = spheres.select(reach - distance, reach);
        let one = f64x8::splat(simd, 1.0);
        // a wall or mesh gives n as it is
        let n = apart.over(spheres.select(distance, one));
        self.normal = n.store();
        self.depth = depth.into();
        let [offset, other_offset] = self.offsets(simd, depth);
        let from_second = self.is(simd, ContactKind::SecondInFirst);
        let zero = f64x8::splat(simd, 0.0);
        let back = from_second.select(zero - other_offset, offset);
        let at = Vec3x8::load(simd, &approach.place) - n * back;
        self.arm = (at - Vec3x8::load(simd, &approach.position)).store();
        self.other_arm = (at - Vec3x8::load(simd, &approach.other_position)).store();
    }

    /// The lanes with contacts of a kind.
    #[inline(always)]
    fn is<S: Simd>(&self, simd: S, kind: ContactKind) -> mask64x8<S> {
        f64x8::simd_from(simd, self.kind).simd_eq(f64x8::splat(simd, f64::from(kind as u8)))
    }

    /// From the centre of the sphere of the first body to the point of contact, against n, and from that of the second, along n
    /// (m): of two spheres, half the depth is each one's.
    #[inline(always)]
    fn offsets<S: Simd>(&self, simd: S, depth: f64x8<S>) -> [f64x8<S>; 2] {
        let zero = f64x8::splat(simd, 0.0);
        let half = self.is(simd, ContactKind::Spheres).select(depth * 0.5, zero);
        [
            f64x8::simd_from(simd, self.radius) - half,
            f64x8::simd_from(simd, self.other_radius) - half,
        ]
    }

    /// Gives a lane the stretch that its spring had at the latest kick (m).
    #[inline(always)]
    pub fn remember(&mut self, lane: usize, stretch: DVec3) {
        set(&mut self.before, lane, stretch);
    }

    /// Carries the tangential springs on over the time `h` (s) since the latest kick: they turn with the normals and with the
    /// surfaces that hold them, keep their lengths, and stretch by the way of the one body against the other,
    /// with velocity and arms as they were in the middle of that time. A new spring is held where it is found.
    #[inline(always)]
    pub fn carry<S: Simd>(&mut self, simd: S, approach: &Approach, poses: &[Pose], h: f64) {
        let n = Vec3x8::load(simd, &self.normal);
        let (w, other_w) =
            (Vec3x8::load(simd, &approach.spin), Vec3x8::load(simd, &approach.other_spin));
        let zero = f64x8::splat(simd, 0.0);

        let known = f64x8::simd_from(simd, approach.known).simd_gt(zero);
        let none = Vec3x8::splat(simd, DVec3::ZERO);
        let before = Vec3x8::select(known, Vec3x8::load(simd, &self.before), none);
        let spin = self.is(simd, ContactKind::Spheres).select((w + other_w).dot(n) * 0.5, zero);
        let spin = self.is(simd, ContactKind::FirstInSecond).select(other_w.dot(n), spin);
        let spin = self.is(simd, ContactKind::SecondInFirst).select(w.dot(n), spin);
        let along = (before + n.cross(before) * (spin * h)).across(n);
        let (old, new) = (before.dot(before), along.dot(along));
        // a normal that turned by a right angle leaves nothing to keep
        let before = along * new.simd_gt(zero).select((old / new).sqrt(), zero);
        self.before = before.store();

        // spheres turn with their bodies; of a mesh, the place where the other is counts
        let arm = Vec3x8::load(simd, &self.arm);
        let other_arm = Vec3x8::load(simd, &self.other_arm);
        let depth = f64x8::simd_from(simd, self.depth);
        let [offset, other_offset] = self.offsets(simd, depth);
        let back = f64x8::splat(simd, -0.5 * h);
        let drift = Vec3x8::load(simd, &approach.drift);
        let mid_arm = arm + w.cross(arm + n * offset) * back;
        let other_mid_arm = other_arm + other_w.cross(other_arm - n * other_offset) * back;
        let forth = f64x8::splat(simd, 0.5 * h);
        let of_mesh = other_arm - (drift + w.cross(mid_arm)) * forth;
        let by_first = self.is(simd, ContactKind::FirstInSecond) | self.is(simd, ContactKind::Wall);
        let other_mid_arm = Vec3x8::select(by_first, of_mesh, other_mid_arm);
        let of_mesh = arm + (drift - other_w.cross(other_mid_arm)) * forth;
        let mid_arm = Vec3x8::select(self.is(simd, ContactKind::SecondInFirst), of_mesh, mid_arm);
        let mut u = drift + (w.cross(mid_arm) - other_w.cross(other_mid_arm));
        if self.has_belt {
            u += Vec3x8::load(simd, &self.belt(poses)).across(n);
        }
        self.stretch =
            Vec3x8::select(known, before + u.across(n) * f64x8::splat(simd, h), none).store();
    }

    /// Adds the forces of the contacts with the velocities of the bodies to those of their pairs; see [`crate::stage::contact()`] for
    /// the law. A first look, which only foretells velocities, leaves out what is kept and accounted for.
    #[inline(always)]
    pub fn push<S: Simd, const FIRST: bool>(
        &mut self,
        simd: S,
        poses: &[Pose],
        touching: &mut [Touching],
        losses: &mut [Losses],
    ) {
        let n = Vec3x8::load(simd, &self.normal);
        let (arm, other_arm) = (Vec3x8::load(simd, &self.arm), Vec3x8::load(simd, &self.other_arm));
        let u = self.relative_velocity(simd, poses, n);
        let u_n = u.dot(n);
        let zero = f64x8::splat(simd, 0.0);
        let depth = f64x8::simd_from(simd, self.depth);
        let spring = f64x8::simd_from(simd, self.stiffness) * depth;
        let push = positive(simd, spring - f64x8::simd_from(simd, self.damping) * u_n);
        let push = depth.simd_gt(zero).select(push, zero);
        let mut force = n * push;
        let mut brake = n * (push - spring);
        let mut slip = [0.0; LANES];
        let mut belts = [[0.0; LANES]; 2];
        if self.has_friction {
            let limit = f64x8::simd_from(simd, self.friction) * push;
            let hold = self.hold::<S, FIRST>(simd, limit, &mut slip);
            let drag = u.across(n) * (zero - f64x8::simd_from(simd, self.friction_damping));
            let drag = drag * within(simd, hold, drag, limit);
            force += hold + drag;
            brake += drag;
            if !FIRST && self.has_belt {
                // the other way round: what the surface of the second does to the first
                let belt = Vec3x8::load(simd, &self.belt(poses)) * f64x8::splat(simd, -1.0);
                belts = [(hold + drag).dot(belt).into(), drag.dot(belt).into()];
            }
        }
        let all = Couples::of(force, arm, other_arm);
        if FIRST {
            for lane in self.in_contact() {
                all.add_to(lane, &mut touching[self.touching[lane] as usize].forces);
            }
            return;
        }
        let brake = Couples::of(brake, arm, other_arm);
        for lane in self.in_contact() {
            let pair = self.touching[lane] as usize;
            all.add_to(lane, &mut touching[pair].forces);
            let sum = &mut losses[pair];
            brake.add_to(lane, &mut sum.dashpot);
            sum.slip += slip[lane];
            sum.max_depth = sum.max_depth.max(self.depth[lane]);
            sum.belt_power += belts[0][lane];
            sum.belt_loss += belts[1][lane];
        }
    }

    /// The tangential springs, as much of them as the limits (N) let hold.
    #[inline(always)]
    fn hold<S: Simd, const FIRST: bool>(
        &mut self,
        simd: S,
        limit: f64x8<S>,
        slip: &mut [f64; LANES],
    ) -> Vec3x8<S> {
        let k = f64x8::simd_from(simd, self.friction_spring);
        let stretch = Vec3x8::load(simd, &self.stretch);
        let square = k * k * stretch.dot(stretch);
        let beyond = square.simd_gt(limit * limit);
        let part = beyond.select(limit / square.sqrt(), f64x8::splat(simd, 1.0));
        let held = stretch * part;
        if !FIRST {
            self.held = part.into();
            // the work of friction on the way from stretch to stretch, less what the spring takes up
            let lost = (Vec3x8::load(simd, &self.before) + held).dot(stretch - held);
            let zero = f64x8::splat(simd, 0.0);
            *slip = beyond.select(k * 0.5 * lost, zero).into();
        }
        held * (f64x8::splat(simd, 0.0) - k)
    }

    /// Velocity of the first body against the second at the points of contact (m/s).
    #[inline(always)]
    fn relative_velocity<S: Simd>(&self, simd: S, poses: &[Pose], n: Vec3x8<S>) -> Vec3x8<S> {
        let Velocities { velocity, spin } = self.velocities(poses);
        let u = velocity_at(simd, [&velocity[0], &spin[0], &self.arm])
            - velocity_at(simd, [&velocity[1], &spin[1], &self.other_arm]);
        if self.has_belt { u + Vec3x8::load(simd, &self.belt(poses)).across(n) } else { u }
    }

    #[inline(always)]
    fn velocities(&self, poses: &[Pose]) -> Velocities {
        let none = [[[0.0; LANES]; 3]; 2];
        let mut all = Velocities { velocity: none, spin: none };
        for lane in 0..self.count {
            for (body, index) in [self.first[lane], self.second[lane]].into_iter().enumerate() {
                let pose = pose::of(poses, index);
                set(&mut all.velocity[body], lane, pose.velocity);
                set(&mut all.spin[body], lane, pose.angular_velocity);
            }
        }
        all
    }

    /// Velocities of the surfaces of the first bodies along themselves, less those of the second (m/s).
    fn belt(&self, poses: &[Pose]) -> Columns {
        let mut belt = Columns::default();
        for lane in 0..self.count {
            let of = |index: u32| pose::of(poses, index).belt;
            set(&mut belt, lane, of(self.first[lane]) - of(self.second[lane]));
        }
        belt
    }

    /// Energy in the springs of a contact (J).
    pub fn elastic_energy(&self, lane: usize) -> f64 {
        let (depth, stretch) = (self.depth[lane], vector(&self.stretch, lane));
        let normal = self.stiffness[lane] * depth * depth;
        // without friction nothing stretches, and nobody writes so
        if self.friction[lane] > 0.0 {
            0.5 * (normal + self.friction_spring[lane] * stretch.length_squared())
        } else {
            0.5 * normal
        }
    }

    /// The lanes with a contact.
    #[inline(always)]
    pub fn in_contact(&self) -> impl Iterator<Item = usize> {
        (0..self.count).filter(|&lane| self.depth[lane] > 0.0)
    }

    /// The spring of a contact of a pair, without a stretch.
    #[inline(always)]
    pub fn spring(&self, lane: usize, pair: &Pair) -> PairSpring {
        let Pair { first, second, kind, .. } = *pair;
        let (particle, other) = (self.particle[lane], self.other[lane]);
        PairSpring { first, second, kind, particle, other, stretch: DVec3::ZERO }
    }

    /// What is left of the stretch of a spring after the latest push (m).
    pub fn kept(&self, lane: usize) -> DVec3 {
        vector(&self.stretch, lane) * self.held[lane]
    }
}

/// v + ω × a.
#[inline(always)]
fn velocity_at<S: Simd>(simd: S, [velocity, spin, arm]: [&Columns; 3]) -> Vec3x8<S> {
    Vec3x8::load(simd, velocity) + Vec3x8::load(simd, spin).cross(Vec3x8::load(simd, arm))
}
