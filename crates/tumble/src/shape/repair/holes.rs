//! The holes of a mesh: closed paths along its open edges.

use std::collections::HashMap;

use glam::DVec3;

use super::edges::{EdgeTable, net_direction};
use super::faces::Faces;
use crate::shape::mesh::Mesh;

/// A path that deviates from its plane by less than this fraction of its length is planar.
const PLANAR: f64 = 1e-5;

/// A hole, or the rim of an open sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// The vertices around it, in the direction in which the triangles beside it run; none occurs twice.
    pub vertices: Vec<u32>,
    /// The mean of these vertices (m).
    pub centre: DVec3,
    /// The length of its edges together (m).
    pub perimeter: f64,
    /// Whether all its vertices lie in a plane, up to 1e-5 of the perimeter.
    pub is_planar: bool,
}

impl Mesh {
    /// The holes of the mesh: each is a closed path along edges at which one more triangle runs in one direction. Vertices at the
    /// same place count as one. Holes that touch at a vertex are separate. Paths that do not close, as where windings
    /// are inconsistent, are left out.
    pub fn holes(&self) -> Vec<Hole> {
        let faces = Faces::new(self);
        let mut next: HashMap<u32, Vec<u32>> = HashMap::new();
        let mut starts = Vec::new();
        for (lower, edge) in EdgeTable::new(&faces.corners, self.vertices.len()).edges() {
            let (from, to) = match net_direction(edge) {
                1 => (lower, edge[0].upper),
                -1 => (edge[0].upper, lower),
                _ => continue,
            };
            next.entry(from).or_default().push(to);
            starts.push(from);
        }
        let mut holes = Vec::new();
        for start in starts {
            paths_from(start, &mut next, |vertices| holes.push(self.hole(vertices)));
        }
        holes
    }

    /// The middles of the edges at which more than two triangles meet (m). Vertices at the same place count as one.
    pub fn non_manifold_edges(&self) -> Vec<DVec3> {
        let faces = Faces::new(self);
        let table = EdgeTable::new(&faces.corners, self.vertices.len());
        let middle =
            |[a, b]: [u32; 2]| 0.5 * self.vertices[a as usize] + 0.5 * self.vertices[b as usize];
        let edges = table.edges().filter(|(_, edge)| edge.len() > 2);
        edges.map(|(lower, edge)| middle([lower, edge[0].upper])).collect()
    }

    fn hole(&self, vertices: Vec<u32>) -> Hole {
        let places: Vec<DVec3> = vertices.iter().map(|&i| self.vertices[i as usize]).collect();
        // the mean, without overflow
        let count = places.len() as f64;
        let centre = places.iter().map(|&p| p / count).sum();
        let ends = || places.iter().zip(places.iter().cycle().skip(1));
        let perimeter = ends().map(|(a, b)| a.distance(*b)).sum();
        let normal = path_normal(&places, centre).normalize_or_zero();
        let off = places.iter().fold(0.0f64, |most, &p| most.max(normal.dot(p - centre).abs()));
        Hole { vertices, centre, perimeter, is_planar: off <= PLANAR * perimeter }
    }
}

/// Twice the vector area of a closed path about a point.
pub(super) fn path_normal(places: &[DVec3], centre: DVec3) -> DVec3 {
    let ends = places.iter().zip(places.iter().cycle().skip(1));
    ends.map(|(&a, &b)| (a - centre).cross(b - centre)).sum()
}

/// Follows edges from a vertex until there are none, and calls `found` for each closed path without repeated vertices. Edges are
/// used up.
fn paths_from(start: u32, next: &mut HashMap<u32, Vec<u32>>, mut found: impl FnMut(Vec<u32>)) {
    let mut path = vec![start];
    let mut place_of = HashMap::from([(start, 0usize)]);
    let mut at = start;
    while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
        at = to;
        // the path has met itself: what lies between is a hole
        if let Some(&place) = place_of.get(&to) {
            let hole = path.split_off(place);
            hole.iter().for_each(|vertex| {
                place_of.remove(vertex);
            });
            found(hole);
        }
        place_of.insert(to, path.len());
        path.push(to);
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{cube, joined, soup};
    use super::*;

    #[test]
    fn holes_have_a_place_and_a_size() {
        let mut open = cube(DVec3::ZERO);
        assert!(open.holes().is_empty());
        open.triangles.drain(0..2);
        let holes = soup(&open, 0.0).holes();
        assert_eq!(holes.len(), 1);
        let (hole, perimeter) = (&holes[0], 4.0);
        assert_eq!((hole.vertices.len(), hole.perimeter, hole.is_planar), (4, perimeter, true));
        assert_eq!(hole.centre, DVec3::new(0.0, 0.0, -0.5));
        // two faces at an edge: one hole that is not planar
        open.triangles.drain(2..4);
        let holes = open.holes();
        assert_eq!((holes.len(), holes[0].vertices.len(), holes[0].is_planar), (1, 6, false));
    }

    #[test]
    fn holes_that_touch_at_a_vertex_are_two() {
        let mut open = cube(DVec3::ZERO);
        // two triangles of opposite faces' corners that share one vertex
        open.triangles.retain(|t| *t != [0, 2, 3] && *t != [1, 3, 7]);
        let holes = open.holes();
        assert_eq!(holes.len(), 2);
        assert!(holes.iter().all(|hole| hole.vertices.len() == 3 && hole.is_planar));
        assert_eq!(joined(&open, &open).without_duplicates().mesh.holes().len(), 2);
    }
}
