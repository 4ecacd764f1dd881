//! The state: everything that evolves during a run.

use glam::{DQuat, DVec3};

/// The state of a run. Together with the [`Model`](crate::Model) it determines the future; a checkpoint holds it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// The number of steps taken.
    pub step: u64,
    /// Time t (s).
    pub time: f64,
    /// One entry per body.
    pub bodies: Vec<BodyState>,
    /// The friction springs of each body, sorted by wall and then by the slot of the particle in the shape.
    pub springs: Vec<Vec<FrictionSpring>>,
    /// The friction springs between bodies, and between spheres and walls, in the order described at
    /// [`PairSpring`].
    pub pair_springs: Vec<PairSpring>,
    /// The impulses of the latest kick at the contacts of `pair_springs`, which the next kick begins its iterations with; with the
    /// integrator [`Implicit`](crate::Integrator::Implicit), else empty.
    pub pair_impulses: Vec<ContactImpulse>,
    /// The time since the latest kick (s), with the integrator `Implicit`, whose steps may be divided; else 0.
    pub since_kick: f64,
    /// Such steps are divided into 2 to the power of this.
    pub step_divisions: u32,
    /// One entry per joint.
    pub joints: Vec<JointState>,
    /// Accumulated losses and extremes.
    pub totals: RunTotals,
}

impl State {
    /// Becomes a copy of another state, and reuses its own memory.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { step, time, since_kick, step_divisions, totals, .. } = *other;
        (self.step, self.time, self.totals) = (step, time, totals);
        (self.since_kick, self.step_divisions) = (since_kick, step_divisions);
        self.bodies.clone_from(&other.bodies);
        self.springs.clone_from(&other.springs);
        self.pair_springs.clone_from(&other.pair_springs);
        self.pair_impulses.clone_from(&other.pair_impulses);
        self.joints.clone_from(&other.joints);
    }
}

/// The state of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass x (m).
    pub position: DVec3,
    /// Compensation for the rounding error of x (m): far from the origin the displacement of a step has fewer digits than x
    /// can hold, and a slow body would not move at all.
    pub position_compensation: DVec3,
    /// Velocity v of the centre of mass (m/s).
    pub velocity: DVec3,
    /// Orientation q, a unit quaternion that rotates body axes to world axes.
    pub orientation: DQuat,
    /// Compensation for the rounding error of q, so that a million small rotations are as accurate as one
    /// (compensated summation, W. Kahan, Comm. ACM 8 (1965) 40).
    pub orientation_compensation: DQuat,
    /// Angular momentum L about the centre of mass, world axes (kg·m²/s).
    pub angular_momentum: DVec3,
    /// Energy (J) gained by the error of refined steps in contact and not yet removed; 0 without
    /// `energy_tolerance`.
    pub energy_excess: f64,
}

impl Default for BodyState {
    /// At rest at the origin.
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            position_compensation: DVec3::ZERO,
            velocity: DVec3::ZERO,
            orientation: DQuat::IDENTITY,
            orientation_compensation: NO_COMPENSATION,
            angular_momentum: DVec3::ZERO,
            energy_excess: 0.0,
        }
    }
}

impl BodyState {
    /// x ← x + `displacement` (m), as a compensated sum: the rounding error goes into `position_compensation`
    /// (2Sum: D. E. Knuth, *The Art of Computer Programming* 2, 4.2.2).
    #[inline]
    pub(crate) fn move_by(&mut self, displacement: DVec3) {
        let (x, d) = (self.position, displacement + self.position_compensation);
        let sum = x + d;
        let d_of_sum = sum - x;
        self.position_compensation = (x - (sum - d_of_sum)) + (d - d_of_sum);
        self.position = sum;
    }
}

/// No compensation.
pub(crate) const NO_COMPENSATION: DQuat = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);

/// The tangential spring of one particle in contact with one wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionSpring {
    /// The index of the wall in [`Model::walls`](crate::Model::walls).
    pub wall: u32,
    /// The index of the particle.
    pub particle: u32,
    /// The anchor of the spring on the wall (m): the point of first contact, moved by slip. Only its components
    /// along the wall count.
    pub anchor: DVec3,
    /// The elongation at the latest kick (m), along the wall, from the anchor to the particle.
    pub stretch: DVec3,
}

/// The tangential spring of one contact between two bodies, or between a sphere of a body and a wall.
///
/// Springs are sorted by the first body, walls before other bodies, the second body or wall, the kind, and the slots of
/// both particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSpring {
    /// The index of the first body; of two bodies the lower one.
    pub first: u32,
    /// The index of the other body, or of the wall.
    pub second: u32,
    /// The kind of contact.
    pub kind: ContactKind,
    /// The index of the particle, of `second` for [`ContactKind::MeshPoint`], else of `first`.
    pub particle: u32,
    /// The index of the particle of `second` for [`ContactKind::SphereSphere`], else 0.
    pub other: u32,
    /// The elongation at the latest kick (m), tangential, world axes: the displacement of the first body relative to
    /// the second.
    pub stretch: DVec3,
}

/// The impulse of one contact in a kick, on the first body of the pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactImpulse {
    /// Along the normal (N·s).
    pub normal: f64,
    /// Along the surfaces, world axes (N·s).
    pub tangential: DVec3,
}

/// The state of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointState {
    /// Its coordinate: the angle of a hinge, counted beyond a turn (rad), the displacement of a slider, or the distance of the points of
    /// a rod, rope or spring less that at the start (m); else 0.
    pub coordinate: f64,
    /// The mean forces and torques of its constraints, and of a limit, in the latest flight (N, N·m): what the next one begins its
    /// iterations with.
    pub force: [f64; 6],
}

/// The sort key of a pair: the first body, walls before other bodies, the second body or wall, the kind.
pub(crate) type PairOrder = (u32, bool, u32, ContactKind);

/// The sort key of a pair.
pub(crate) fn pair_order(first: u32, second: u32, kind: ContactKind) -> PairOrder {
    (first, kind != ContactKind::SphereWall, second, kind)
}

/// The kind of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum ContactKind {
    /// A sphere of the first body against a wall.
    SphereWall,
    /// A sphere or particle of the first body against one of the second.
    SphereSphere,
    /// A sphere or particle of the first body against the mesh of the second.
    PointMesh,
    /// The mesh of the first body against a sphere or particle of the second.
    MeshPoint,
}

/// Sums and extremes over the steps taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunTotals {
    /// Energy lost to the drag of the medium (J).
    pub drag: f64,
    /// Energy lost to the dashpots of contacts (J).
    pub dashpot: f64,
    /// Energy lost to frictional slip (J).
    pub slip: f64,
    /// Work done by bodies with prescribed motion on other bodies, and by loads (J).
    pub work: f64,
    /// Work done by the motors of joints (J).
    pub motor: f64,
    /// Energy lost to friction, dampers and limits of joints (J).
    pub joint_friction: f64,
    /// The largest penetration depth so far (m).
    pub max_depth: f64,
    /// The number of kicks by contact forces, a measure of the cost of contact.
    pub evaluations: u64,
    /// Energy lost by the implicit solution of the contact law, beyond what dashpots and slip take (J).
    pub numerical: f64,
    /// Iterations of the implicit solver.
    pub iterations: u64,
    /// Steps in which they ended before the impulses had converged.
    pub not_converged: u64,
}

impl RunTotals {
    /// The sum of all losses (J).
    pub fn lost(&self) -> f64 {
        self.drag + self.dashpot + self.slip + self.numerical + self.joint_friction
    }
}

impl std::ops::AddAssign for RunTotals {
    fn add_assign(&mut self, more: Self) {
        self.drag += more.drag;
        self.dashpot += more.dashpot;
        self.slip += more.slip;
        self.work += more.work;
        self.motor += more.motor;
        self.joint_friction += more.joint_friction;
        self.max_depth = self.max_depth.max(more.max_depth);
        self.evaluations += more.evaluations;
        self.numerical += more.numerical;
        self.iterations += more.iterations;
        self.not_converged += more.not_converged;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_body_far_from_the_origin_moves() {
        // a tenth of what doubles resolve there
        let (start, displacement) = (DVec3::new(1e6, -1e6, 3.0), DVec3::new(1e-11, -1e-11, 1e-11));
        assert_eq!(start.x + displacement.x, start.x);
        let mut state = BodyState { position: start, ..BodyState::default() };
        for _ in 0..100_000 {
            state.move_by(displacement);
        }
        let moved = state.position - start + state.position_compensation;
        assert!((moved - DVec3::new(1e-6, -1e-6, 1e-6)).length() < 1e-15, "{moved}");
    }
}
