//! What a body is made of: its mesh, its particles, its mass properties.

mod closedness;
mod integrals;
mod mesh;
mod primitive;
mod sampling;

pub use closedness::{Closedness, EdgeFault, FaultyEdge};
pub use integrals::{Integrals, OpenMesh, ShellError};
pub use mesh::{Mesh, MeshError};
pub use primitive::{Primitive, PrimitiveError};
pub use sampling::{SampleError, Sampling};
