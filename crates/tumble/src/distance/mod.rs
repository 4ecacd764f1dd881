//! The signed distance from a point to a closed triangle mesh, exact up to rounding.
//!
//! A bounding volume tree finds the closest triangle. The angle-weighted pseudonormal of its closest feature (face,
//! edge or vertex) gives the sign. The result is a function of mesh and point alone, bit for bit: it does not depend
//! on the order of the search, a hint, or the SIMD width.

mod bound_grid;
mod error;
mod facing;
mod normal_cones;
mod normals;
mod oriented_surface;
mod patch;
mod planes;
mod ray_queries;
mod search;
mod signed_distance;
mod tree;
mod triangle;

pub use error::SurfaceError;
pub(crate) use facing::{Exit, Share, THROUGH};
pub(crate) use normal_cones::NormalCone;
pub(crate) use oriented_surface::{Face, OrientedSurface};
pub(crate) use patch::Patch;
pub(crate) use planes::Plane;
pub use signed_distance::{Nearest, SignedDistance};

#[cfg(test)]
mod tests;
