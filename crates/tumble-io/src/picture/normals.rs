//! Vertex normals of triangle meshes.

use glam::{DVec3, Vec3};

/// Cosine of the crease angle: faces that meet at a smaller angle are shaded as one smooth surface.
const CREASE_COSINE: f32 = 0.75;
/// At most this many faces around a vertex contribute to a normal. The cost grows with the square
/// of their number.
const MAX_FACES_PER_VERTEX: usize = 64;

/// Unit normal at each corner of each triangle: smooth within a surface, sharp at creases.
///
/// Each normal is the area-weighted mean over the adjacent faces within the crease angle.
/// `radius` (m) is the size of the mesh and only scales intermediate results. The normal of a
/// triangle without area is zero.
pub(crate) fn corner_normals(
    vertices: &[DVec3],
    triangles: &[[u32; 3]],
    radius: f64,
) -> Vec<[Vec3; 3]> {
    let scale = if radius > 0.0 { 1.0 / radius } else { 1.0 };
    let area_vector = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| vertices[i as usize] * scale);
        (b - a).cross(c - a)
    };
    let areas: Vec<DVec3> = triangles.iter().map(area_vector).collect();
    let flat: Vec<Vec3> = areas.iter().map(|n| n.normalize_or_zero().as_vec3()).collect();
    let (start, faces) = faces_by_vertex(vertices.len(), triangles);
    let corner = |f: usize, i: u32| {
        let adjacent = &faces[start[i as usize]..start[i as usize + 1]];
        let mut sum = DVec3::ZERO;
        for &face in adjacent.iter().take(MAX_FACES_PER_VERTEX) {
            if flat[face as usize].dot(flat[f]) > CREASE_COSINE {
                sum += areas[face as usize];
            }
        }
        sum.try_normalize().map_or(flat[f], |n| n.as_vec3())
    };
    let corners = |(f, t): (usize, &[u32; 3])| t.map(|i| corner(f, i));
    triangles.iter().enumerate().map(corners).collect()
}

/// The faces around each vertex in compressed rows: vertex `i` has the faces
/// `faces[start[i]..start[i + 1]]`.
fn faces_by_vertex(vertex_count: usize, triangles: &[[u32; 3]]) -> (Vec<usize>, Vec<u32>) {
    let mut start = vec![0usize; vertex_count + 1];
    for &i in triangles.iter().flatten() {
        start[i as usize + 1] += 1;
    }
    for i in 0..vertex_count {
        start[i + 1] += start[i];
    }
    let mut faces = vec![0u32; 3 * triangles.len()];
    let mut next = start.clone();
    for (f, &i) in triangles.iter().enumerate().flat_map(|(f, t)| t.iter().map(move |i| (f, i))) {
        faces[next[i as usize]] = f as u32;
        next[i as usize] += 1;
    }
    (start, faces)
}
