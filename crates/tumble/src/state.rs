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
    /// What the run has lost or met so far.
    pub tally: Tally,
}

/// The state of one body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyState {
    /// Centre of mass x (m).
    pub position: DVec3,
    /// Velocity v of the centre of mass (m/s).
    pub velocity: DVec3,
    /// Orientation q, a unit quaternion that turns body axes into world axes.
    pub orientation: DQuat,
    /// Angular momentum L about the centre of mass, world axes (kg·m²/s).
    pub angular_momentum: DVec3,
}

/// Sums and extremes over the steps taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Energy lost to the drag of the medium (J).
    pub drag: f64,
    /// Energy lost to the dashpots of contacts (J).
    pub dashpot: f64,
    /// Energy lost to slip against friction (J).
    pub slip: f64,
    /// Deepest contact met so far (m).
    pub max_depth: f64,
}
