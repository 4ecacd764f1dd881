//! Rigid bodies made of particles.

mod shape;
pub use glam::{DMat3, DQuat, DVec3};
pub use shape::{
    Closedness, EdgeFault, FaultyEdge, Integrals, Mesh, MeshError, OpenMesh, Primitive,
    PrimitiveError, SampleError, Sampling, ShellError,
};
