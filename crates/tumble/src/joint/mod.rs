//! Joints between bodies, or of bodies with the world.
//!
//! A step is flight, kick, flight, with joints as without. In a flight the constraints are kept as by RATTLE (H. C. Andersen, J. Comput.
//! Phys. 52 (1983) 24; B. Leimkuhler & S. Reich, *Simulating Hamiltonian Dynamics* (2004), ch. 7), around the exact flight of each body:
//! impulses at its beginning that let the constraints hold at its end, and impulses at its end that let their rates vanish
//! ([`flight`]). In a kick the impulses of contacts and loads act together with those of joints, their springs, motors and friction
//! ([`kick`]). All equations of a flight or a kick are solved together, directly ([`elimination`]).

mod definition;
mod elimination;
mod flight;
mod initial;
mod kick;
mod law;
mod model;
mod read;
mod rows;
mod system;
#[cfg(test)]
mod tests;
mod work;

pub use self::definition::{Joint, JointKind, Motor};
pub(crate) use self::flight::fly;
pub(crate) use self::initial::{JointVelocities, redundant_constraints};
pub(crate) use self::kick::{JointKick, spring_energy};
pub(crate) use self::model::Place;
pub use self::model::{JointModel, Joints};
pub(crate) use self::read::{constraint_error, coordinate_and_rate};
pub(crate) use self::work::JointWork;
