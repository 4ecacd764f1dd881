//! The stages of a step, one file per stage. [`step`](crate::step) calls them in order.
//!
//! A stage takes a [`Batch`](crate::Batch) of bodies. [`around_body_contact`] is the one place where bodies of different
//! batches see each other.

mod body_contact;
mod check;
mod drag;
mod drift;
mod euler;
mod free_flight;
mod gravity;
mod implicit_steps;
mod joints;
mod kick;
mod kinematic;
mod load;
mod mouse_spring;
mod substep;
mod wall_contact;

pub use body_contact::around_body_contact;
pub(crate) use body_contact::around_implicit_contact;
pub use check::{check, report_failure};
pub use drag::drag;
pub(crate) use drift::drift_body;
pub use drift::{drift, drift_free_flight};
pub use euler::euler;
pub use free_flight::find_free_flight;
pub use gravity::gravity;
pub(crate) use implicit_steps::{DIVISIONS_AT_START, MOST_DIVISIONS};
pub use implicit_steps::{ImplicitStep, ImplicitSteps};
pub(crate) use joints::{account, begin_flight, begin_joints, fly_joined, kick_joined};
pub use kick::kick;
pub use kinematic::move_kinematic;
pub use load::load;
pub use mouse_spring::{MouseSpring, apply_mouse_spring};
pub use substep::substep;
pub use wall_contact::wall_contact;
