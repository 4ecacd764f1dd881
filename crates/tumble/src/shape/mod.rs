//! What a body is made of: its mesh, its particles, its mass properties.

mod mesh;

pub use mesh::{Mesh, MeshError};
