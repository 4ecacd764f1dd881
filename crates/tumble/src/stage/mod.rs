//! The stages of a step, one file each. [`step`](crate::step) calls them in order.

mod check;
mod contact;
mod drag;
mod euler;
mod gravity;

pub use check::check;
pub use contact::contact;
pub(crate) use contact::elastic_energy;
pub use drag::drag;
pub use euler::euler;
pub use gravity::gravity;
