//! Triangulation of an implicit surface by marching tetrahedra.
//!
//! Each cube of a grid is divided into six tetrahedra around its main diagonal. The division is the same in every cube,
//! so neighbouring cubes agree on their common face. The surface cuts a tetrahedron in one triangle or one
//! quadrilateral and there are no ambiguous cases, so the mesh is a watertight manifold for every field.

use crate::mesh::Mesh;
use crate::solid::Solid;
use glam::DVec3;
use std::collections::BTreeMap;

/// The six tetrahedra of a cube, one per path of three edges from corner 0 to corner 7. Bits 0, 1 and 2 of a corner are
/// its x, y and z.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// A regular grid over a box, with the field sampled at each grid point.
struct Grid {
    low: DVec3,
    cell: f64,
    counts: [usize; 3],
    values: Vec<f64>,
}

/// Triangulates the surface of `solid` within the box from `low` to `high`, with grid cells of size `cell`.
pub fn polygonise(solid: &Solid, low: DVec3, high: DVec3, cell: f64) -> Mesh {
    let grid = Grid::sample(solid, low, high, cell);
    let mut mesh = Mesh::default();
    let mut crossings = BTreeMap::new();
    let [nx, ny, nz] = grid.counts;
    for z in 0..nz - 1 {
        for y in 0..ny - 1 {
            for x in 0..nx - 1 {
                for tetrahedron in TETRAHEDRA {
                    let corners = tetrahedron.map(|bits| {
                        grid.index(x + (bits & 1), y + (bits >> 1 & 1), z + (bits >> 2))
                    });
                    cut_tetrahedron(&grid, corners, &mut crossings, &mut mesh);
                }
            }
        }
    }
    mesh
}

/// Adds the one or two triangles in which the surface cuts a tetrahedron. `crossings` maps grid edges to vertices.
fn cut_tetrahedron(
    grid: &Grid,
    corners: [usize; 4],
    crossings: &mut BTreeMap<(usize, usize), usize>,
    mesh: &mut Mesh,
) {
    let (inside, outside): (Vec<usize>, Vec<usize>) =
        corners.into_iter().partition(|&corner| grid.values[corner] < 0.0);
    if inside.is_empty() || outside.is_empty() {
        return;
    }
    let mut vertex_on = |a: usize, b: usize| {
        *crossings.entry((a.min(b), a.max(b))).or_insert_with(|| {
            mesh.points.push(grid.crossing(a.min(b), a.max(b)));
            mesh.points.len() - 1
        })
    };
    // the vertices around the cut, in either winding
    let polygon: Vec<usize> = match (inside.as_slice(), outside.as_slice()) {
        ([a], rest) | (rest, [a]) => rest.iter().map(|&b| vertex_on(*a, b)).collect(),
        (inside, outside) => vec![
            vertex_on(inside[0], outside[0]),
            vertex_on(inside[0], outside[1]),
            vertex_on(inside[1], outside[1]),
            vertex_on(inside[1], outside[0]),
        ],
    };
    // orient the triangles from the inside corners to the outside corners
    let mean = |group: &[usize]| {
        group.iter().map(|&corner| grid.point(corner)).sum::<DVec3>() / group.len() as f64
    };
    let outward = mean(&outside) - mean(&inside);
    let fan: Vec<[usize; 3]> =
        (2..polygon.len()).map(|i| [polygon[0], polygon[i - 1], polygon[i]]).collect();
    let area: DVec3 = fan.iter().map(|&triangle| mesh.area_vector(triangle)).sum();
    let inward = area.dot(outward) < 0.0;
    mesh.triangles
        .extend(fan.into_iter().map(|[a, b, c]| if inward { [a, c, b] } else { [a, b, c] }));
}

impl Grid {
    fn sample(solid: &Solid, low: DVec3, high: DVec3, cell: f64) -> Self {
        let counts = ((high - low) / cell).to_array().map(|n| libm::ceil(n) as usize + 1);
        let mut grid = Grid { low, cell, counts, values: Vec::new() };
        let total = counts.iter().product();
        grid.values = (0..total).map(|i| solid.field(grid.point(i))).collect();
        grid
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    fn point(&self, index: usize) -> DVec3 {
        let [nx, ny, _] = self.counts;
        let cells = [index % nx, index / nx % ny, index / nx / ny].map(|n| n as f64);
        self.low + self.cell * DVec3::from_array(cells)
    }

    /// The point where the surface crosses a grid edge. It stays away from the ends of the edge, so no triangle degenerates.
    fn crossing(&self, a: usize, b: usize) -> DVec3 {
        let (from, to) = (self.values[a], self.values[b]);
        let fraction = (from / (from - to)).clamp(0.05, 0.95);
        self.point(a) + fraction * (self.point(b) - self.point(a))
    }
}
