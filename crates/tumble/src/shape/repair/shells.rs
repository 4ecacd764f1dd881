//! The closed surfaces of a mesh: connected components, with consistent winding.
//!
//! Faces are connected where exactly two meet at an edge. At an edge with more faces, components pass by each other, as
//! where two cubes share an edge. Components that are closed only together are one shell (`groups`).

use std::collections::BTreeSet;

use glam::DVec3;

use super::edges::{EdgeOfFace, EdgeTable};
use super::faces::Faces;
use super::groups::{Uneven, closed_groups};
use super::sets::ParitySets;
use crate::shape::mesh::Mesh;

/// The longest allowed boundary of a shell, in units of the square root of its area: that of a small hole.
const HOLE: f64 = 0.25;

/// The faces by shell.
pub(super) struct Shells {
    /// For each face the closed shell that it belongs to.
    pub of_face: Vec<Option<u32>>,
    /// The number of shells that are closed, but for small holes.
    pub count: usize,
    /// For each face whether its winding differs from that of most faces connected with it.
    pub rewound: Vec<bool>,
    /// The number of edges of two faces at which no winding of the component is consistent, as on a Möbius strip.
    pub one_sided: usize,
    /// The middle of the first of these edges (m).
    pub first_one_sided: Option<DVec3>,
}

impl Shells {
    pub fn new(mesh: &Mesh, faces: &Faces) -> Self {
        let table = EdgeTable::new(&faces.corners, mesh.vertices.len());
        let mut sets = ParitySets::new(faces.len());
        let mut contradictions: Vec<(u32, DVec3)> = Vec::new();
        for (lower, edge) in table.edges() {
            if let [a, b] = edge {
                let differ = a.is_descending == b.is_descending;
                if !sets.join(a.face, b.face, differ) {
                    let ends = [lower, a.upper].map(|i| mesh.vertices[i as usize]);
                    contradictions.push((a.face, 0.5 * ends[0] + 0.5 * ends[1]));
                }
            }
        }
        let (component, mut rewound) = majority(&mut sets, faces.len());
        // on a one-sided component no winding is right
        let count = component.iter().max().map_or(0, |&last| last as usize + 1);
        let mut is_one_sided = vec![false; count];
        for &(face, _) in &contradictions {
            is_one_sided[component[face as usize] as usize] = true;
        }
        for (face, rewound) in rewound.iter_mut().enumerate() {
            *rewound &= !is_one_sided[component[face] as usize];
        }
        let mut parts = Parts {
            of_face: component,
            rewound,
            closed: is_one_sided.iter().map(|&one_sided| !one_sided).collect(),
        };
        parts.join_at_edges(&table);
        parts.check_boundaries(mesh, faces, &table);
        let (of_face, count) = parts.closed_ones();
        Self {
            of_face,
            count,
            rewound: parts.rewound,
            one_sided: contradictions.len(),
            first_one_sided: contradictions.first().map(|c| c.1),
        }
    }
}

/// Connected parts of the faces.
struct Parts {
    /// For each face the part that it belongs to.
    of_face: Vec<u32>,
    rewound: Vec<bool>,
    /// For each part whether it is closed.
    closed: Vec<bool>,
}

impl Parts {
    /// Joins components that are not closed by themselves at edges where more than two faces meet.
    fn join_at_edges(&mut self, table: &EdgeTable) {
        let many = table.edges().filter(|(_, edge)| edge.len() > 2);
        let uneven: BTreeSet<Uneven> = many.map(|(_, edge)| self.uneven(edge)).collect();
        let uneven = uneven.into_iter().filter(|edge| !edge.is_empty()).collect();
        let group = closed_groups(self.closed.len(), &uneven);
        for (component, &group) in group.iter().enumerate() {
            self.closed[group as usize] &= self.closed[component];
        }
        for part in &mut self.of_face {
            *part = group[*part as usize];
        }
    }

    /// The parts that have more half-edges in one direction at an edge, and how many more.
    fn uneven(&self, edge: &[EdgeOfFace]) -> Uneven {
        let net = |half: &EdgeOfFace| {
            let is_descending = half.is_descending ^ self.rewound[half.face as usize];
            (self.of_face[half.face as usize], if is_descending { -1i64 } else { 1 })
        };
        // nearly all edges are like this
        if let [a, b] = edge
            && let ((part_a, step_a), (part_b, step_b)) = (net(a), net(b))
            && part_a == part_b
            && step_a + step_b == 0
        {
            return Vec::new();
        }
        let mut all: Vec<(u32, i64)> = edge.iter().map(net).collect();
        all.sort_unstable();
        let parts = all.chunk_by(|a, b| a.0 == b.0);
        let sums = parts.map(|part| (part[0].0, part.iter().map(|p| p.1).sum::<i64>()));
        sums.filter(|&(_, sum)| sum != 0).collect()
    }

    /// Marks parts as not closed that have faulty edges, other than those of small holes.
    fn check_boundaries(&mut self, mesh: &Mesh, faces: &Faces, table: &EdgeTable) {
        let mut area = vec![0.0; self.closed.len()];
        for (face, &shell) in self.of_face.iter().enumerate() {
            let [a, b, c] = faces.places(mesh, face);
            area[shell as usize] += 0.5 * (b - a).cross(c - a).length();
        }
        let mut boundary = vec![0.0; self.closed.len()];
        for (lower, edge) in table.edges() {
            let ends = [lower, edge[0].upper].map(|i| mesh.vertices[i as usize]);
            for (shell, _) in self.uneven(edge) {
                boundary[shell as usize] += ends[0].distance(ends[1]);
            }
        }
        for (shell, closed) in self.closed.iter_mut().enumerate() {
            *closed &= boundary[shell] <= HOLE * area[shell].sqrt();
        }
    }

    /// For each face the number of its part among those that are closed, and how many there are.
    fn closed_ones(&self) -> (Vec<Option<u32>>, usize) {
        let mut number = vec![None; self.closed.len()];
        let mut count = 0;
        let of_face = self.of_face.iter().map(|&part| {
            if !self.closed[part as usize] {
                return None;
            }
            let name = &mut number[part as usize];
            if name.is_none() {
                *name = Some(count);
                count += 1;
            }
            *name
        });
        let of_face = of_face.collect();
        (of_face, count as usize)
    }
}

/// The component of each face, numbered in order, and whether its winding is that of fewer faces of the component.
fn majority(sets: &mut ParitySets, count: usize) -> (Vec<u32>, Vec<bool>) {
    let mut number = vec![u32::MAX; count];
    let (mut component, mut odd) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut balance: Vec<i64> = Vec::new();
    for face in 0..count as u32 {
        let (root, is_odd) = sets.root(face);
        let name = &mut number[root as usize];
        if *name == u32::MAX {
            *name = balance.len() as u32;
            balance.push(0);
        }
        balance[*name as usize] += if is_odd { -1 } else { 1 };
        component.push(*name);
        odd.push(is_odd);
    }
    let is_minority = |(&component, odd): (&u32, bool)| odd == (balance[component as usize] >= 0);
    let rewound = component.iter().zip(odd).map(is_minority).collect();
    (component, rewound)
}
