//! Exact solutions of a body that touches nothing.

mod drag_modes;
mod free_rotation;
mod glide;
mod small_turn;

pub use drag_modes::DragModes;
pub use free_rotation::{Turn, free_rotation};
pub use glide::Glide;
