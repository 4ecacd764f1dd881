//! `summary.json`: the run in a few numbers.

use serde::Serialize;

/// The run in a few numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Version of the program.
    pub version: String,
    /// Name of the scene.
    pub scene: String,
    /// How a step advanced time.
    pub integrator: String,
    /// Time step (s).
    pub dt: f64,
    /// Simulated time that was asked for (s).
    pub duration: f64,
    /// Simulated time that was reached (s).
    pub time: f64,
    /// Whether the run was stopped before its end.
    pub interrupted: bool,
    /// Steps taken.
    pub steps: u64,
    /// How many bodies.
    pub bodies: usize,
    /// How many particles, over all bodies.
    pub particles: u64,
    /// Time spent in stepping alone (s), since the run was last resumed.
    pub wall_seconds: f64,
    /// Steps of that time, a second.
    pub steps_per_second: f64,
    /// Total energy at the start (J).
    pub energy_start: f64,
    /// Total energy at the end, losses included (J).
    pub energy_end: f64,
    /// Their difference: the integrator's error (J).
    pub energy_residual: f64,
    /// The longest step with which contact is stable (s); absent where nothing can touch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub critical_dt: Option<f64>,
    /// How often contact forces kicked a body.
    pub force_evaluations: u64,
    /// Deepest contact of the whole run (m): of all evaluations of forces, and at the end.
    pub max_depth: f64,
    /// Deepest contact between two bodies at the end (m).
    pub body_depth_end: f64,
    /// Deepest contact with a wall at the end (m).
    pub wall_depth_end: f64,
    /// Hash of the last state.
    pub state_hash: String,
}
