//! From field to triangles: marching tetrahedra.
//!
//! Each cube of a lattice is cut into six tetrahedra around its main diagonal, the same way
//! everywhere, so neighbours agree on every face. A tetrahedron is cut by one triangle or one quad
//! and has no ambiguous case: the surface is a closed manifold whatever the field does.

use crate::mesh::Mesh;
use crate::solid::Solid;
use glam::DVec3;
use std::collections::BTreeMap;

/// The six ways from one corner of a cube to the opposite one along three edges; a corner is
/// three bits, x y z.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// A lattice over a box, with the field at each of its corners.
struct Lattice {
    low: DVec3,
    cell: f64,
    counts: [usize; 3],
    values: Vec<f64>,
}

/// The surface of `solid` within the box from `low` to `high`, cut at every `cell`.
pub fn polygonise(solid: &Solid, low: DVec3, high: DVec3, cell: f64) -> Mesh {
    let lattice = Lattice::sample(solid, low, high, cell);
    let mut mesh = Mesh::default();
    let mut crossings = BTreeMap::new();
    let [nx, ny, nz] = lattice.counts;
    for z in 0..nz - 1 {
        for y in 0..ny - 1 {
            for x in 0..nx - 1 {
                for tetrahedron in TETRAHEDRA {
                    let corners = tetrahedron.map(|bits| {
                        lattice.index(x + (bits & 1), y + (bits >> 1 & 1), z + (bits >> 2))
                    });
                    cut(&lattice, corners, &mut crossings, &mut mesh);
                }
            }
        }
    }
    mesh
}

/// Adds the one or two triangles in which the surface cuts a tetrahedron.
fn cut(
    lattice: &Lattice,
    corners: [usize; 4],
    crossings: &mut BTreeMap<(usize, usize), usize>,
    mesh: &mut Mesh,
) {
    let (inside, outside): (Vec<usize>, Vec<usize>) =
        corners.into_iter().partition(|&corner| lattice.values[corner] < 0.0);
    if inside.is_empty() || outside.is_empty() {
        return;
    }
    let mut cross = |a: usize, b: usize| {
        *crossings.entry((a.min(b), a.max(b))).or_insert_with(|| {
            mesh.points.push(lattice.crossing(a.min(b), a.max(b)));
            mesh.points.len() - 1
        })
    };
    // the ring of crossings around the cut, in one of its two senses
    let ring: Vec<usize> = match (inside.as_slice(), outside.as_slice()) {
        ([a], others) | (others, [a]) => others.iter().map(|&b| cross(*a, b)).collect(),
        (ins, outs) => vec![
            cross(ins[0], outs[0]),
            cross(ins[0], outs[1]),
            cross(ins[1], outs[1]),
            cross(ins[1], outs[0]),
        ],
    };
    // every triangle looks from the inside corners to the outside ones
    let mean = |group: &[usize]| {
        group.iter().map(|&corner| lattice.point(corner)).sum::<DVec3>() / group.len() as f64
    };
    let outward = mean(&outside) - mean(&inside);
    let fan: Vec<[usize; 3]> = (2..ring.len()).map(|i| [ring[0], ring[i - 1], ring[i]]).collect();
    let area: DVec3 = fan.iter().map(|&triangle| mesh.area_vector(triangle)).sum();
    let turned = area.dot(outward) < 0.0;
    mesh.triangles
        .extend(fan.into_iter().map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }));
}

impl Lattice {
    fn sample(solid: &Solid, low: DVec3, high: DVec3, cell: f64) -> Self {
        let counts = ((high - low) / cell).to_array().map(|n| libm::ceil(n) as usize + 1);
        let mut lattice = Lattice { low, cell, counts, values: Vec::new() };
        let total = counts.iter().product();
        lattice.values = (0..total).map(|i| solid.field(lattice.point(i))).collect();
        lattice
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    fn point(&self, index: usize) -> DVec3 {
        let [nx, ny, _] = self.counts;
        let cells = [index % nx, index / nx % ny, index / nx / ny].map(|n| n as f64);
        self.low + self.cell * DVec3::from_array(cells)
    }

    /// Where the surface crosses the lattice edge, kept off its ends so that no triangle collapses.
    fn crossing(&self, a: usize, b: usize) -> DVec3 {
        let (from, to) = (self.values[a], self.values[b]);
        let along = (from / (from - to)).clamp(0.05, 0.95);
        self.point(a) + along * (self.point(b) - self.point(a))
    }
}
