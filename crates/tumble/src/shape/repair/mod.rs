//! Meshes from the wild: what is wrong with them, and what can be put right without guessing.
//!
//! Each step has a file, in the order in which they are meant: `weld`, `duplicates`, `orientation` (with `shells`, `groups` and
//! `containment`), `holes` and `close` (with `cracks` and `triangulate`).

mod close;
mod containment;
mod cracks;
mod duplicates;
mod edges;
mod faces;
mod groups;
mod holes;
mod orientation;
mod sets;
mod shells;
#[cfg(test)]
mod test_meshes;
mod triangulate;
mod weld;

pub use close::{Closed, HoleError, HoleFault};
pub use duplicates::Deduplicated;
pub(crate) use edges::{EdgeTable, net_direction};
pub use holes::Hole;
pub use orientation::Oriented;
pub use weld::Welded;
