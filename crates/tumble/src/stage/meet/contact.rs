//! One contact: its geometry, its springs and its forces.

use glam::DVec3;

use super::pose::Pose;
use crate::{ContactKind, ContactLaw, Wrench};

/// Where two bodies touch, or a sphere and a wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Unit normal n, from the second body to the first.
    pub normal: DVec3,
    /// Depth δ (m), above 0.
    pub depth: f64,
    /// From the centre of mass of the first body to the point of contact (m).
    pub arm: DVec3,
    /// From the centre of mass of the second body to the same point (m).
    pub other_arm: DVec3,
}

/// A place where two bodies touch, and its tangential spring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub touch: Touch,
    /// Stretch of the spring at the latest kick, turned with the contact (m).
    pub before: DVec3,
    /// Its stretch now, before the limit (m).
    pub stretch: DVec3,
    /// What part of that is left after the latest push.
    pub held: f64,
    /// Weight of the particle: a factor on all forces of the law.
    pub weight: f64,
    /// Which particle touches, and which it touches, by slot.
    pub particle: u32,
    pub other: u32,
}

/// How the point of contact is fixed to the bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mount {
    pub kind: ContactKind,
    /// From the centre of the sphere of the first body to the point, against n (m).
    pub offset: f64,
    /// From the centre of the sphere of the second body to the point, along n (m).
    pub other_offset: f64,
}

/// What the contacts of two bodies do together: to the first body as they are, to the second the other way round.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PairForces {
    /// Springs and dashpots, normal and tangential.
    pub all: Couple,
    /// The dashpots alone.
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

/// A force at a point, and its torques about two centres of mass.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Couple {
    pub force: DVec3,
    pub torque: DVec3,
    pub other_torque: DVec3,
}

impl Couple {
    #[inline(always)]
    fn add(&mut self, touch: &Touch, force: DVec3) {
        self.force += force;
        self.torque += touch.arm.cross(force);
        self.other_torque += touch.other_arm.cross(force);
    }

    /// On the first body.
    pub fn on_first(&self) -> Wrench {
        Wrench { force: self.force, torque: self.torque }
    }

    /// On the second body: the opposite force at the same point.
    pub fn on_second(&self) -> Wrench {
        Wrench { force: -self.force, torque: -self.other_torque }
    }
}

impl Touch {
    /// Velocity of the first body against the second at the point of contact (m/s).
    #[inline(always)]
    fn relative_velocity(&self, first: &Pose, second: &Pose) -> DVec3 {
        let apart = first.velocity_at(self.arm) - second.velocity_at(self.other_arm);
        if first.belt == second.belt { apart } else { apart + self.belt(first, second) }
    }

    /// What moving surfaces add to that (m/s).
    fn belt(&self, first: &Pose, second: &Pose) -> DVec3 {
        let belt = first.belt - second.belt;
        belt - self.normal * belt.dot(self.normal)
    }
}

impl Contact {
    /// Carries the tangential spring on over the time `h` (s) since the latest kick: it turns with the normal and with the
    /// surface that holds it, keeps its length, and stretches by the way of the one body against the other,
    /// with velocity and arms as they were in the middle of that time.
    #[inline(always)]
    pub fn carry(&mut self, mount: &Mount, first: &Pose, second: &Pose, h: f64) {
        let kind = mount.kind;
        let Touch { normal: n, arm, other_arm, .. } = self.touch;
        let (w, other_w) = (first.drift_spin, second.drift_spin);
        if self.before != DVec3::ZERO {
            let spin = match kind {
                ContactKind::Wall => 0.0,
                ContactKind::FirstInSecond => other_w.dot(n),
                ContactKind::SecondInFirst => w.dot(n),
                ContactKind::Spheres => 0.5 * (w + other_w).dot(n),
            };
            let turned = self.before + n.cross(self.before) * (spin * h);
            let along = turned - n * turned.dot(n);
            let (old, new) = (self.before.length_squared(), along.length_squared());
            // a normal that turned by a right angle leaves nothing to keep
            let scale = if new > 0.0 { (old / new).sqrt() } else { 0.0 };
            self.before = along * scale;
        }
        // spheres turn with their bodies; of a mesh, the place where the other is counts
        let back = |w: DVec3, arm: DVec3| w.cross(arm) * (-0.5 * h);
        let mut mid_arm = arm + back(w, arm + n * mount.offset);
        let mut other_mid_arm = other_arm + back(other_w, other_arm - n * mount.other_offset);
        let apart = first.drift_velocity - second.drift_velocity;
        match kind {
            ContactKind::Wall | ContactKind::FirstInSecond => {
                other_mid_arm = other_arm - (apart + w.cross(mid_arm)) * (0.5 * h);
            }
            ContactKind::SecondInFirst => {
                mid_arm = arm + (apart - other_w.cross(other_mid_arm)) * (0.5 * h);
            }
            ContactKind::Spheres => {}
        }
        let turning = w.cross(mid_arm) - other_w.cross(other_mid_arm);
        let u = apart + turning + self.touch.belt(first, second);
        self.stretch = self.before + (u - n * u.dot(n)) * h;
    }

    /// Adds the forces of this contact with the velocities of the bodies; see [`crate::stage::contact()`] for the
    /// law. A first look, which only foretells velocities, leaves out what is kept and accounted for.
    #[inline(always)]
    pub fn push<const FIRST: bool>(
        &mut self,
        law: &ContactLaw,
        first: &Pose,
        second: &Pose,
        sum: &mut PairForces,
    ) {
        let n = self.touch.normal;
        let u = self.touch.relative_velocity(first, second);
        let u_n = u.dot(n);
        let spring = self.weight * law.stiffness * self.touch.depth;
        let push = (spring - self.weight * law.damping * u_n).max(0.0);
        let mut force = n * push;
        let mut brake = n * (push - spring);
        if law.friction > 0.0 {
            let limit = law.friction * push;
            let (hold, tangential) = self.hold::<FIRST>(law, u - n * u_n, limit, sum);
            force += hold + tangential;
            brake += tangential;
            let belt = second.belt - first.belt;
            if !FIRST && belt != DVec3::ZERO {
                sum.belt_power += (hold + tangential).dot(belt);
                sum.belt_loss += tangential.dot(belt);
            }
        }
        sum.all.add(&self.touch, force);
        if !FIRST {
            sum.dashpot.add(&self.touch, brake);
            sum.max_depth = sum.max_depth.max(self.touch.depth);
        }
    }

    /// The tangential spring, as much of it as the limit (N) lets hold, and the dashpot within what that leaves, at a
    /// velocity along the contact (m/s).
    #[inline(always)]
    fn hold<const FIRST: bool>(
        &mut self,
        law: &ContactLaw,
        velocity: DVec3,
        limit: f64,
        sum: &mut PairForces,
    ) -> (DVec3, DVec3) {
        let k = self.weight * law.friction_spring;
        let mut part = 1.0;
        let mut held = self.stretch;
        let square = k * k * held.length_squared();
        if square > limit * limit {
            part = limit / square.sqrt();
            held *= part;
            if !FIRST {
                // the work of friction on the way from stretch to stretch, less what the spring takes up
                sum.slip += 0.5 * k * (self.before + held).dot(self.stretch - held);
            }
        }
        if !FIRST {
            self.held = part;
        }
        let hold = held * -k;
        let damping = self.weight * law.friction_damping;
        (hold, within(hold, velocity * -damping, limit))
    }
}

/// The largest part, up to all, of `brake` that can be added to `hold` without the sum being longer than `limit`.
#[inline(always)]
fn within(hold: DVec3, brake: DVec3, limit: f64) -> DVec3 {
    let all = hold + brake;
    if all.length_squared() <= limit * limit {
        return brake;
    }
    // the larger root of |hold + β brake|² = limit²
    let a = brake.length_squared();
    let b = hold.dot(brake);
    let room = (limit * limit - hold.length_squared()).max(0.0);
    let beta = ((b * b + a * room).sqrt() - b) / a;
    if beta > 0.0 { brake * beta.min(1.0) } else { DVec3::ZERO }
}
