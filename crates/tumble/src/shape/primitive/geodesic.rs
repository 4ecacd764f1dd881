//! Shapes from regular solids: the geodesic sphere and the tetrahedron.

use crate::shape::mesh::Mesh;
use glam::DVec3;
use std::collections::HashMap;

/// The icosahedron, counter-clockwise seen from outside; its vertices are (0, ±1, ±φ) and their rotations.
const ICOSAHEDRON: [[u32; 3]; 20] = [
    [0, 11, 5],
    [0, 5, 1],
    [0, 1, 7],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [5, 11, 4],
    [11, 10, 2],
    [10, 7, 6],
    [7, 1, 8],
    [3, 9, 4],
    [3, 4, 2],
    [3, 2, 6],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [2, 4, 11],
    [6, 2, 10],
    [8, 6, 7],
    [9, 8, 1],
];

fn icosahedron_vertices() -> Vec<DVec3> {
    let golden = 0.5 * (1.0 + 5.0f64.sqrt());
    let (g, o) = (golden, 0.0);
    [
        [-1.0, g, o],
        [1.0, g, o],
        [-1.0, -g, o],
        [1.0, -g, o],
        [o, -1.0, g],
        [o, 1.0, g],
        [o, -1.0, -g],
        [o, 1.0, -g],
        [g, o, -1.0],
        [g, o, 1.0],
        [-g, o, -1.0],
        [-g, o, 1.0],
    ]
    .map(|v| DVec3::from_array(v) / (1.0 + golden * golden).sqrt())
    .to_vec()
}

/// An icosahedron whose edges are halved `subdivisions` times, with each new vertex projected onto the sphere.
pub(super) fn sphere(radius: f64, subdivisions: u32) -> Mesh {
    let mut vertices = icosahedron_vertices();
    let mut triangles = ICOSAHEDRON.to_vec();
    for _ in 0..subdivisions {
        triangles = halve(&mut vertices, &triangles);
    }
    for vertex in &mut vertices {
        *vertex *= radius;
    }
    Mesh { vertices, triangles }
}

/// Splits each triangle into four at the middles of its edges.
fn halve(vertices: &mut Vec<DVec3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    // the map is never iterated, so the order of the vertices is deterministic
    let mut middles: HashMap<(u32, u32), u32> = HashMap::with_capacity(triangles.len() * 3 / 2);
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let sum = vertices[a as usize] + vertices[b as usize];
            vertices.push(sum / sum.length());
            vertices.len() as u32 - 1
        })
    };
    let mut quarters = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        quarters.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    quarters
}

/// A regular tetrahedron of this edge length, from alternate corners of a cube.
pub(super) fn tetrahedron(size: f64) -> Mesh {
    let half_cube = size / 8.0f64.sqrt();
    let vertices = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]
        .map(|v| half_cube * DVec3::from_array(v))
        .to_vec();
    Mesh { vertices, triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]] }
}
