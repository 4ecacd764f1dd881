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
pub use check::check;
pub use contact::contact;
pub(crate) use contact::{Placed, Touching};
pub use drag::drag;
pub use euler::euler;
pub use fly::{cruise, fly};
pub use gravity::gravity;
pub use kick::kick;
pub use meet::meet;
pub(crate) use meet::{Meeting, TooFast, can_touch, overlaps, push_apart};
pub use pull::{Pull, pull};
pub use reach::reach;
pub use refine::refine;
