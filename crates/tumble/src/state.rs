//! All that evolves, and nothing else: a checkpoint is a `State`.

use glam::{DQuat, DVec3};

/// The state of a run. With the [`Model`](crate::Model) it determines everything that follows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// How many steps have been taken.
    pub step: u64,
    /// Time t (s).
    pub time: f64,
    /// One entry a body.
    pub bodies: Vec<BodyState>,
    /// The friction springs of each body, sorted by wall, those of a wall in the order in which the shape
    /// keeps its particles.
    pub springs: Vec<Vec<FrictionSpring>>,
    /// The friction springs between bodies, and between spheres and walls, in their order
    /// ([`PairSpring`]).
    pub pair_springs: Vec<PairSpring>,
    /// What the run has lost or met so far.
    pub totals: RunTotals,
}

/// The state of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass x (m).
    pub position: DVec3,
    /// Velocity v of the centre of mass (m/s).
    pub velocity: DVec3,
    /// Orientation q, a unit quaternion that turns body axes into world axes.
    pub orientation: DQuat,
    /// What rounding has taken from q so far, to be given back: it keeps a million small turns as
    /// exact as one (compensated summation, W. Kahan, Comm. ACM 8 (1965) 40).
    pub orientation_rest: DQuat,
    /// Angular momentum L about the centre of mass, world axes (kg·m²/s).
    pub angular_momentum: DVec3,
    /// Energy (J) that refined steps in contact have gained by error and not yet been able to give
    /// back; 0 without `energy_tolerance`.
    pub energy_owed: f64,
}

impl Default for BodyState {
    /// At rest at the origin.
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            velocity: DVec3::ZERO,
            orientation: DQuat::IDENTITY,
            orientation_rest: NO_REST,
            angular_momentum: DVec3::ZERO,
            energy_owed: 0.0,
        }
    }
}

/// Nothing to be given back.
pub(crate) const NO_REST: DQuat = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);

/// The tangential spring of one particle in contact with one wall.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionSpring {
    /// Which wall, as an index into [`Model::walls`](crate::Model::walls).
    pub wall: u32,
    /// Which particle of the body.
    pub particle: u32,
    /// Where on the wall the spring is held (m): where the particle arrived, or has slipped to.
    /// Only its part along the wall counts.
    pub anchor: DVec3,
    /// Its stretch at the latest kick (m), along the wall, from the anchor to the particle.
    pub stretch: DVec3,
}

/// The tangential spring of one contact between two bodies, or between a sphere of a body and a wall.
///
/// They are sorted by the first body, its walls before the other bodies, the second body, the kind, the particle and the
/// other particle, particles in the order in which the shape keeps them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSpring {
    /// Which body; of two the one with the lower index.
    pub first: u32,
    /// Which other body, or which wall.
    pub second: u32,
    /// What touches what.
    pub kind: ContactKind,
    /// Which particle touches: of `second` where the kind is [`ContactKind::MeshPoint`], else of `first`.
    pub particle: u32,
    /// Which particle of `second` it touches, where the kind is [`ContactKind::SphereSphere`]; else 0.
    pub other: u32,
    /// Its stretch at the latest kick (m), along the contact, world axes: how far the first body has come with respect to
    /// the second.
    pub stretch: DVec3,
}

/// By what pairs are sorted: the first body, its walls before the other bodies, the second body, the kind.
pub(crate) type PairOrder = (u32, bool, u32, ContactKind);

/// The place of a pair among all pairs.
pub(crate) fn pair_order(first: u32, second: u32, kind: ContactKind) -> PairOrder {
    (first, kind != ContactKind::SphereWall, second, kind)
}

/// What touches what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum ContactKind {
    /// A sphere of the first body and a wall.
    SphereWall,
    /// A sphere or particle of the first body and one of the second.
    SphereSphere,
    /// A sphere or particle of the first body and the mesh of the second.
    PointMesh,
    /// The mesh of the first body and a sphere or particle of the second.
    MeshPoint,
}

/// Sums and extremes over the steps taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunTotals {
    /// Energy lost to the drag of the medium (J).
    pub drag: f64,
    /// Energy lost to the dashpots of contacts (J).
    pub dashpot: f64,
    /// Energy lost to slip against friction (J).
    pub slip: f64,
    /// Work that bodies whose motion is prescribed have done on the others (J).
    pub work: f64,
    /// Deepest contact met so far (m).
    pub max_depth: f64,
    /// How often contact forces kicked a body: what contact has cost.
    pub evaluations: u64,
}

impl RunTotals {
    /// Everything that was lost (J).
    pub fn lost(&self) -> f64 {
        self.drag + self.dashpot + self.slip
    }
}

impl std::ops::AddAssign for RunTotals {
    fn add_assign(&mut self, more: Self) {
        self.drag += more.drag;
        self.dashpot += more.dashpot;
        self.slip += more.slip;
        self.work += more.work;
        self.max_depth = self.max_depth.max(more.max_depth);
        self.evaluations += more.evaluations;
    }
}
