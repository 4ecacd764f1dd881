//! The shape of a body: its mesh, its particles, its mass properties.

mod area_weights;
mod body_shape;
mod given_mass;
mod integrals;
mod mass;
mod mesh;
mod moments;
mod particles;
mod primitive;
mod repair;
mod sampling;
mod sphere_union;
mod tree;
mod tree_sums;
mod vertex_areas;
mod watertight;

pub use body_shape::{MassModel, Shape, ShapeError};
pub use integrals::{Integrals, ShellError, SolidError};
pub(crate) use mass::diagonalise;
pub use mass::{MassProperties, PrincipalAxes};
pub use mesh::{Mesh, MeshError};
pub(crate) use moments::MassScaledForm;
pub use moments::ParticleMoments;
pub use particles::Particles;
pub use primitive::{Primitive, PrimitiveError};
pub use repair::{Closed, Deduplicated, Hole, HoleError, HoleFault, Oriented, Welded};
pub use sampling::{SampleError, Sampling};
pub use sphere_union::{SphereUnionError, sphere_union_integrals};
pub(crate) use tree::AffineFunction;
pub(crate) use tree_sums::AffineSums;
pub use vertex_areas::AreaError;
pub(crate) use watertight::weld;
pub use watertight::{EdgeFault, FaultyEdge, Watertightness};
