//! The stages of a step, one file each. [`step`](crate::step) calls them in order.

mod carry;
mod check;
mod contact;
mod drag;
mod euler;
mod fly;
mod gravity;
mod kick;
mod meet;
mod pull;
mod reach;
mod refine;

pub use carry::carry;
pub(crate) use check::Problem;
pub use check::{check, refuse};
pub use contact::contact;
pub(crate) use contact::{Placed, Touching};
pub use drag::drag;
pub use euler::euler;
pub use fly::{cruise, fly};
pub use gravity::gravity;
pub use kick::kick;
pub(crate) use meet::{Feelings, Meeting, Pose, TooFast, can_touch, overlaps, push_apart};
pub use meet::{arrive, feel, keep, meet};
pub use pull::{Pull, pull};
pub use reach::reach;
pub use refine::refine;
