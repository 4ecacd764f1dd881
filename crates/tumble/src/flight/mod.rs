//! Exact solutions for a body in free flight: gravity, linear drag, and free rotation.

mod drag_modes;
mod free_rotation;
mod linear_drag;
mod small_rotation;
#[cfg(test)]
mod small_rotation_tests;
mod turn;

pub use drag_modes::DragModes;
pub use free_rotation::free_rotation;
pub use linear_drag::LinearDrag;
pub use turn::RotationDelta;
