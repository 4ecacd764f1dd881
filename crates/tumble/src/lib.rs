//! Rigid bodies made of particles.

mod shape;
pub use glam::{DMat3, DQuat, DVec3};
pub use shape::{Mesh, MeshError};
