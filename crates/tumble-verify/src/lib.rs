//! The physics of [`tumble`] against theory, case by case.
//!
//! Every expected value comes from a formula, from a conserved quantity or from an independent
//! computation; none from an earlier run. [`CASES`] is what `tumble verify` prints and what the
//! tests of this package run.

mod check;
mod contact;
mod flight;
mod friction;
mod ledger;
mod remeshing;
mod symmetry;

pub use check::{Case, Check, Outcome};

/// All cases, flight first.
pub const CASES: &[Case] = &[
    flight::FREE_FALL,
    flight::DRAG,
    flight::TUMBLING,
    flight::PRECESSION,
    flight::RACKET,
    flight::MOMENTUM,
    contact::ORDER,
    contact::BOUNCE,
    contact::RESTITUTION,
    contact::CAT,
    friction::SLIDING,
    friction::SLOPE,
    friction::ROLLING,
    remeshing::REMESHING,
    symmetry::SCALE,
    symmetry::WALLS,
    ledger::SCENES,
];
