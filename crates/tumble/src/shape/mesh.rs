//! Indexed triangle meshes.

use glam::DVec3;

/// A triangle mesh in metres. A point cloud is a mesh without triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices (m).
    pub vertices: Vec<DVec3>,
    /// Triangles as indices into `vertices`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Why vertices and triangles do not form a valid mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshError {
    /// There are no vertices.
    Empty,
    /// A coordinate of a vertex is NaN or infinite.
    NotFinite {
        /// Index of the vertex, from 0.
        vertex: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    IndexOutOfRange {
        /// Index of the triangle, from 0.
        triangle: usize,
        /// The index that does not exist.
        index: u32,
        /// The number of vertices.
        vertex_count: usize,
    },
}

impl std::fmt::Display for MeshError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Empty => write!(f, "the mesh has no vertices"),
            Self::NotFinite { vertex } => {
                write!(f, "vertex {vertex} (counted from 0) is not finite")
            }
            Self::IndexOutOfRange { triangle, index, vertex_count } => write!(
                f,
                "triangle {triangle} (counted from 0) refers to vertex {index}, but there are only {vertex_count} (0 to {})",
                vertex_count.saturating_sub(1)
            ),
        }
    }
}

impl std::error::Error for MeshError {}

impl Mesh {
    /// A mesh of these vertices (m) and triangles, after checking them.
    ///
    /// # Errors
    /// [`MeshError`] if there are no vertices, a coordinate is not finite, or an index is out of range.
    pub fn new(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if vertices.is_empty() {
            return Err(MeshError::Empty);
        }
        if let Some(vertex) = vertices.iter().position(|v| !v.is_finite()) {
            return Err(MeshError::NotFinite { vertex });
        }
        let vertex_count = vertices.len();
        for (triangle, indices) in triangles.iter().enumerate() {
            if let Some(&index) = indices.iter().find(|&&i| i as usize >= vertex_count) {
                return Err(MeshError::IndexOutOfRange { triangle, index, vertex_count });
            }
        }
        Ok(Self { vertices, triangles })
    }
}
