//! What a body is made of: its mesh, its particles, its mass properties.

mod areas;
mod balls;
mod body_shape;
mod closedness;
mod descend;
mod integrals;
mod mass;
mod mesh;
mod particles;
mod primitive;
mod sampling;
mod tree;

pub use areas::AreaError;
pub use balls::{BallsError, ball_integrals};
pub use body_shape::{MassModel, ParticleMoments, Shape, ShapeError};
pub(crate) use closedness::weld;
pub use closedness::{Closedness, EdgeFault, FaultyEdge};
pub(crate) use descend::RampSums;
pub use integrals::{Integrals, OpenMesh, ShellError};
pub(crate) use mass::diagonalise;
pub use mass::{MassProperties, PrincipalAxes};
pub use mesh::{Mesh, MeshError};
pub use particles::Particles;
pub use primitive::{Primitive, PrimitiveError};
pub use sampling::{SampleError, Sampling};
pub(crate) use tree::Ramp;
