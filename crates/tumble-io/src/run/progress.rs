//! Progress and result of a run, as its caller sees them.

use super::summary::Summary;
use crate::plot::EnergyRow;

/// Progress of a run.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Steps completed.
    pub step: u64,
    /// Steps of the whole run.
    pub steps: u64,
    /// Simulated time (s).
    pub time: f64,
}

/// Result of a run that reached its end or was stopped.
#[derive(Debug)]
pub struct FinishedRun {
    /// The contents of `summary.json`.
    pub summary: Summary,
    /// The energy ledger at the end.
    pub energy: EnergyRow,
    /// Steps taken since the run was last resumed.
    pub steps_here: u64,
    /// Properties of the scene that the user may not expect.
    pub notes: Vec<String>,
    /// Reasons not to trust the results that were found while it ran.
    pub warnings: Vec<String>,
}
