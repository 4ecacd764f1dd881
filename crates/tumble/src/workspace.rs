//! Buffers for one batch of bodies.

use crate::contact::wall::WallContacts;
use crate::{FrictionSpring, RunTotals};

/// Buffers for one batch of bodies, and what the batch reports at the end of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    /// Contacts of one body with walls.
    pub contacts: WallContacts,
    /// Contacts with walls of each body of the batch, where bodies touch each other too.
    pub wall_contacts: Vec<WallContacts>,
    /// Friction springs of one body at the beginning of a sub-step, and at its end.
    pub saved_springs: [Vec<FrictionSpring>; 2],
    /// What the batch adds to the totals of the run.
    pub totals: RunTotals,
    /// The first body of the batch that failed a check, by index.
    pub failure: Option<(usize, Failure)>,
}

/// A failed check of one body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Failure {
    pub quantity: &'static str,
    pub value: f64,
    pub particle: Option<usize>,
    /// The largest value that is accepted, where there is one.
    pub limit: Option<f64>,
}
