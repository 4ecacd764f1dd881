//! Merges vertices that are the same point but for rounding.
//!
//! Equal vertices are merged first. Of what is left, only vertices at open edges are merged within a tolerance: a
//! gap closes, and no vertex of a closed surface moves, however fine its triangles are.
//!
//! In order of their index, vertices become representatives unless one is within the tolerance, and then take the place of
//! the nearest. No vertex moves farther than the tolerance, so no triangle collapses whose edges are all longer than twice
//! that. A grid whose cells are as wide as that finds the neighbours, so that time is proportional to size.

use std::collections::HashMap;

use glam::DVec3;

use super::edges::{EdgeTable, net_direction};
use crate::shape::mesh::Mesh;
use crate::shape::watertight::weld;

/// The default tolerance as a fraction of the diagonal of the bounding box. Rounding to single precision moves a
/// coordinate by up to 6e-8 of its size, and a few operations on such numbers by several times that.
pub(super) const RELATIVE_TOLERANCE: f64 = 1e-6;

/// The smallest tolerance, as a fraction of the diagonal: the rounding of doubles.
const LEAST_TOLERANCE: f64 = 1e-15;

/// A triangle whose shortest edge is below this fraction of its longest is a sliver, which may collapse.
const SLIVER: f64 = 0.01;

/// A welded mesh: the result of [`Mesh::welded`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Welded {
    /// The mesh; its vertices are in the order of their first occurrence.
    pub mesh: Mesh,
    /// The tolerance (m): vertices at open edges that were within it of each other are one.
    pub tolerance: f64,
    /// The number of vertices that were equal to an earlier one.
    pub equal: usize,
    /// The number of vertices that were not equal to an earlier one, but within the tolerance.
    pub near: usize,
    /// The number of triangles that had two corners at one point, and were left out.
    pub collapsed: usize,
}

impl Mesh {
    /// Merges vertices that are equal (0 and −0 are), and vertices at open edges within `tolerance` (m).
    ///
    /// Without a tolerance, it is 1e-6 of the diagonal of the bounding box, or as much less as is necessary to keep every triangle that is no
    /// sliver. A tolerance below 1e-15 of the diagonal merges equal vertices only.
    ///
    /// A triangle with two corners at one point is left out. Triangles refer to existing vertices
    /// afterwards; those that did not before, or had corners that are not finite, are left out too.
    pub fn welded(&self, tolerance: Option<f64>) -> Welded {
        let exact = merge(self, &weld(&self.vertices));
        let equal = self.vertices.len() - exact.vertices.len();
        let diagonal = exact.bounds().map_or(0.0, |bounds| (bounds.max - bounds.min).length());
        // huge coordinates overflow; such a mesh is refused elsewhere
        let diagonal = if diagonal.is_finite() { diagonal } else { 0.0 };
        let least = LEAST_TOLERANCE * diagonal;
        let open = open_vertices(&exact);
        let mut used = tolerance.unwrap_or(RELATIVE_TOLERANCE * diagonal);
        let mut mesh = exact;
        while !open.is_empty() && used >= least && used > 0.0 {
            let first_of = nearby(&mesh.vertices, &open, used);
            if tolerance.is_none() && collapses_more_than_slivers(&mesh, &first_of) {
                used *= 0.1;
                continue;
            }
            mesh = merge(&mesh, &first_of);
            break;
        }
        let near = self.vertices.len() - equal - mesh.vertices.len();
        let collapsed = self.triangles.len() - mesh.triangles.len();
        Welded { mesh, tolerance: used, equal, near, collapsed }
    }
}

/// Replaces each vertex by the one of this index, which is no higher, and leaves out triangles that collapse.
fn merge(mesh: &Mesh, first_of: &[u32]) -> Mesh {
    let mut vertices = Vec::new();
    let mut renumbered = vec![0u32; first_of.len()];
    for (i, &first) in first_of.iter().enumerate() {
        if first as usize == i {
            renumbered[i] = vertices.len() as u32;
            vertices.push(mesh.vertices[i]);
        } else {
            renumbered[i] = renumbered[first as usize];
        }
    }
    let triangles = mesh
        .triangles
        .iter()
        .filter(|&&t| mesh.corners(t).is_some())
        .map(|t| t.map(|i| renumbered[i as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    Mesh { vertices, triangles }
}

/// The vertices at edges with more half-edges in one direction, in ascending order.
fn open_vertices(mesh: &Mesh) -> Vec<u32> {
    let mut open = vec![false; mesh.vertices.len()];
    for (lower, edge) in EdgeTable::new(&mesh.triangles, mesh.vertices.len()).edges() {
        if net_direction(edge) != 0 {
            open[lower as usize] = true;
            open[edge[0].upper as usize] = true;
        }
    }
    (0u32..).zip(open).filter(|&(_, open)| open).map(|(i, _)| i).collect()
}

/// For each vertex its representative: for those that are open the nearest within the tolerance, for others themselves.
fn nearby(vertices: &[DVec3], open: &[u32], tolerance: f64) -> Vec<u32> {
    let mut first_of: Vec<u32> = (0..vertices.len() as u32).collect();
    let low = open.iter().fold(DVec3::INFINITY, |low, &i| low.min(vertices[i as usize]));
    let width = 2.0 * tolerance;
    let cell = |p: DVec3| ((p - low) / width).to_array().map(|x| x.floor() as i64);
    // the last representative of each cell, and the one before it
    let mut last_in: HashMap<[i64; 3], u32> = HashMap::new();
    let mut before: HashMap<u32, u32> = HashMap::new();
    for &i in open {
        let place = vertices[i as usize];
        let (from, to) = (cell(place - tolerance), cell(place + tolerance));
        let mut nearest: Option<(f64, u32)> = None;
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                for z in from[2]..=to[2] {
                    let mut at = last_in.get(&[x, y, z]).copied();
                    while let Some(other) = at {
                        let distance = vertices[other as usize].distance(place);
                        if distance <= tolerance && nearest.is_none_or(|n| (distance, other) < n) {
                            nearest = Some((distance, other));
                        }
                        at = before.get(&other).copied();
                    }
                }
            }
        }
        if let Some((_, first)) = nearest {
            first_of[i as usize] = first;
        } else if let Some(previous) = last_in.insert(cell(place), i) {
            before.insert(i, previous);
        }
    }
    first_of
}

/// Whether a triangle would collapse that is no sliver.
fn collapses_more_than_slivers(mesh: &Mesh, first_of: &[u32]) -> bool {
    mesh.triangles.iter().any(|t| {
        let [a, b, c] = t.map(|i| first_of[i as usize]);
        if a != b && b != c && c != a {
            return false;
        }
        let [p, q, r] = t.map(|i| mesh.vertices[i as usize]);
        let edges = [p.distance(q), q.distance(r), r.distance(p)];
        let longest = edges.iter().fold(0.0, |most: f64, &x| most.max(x));
        edges.iter().all(|&x| x >= SLIVER * longest)
    })
}

#[cfg(test)]
mod tests;
