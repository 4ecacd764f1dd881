//! Verification of [`tumble`]: simulations whose results theory predicts.
//!
//! Every expected value comes from a formula, from a conserved quantity or from an independent
//! computation, never from an earlier run. [`CASES`] lists all cases. `tumble verify` prints them,
//! and the tests of this package run the quick ones.

mod check;
mod coarse_mesh;
mod collision;
mod contact;
mod flight;
mod friction;
mod implicit;
mod invariance;
mod joints;
mod kinematic;
mod ledger;
mod order;
mod remeshing;
mod restitution;
mod runge_kutta;
mod setup;

pub use check::{Case, Check, Outcome};

/// All cases, in the order in which `tumble verify` runs them.
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
    restitution::BODIES,
    restitution::LOSSES,
    friction::SLIDING,
    friction::SLOPE,
    friction::ROLLING,
    collision::COLLISION,
    collision::LEDGER,
    collision::ORDER,
    collision::CRADLE,
    collision::UNEQUAL,
    collision::OBLIQUE,
    coarse_mesh::RESTING,
    coarse_mesh::CROSSING_EDGES,
    coarse_mesh::SLIDING,
    kinematic::SLOPE,
    kinematic::WALL_OR_MESH,
    kinematic::BELT,
    kinematic::PISTON,
    order::PLANE,
    order::SPHERES,
    order::TOUCH,
    implicit::RESTITUTION,
    implicit::CONVERGENCE,
    implicit::SLOPE,
    implicit::CRADLE,
    remeshing::REMESHING,
    joints::PENDULUM,
    joints::DOUBLE,
    joints::SPHERICAL,
    joints::KAPITZA,
    joints::FOUCAULT,
    joints::GYROSCOPE,
    joints::SLIDER_CRANK,
    joints::FOUR_BAR,
    joints::CHAIN,
    joints::DRIVEN,
    joints::FRICTION,
    joints::ORBIT,
    invariance::SCALE,
    invariance::WALLS,
    ledger::SCENES,
];
