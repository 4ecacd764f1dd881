//! The triangles of a mesh that count: corners that exist, are finite and differ once equal vertices are one.

use glam::DVec3;

use crate::shape::mesh::Mesh;
use crate::shape::watertight::weld;

/// The triangles that count, with equal vertices as one.
pub(super) struct Faces {
    /// The corners; of equal vertices, the one with the lowest index.
    pub corners: Vec<[u32; 3]>,
    /// The index of each in the mesh.
    pub index: Vec<u32>,
}

impl Faces {
    pub fn new(mesh: &Mesh) -> Self {
        let welded = weld(&mesh.vertices);
        let (mut corners, mut index) = (Vec::new(), Vec::new());
        for (i, &triangle) in (0u32..).zip(&mesh.triangles) {
            if mesh.corners(triangle).is_none() {
                continue;
            }
            let [a, b, c] = triangle.map(|i| welded[i as usize]);
            if a != b && b != c && c != a {
                corners.push([a, b, c]);
                index.push(i);
            }
        }
        Self { corners, index }
    }

    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// The positions of the corners of a face (m).
    pub fn places(&self, mesh: &Mesh, face: usize) -> [DVec3; 3] {
        self.corners[face].map(|i| mesh.vertices[i as usize])
    }
}
