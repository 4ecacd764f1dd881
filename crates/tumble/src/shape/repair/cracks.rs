//! Cracks: holes without area, between triangles whose vertices along an edge are not the same (T-junctions).
//!
//! Triangles without area would close them, but have no normal. So the triangle beside a crack is divided at the vertices
//! of the other side, which changes no surface.

use std::collections::HashMap;

use glam::DVec3;

use super::faces::Faces;
use super::holes::Hole;
use crate::shape::mesh::Mesh;

/// The vertices of a crack deviate from a line by less than this fraction of its perimeter: the rounding of single precision.
const STRAIGHT: f64 = 1e-6;
/// The most edges of a crack.
const MAX_EDGES: usize = 1000;

/// The direction of the line on which all vertices of a hole lie, if they do.
fn line(mesh: &Mesh, hole: &Hole) -> Option<DVec3> {
    let place = |&i: &u32| mesh.vertices[i as usize];
    let first = place(hole.vertices.first()?);
    let far = |a: &DVec3, b: &DVec3| a.distance(first).total_cmp(&b.distance(first));
    let end = hole.vertices.iter().map(place).max_by(far)?;
    let along = (end - first).normalize_or_zero();
    let is_near = |p: DVec3| (p - first).cross(along).length() <= STRAIGHT * hole.perimeter;
    let is_crack = hole.vertices.len() <= MAX_EDGES && hole.vertices.iter().map(place).all(is_near);
    is_crack.then_some(along)
}

/// Whether a hole has no area.
pub(super) fn is_crack(mesh: &Mesh, hole: &Hole) -> bool {
    line(mesh, hole).is_some()
}

/// Closes cracks.
pub(super) fn close_cracks(mesh: &mut Mesh, cracks: &[&Hole]) {
    if cracks.is_empty() {
        return;
    }
    let mut sides = Sides::new(mesh, cracks);
    for crack in cracks {
        let Some(along) = line(mesh, crack) else { continue };
        let height = |i: u32| mesh.vertices[i as usize].dot(along);
        let ends = crack.vertices.iter().zip(crack.vertices.iter().cycle().skip(1));
        for (&a, &b) in ends {
            let (low, high) = (height(a).min(height(b)), height(a).max(height(b)));
            let is_between = |&i: &u32| i != a && i != b && (low < height(i)) && (height(i) < high);
            let mut between: Vec<u32> = crack.vertices.iter().copied().filter(is_between).collect();
            between.sort_unstable_by(|&i, &k| height(i).total_cmp(&height(k)).then(i.cmp(&k)));
            if height(a) > height(b) {
                between.reverse();
            }
            sides.divide(a, b, &between);
        }
    }
    mesh.triangles = sides.triangles;
}

/// The triangles of a mesh, and those beside cracks by their edges.
struct Sides {
    triangles: Vec<[u32; 3]>,
    /// The triangle through which an edge runs from the first vertex to the second.
    beside: HashMap<[u32; 2], usize>,
}

impl Sides {
    fn new(mesh: &Mesh, cracks: &[&Hole]) -> Self {
        let mut beside: HashMap<[u32; 2], usize> = HashMap::new();
        for crack in cracks {
            let ends = crack.vertices.iter().zip(crack.vertices.iter().cycle().skip(1));
            beside.extend(ends.map(|(&a, &b)| ([a, b], usize::MAX)));
        }
        let faces = Faces::new(mesh);
        let mut triangles = mesh.triangles.clone();
        for (&[a, b, c], &index) in faces.corners.iter().zip(&faces.index) {
            for edge in [[a, b], [b, c], [c, a]] {
                if let Some(triangle) = beside.get_mut(&edge) {
                    *triangle = index as usize;
                    // with the names of vertices by which holes are known
                    triangles[index as usize] = [a, b, c];
                }
            }
        }
        Self { triangles, beside }
    }

    /// Divides the triangle beside an edge at these vertices, which lie on the edge in this order.
    fn divide(&mut self, a: u32, b: u32, between: &[u32]) {
        let Some(&index) = self.beside.get(&[a, b]).filter(|_| !between.is_empty()) else { return };
        let Some(&[p, q, r]) = self.triangles.get(index) else { return };
        let apex = [(p, q, r), (q, r, p), (r, p, q)].into_iter().find(|t| (t.0, t.1) == (a, b));
        let Some((_, _, apex)) = apex.filter(|(.., apex)| !between.contains(apex)) else { return };
        self.triangles[index] = [a, between[0], apex];
        for (i, &from) in between.iter().enumerate() {
            let to = between.get(i + 1).copied().unwrap_or(b);
            self.triangles.push([from, to, apex]);
        }
        // the last part has the edge behind the divided one
        if let Some(triangle) = self.beside.get_mut(&[b, apex]) {
            *triangle = self.triangles.len() - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{cuboid, soup};
    use super::*;

    /// A cube of 8 m³ with this vertex on the edge between the first two, which only one of the faces has.
    fn with_t_junction(at: DVec3) -> Mesh {
        let mut mesh = cuboid(DVec3::ZERO, DVec3::splat(2.0));
        mesh.vertices.push(at);
        let divided = mesh.triangles.iter().position(|t| *t == [0, 1, 5]).unwrap();
        mesh.triangles[divided] = [0, 8, 5];
        mesh.triangles.push([8, 1, 5]);
        mesh
    }

    #[test]
    fn a_vertex_that_one_side_lacks_divides_the_other() {
        for off in [0.0, 1e-7] {
            let mesh = with_t_junction(DVec3::new(0.3, -1.0, -1.0 + off));
            assert!(!mesh.watertightness().is_closed());
            for mesh in [mesh.clone(), soup(&mesh, 0.0)] {
                let closed = mesh.with_closed_holes().unwrap();
                assert_eq!((closed.holes.len(), closed.added), (1, 1));
                assert!(closed.mesh.watertightness().is_manifold());
                let volume = closed.mesh.solid_integrals().unwrap().measure;
                assert!((volume - 8.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn each_side_may_lack_vertices_of_the_other() {
        let mut mesh = with_t_junction(DVec3::new(0.3, -1.0, -1.0));
        // the other face at this edge has two others
        mesh.vertices.extend([DVec3::new(-0.4, -1.0, -1.0), DVec3::new(0.6, -1.0, -1.0)]);
        let other = mesh.triangles.iter().position(|t| *t == [0, 3, 1]).unwrap();
        mesh.triangles[other] = [0, 3, 9];
        mesh.triangles.extend([[9, 3, 10], [10, 3, 1]]);
        let closed = mesh.with_closed_holes().unwrap();
        assert_eq!(closed.added, 3);
        assert!(closed.mesh.watertightness().is_manifold());
        let volume = closed.mesh.solid_integrals().unwrap().measure;
        assert!((volume - 8.0).abs() < 1e-12);
    }
}
