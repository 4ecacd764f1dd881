//! Forces and losses of pairs of bodies, summed over their contacts.

use fearless_simd::Simd;
use glam::DVec3;

use crate::Wrench;
use crate::lanes::{Columns, Vec3x8, vector};

/// A force on the first body of a pair and the opposite force on the second, with their torques.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PairWrench {
    /// Force on the first body (N).
    force: DVec3,
    /// Torque on the first body about its centre of mass (N·m).
    torque: DVec3,
    /// Torque on the second body about its centre of mass, with opposite sign (N·m).
    other_torque: DVec3,
}

impl PairWrench {
    /// A couple on the first body and the opposite one on the second (N·m).
    pub fn from_couple(couple: DVec3) -> Self {
        Self { force: DVec3::ZERO, torque: couple, other_torque: couple }
    }

    /// Wrench on the first body.
    pub fn on_first(&self) -> Wrench {
        Wrench { force: self.force, torque: self.torque }
    }

    /// Wrench on the second body: the opposite forces at the same points.
    pub fn on_second(&self) -> Wrench {
        Wrench { force: -self.force, torque: -self.other_torque }
    }
}

/// A pair that was examined, and the forces of its contacts.
#[derive(Clone, Debug)]
pub(super) struct PairForces {
    /// Index of the pair in the neighbour list.
    pub list_index: u32,
    /// The first body.
    pub first: u32,
    /// Index of its patch in [`ChunkContacts::patches`](super::chunk_contacts::ChunkContacts::patches), or
    /// [`NO_PATCH`](super::patch_damping::NO_PATCH).
    pub patch: u32,
    /// Springs and dashpots, normal and tangential.
    pub wrench: PairWrench,
    /// Torque of the springs on the first body in addition to that of their forces, included in `wrench` (N·m).
    pub couple: DVec3,
}

impl PairForces {
    /// Adds a couple on the first body (N·m).
    pub fn add_couple(&mut self, couple: DVec3) {
        self.couple += couple;
        self.wrench.torque += couple;
        self.wrench.other_torque += couple;
    }

    /// Forgets all forces but the couple.
    pub fn clear(&mut self) {
        self.wrench = PairWrench::from_couple(self.couple);
    }
}

/// Losses of the contacts of a pair.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PairLosses {
    /// The dashpots' part of the wrench.
    pub dashpot: PairWrench,
    /// Energy lost to slip (J).
    pub slip: f64,
    /// Depth of the deepest contact (m).
    pub max_depth: f64,
    /// Power that the surface velocity of a kinematic body puts in (W).
    pub surface_power: f64,
    /// The part of it that dashpots dissipate (W).
    pub surface_dashpot_power: f64,
}

/// Forces at eight points, with their torques about two centres of mass.
pub(super) struct LaneWrenches {
    force: Columns,
    torque: Columns,
    other_torque: Columns,
}

impl LaneWrenches {
    #[inline(always)]
    pub fn new<S: Simd>(force: Vec3x8<S>, arm: Vec3x8<S>, other_arm: Vec3x8<S>) -> Self {
        Self {
            force: force.store(),
            torque: arm.cross(force).store(),
            other_torque: other_arm.cross(force).store(),
        }
    }

    #[inline(always)]
    pub fn add_to(&self, lane: usize, sum: &mut PairWrench) {
        sum.force += vector(&self.force, lane);
        sum.torque += vector(&self.torque, lane);
        sum.other_torque += vector(&self.other_torque, lane);
    }
}
