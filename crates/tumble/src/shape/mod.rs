//! What a body is made of: its mesh, its particles, its mass properties.

mod body_shape;
mod mass;
mod mesh;
mod particles;

pub use body_shape::{ParticleMoments, Shape, ShapeError};
pub use mass::{MassProperties, PrincipalAxes};
pub use mesh::{Mesh, MeshError};
pub use particles::Particles;
