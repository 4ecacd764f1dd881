//! A coarse grid of signed distances, for quick bounds without a search.
//!
//! A signed distance has a Lipschitz constant of 1, so the value at the centre of a cell bounds it everywhere.

use glam::DVec3;

use super::tree::Extent;

/// Minimum and maximum number of cells along the longest edge of the box.
const CELLS: [f64; 2] = [12.0, 32.0];
/// Between these limits, the edge of a cell in units of the triangle size.
const COARSENESS: f64 = 3.0;
/// Bound on the rounding error of a distance, in units of the longest edge of the box.
const ROUNDING: f64 = 1e-12;

/// Signed distances at the centres of a grid of cells.
#[derive(Clone, Debug)]
pub(super) struct BoundGrid {
    low: DVec3,
    /// Edge of a cell (m).
    edge: f64,
    /// 1/edge (m⁻¹).
    inverse: f64,
    counts: [usize; 3],
    /// Signed distances at the centres of the cells, minus `rounding` (m).
    distances: Vec<f64>,
    /// Bound on the rounding error of a distance (m).
    rounding: f64,
}

impl BoundGrid {
    /// A grid over a box of triangles of about `triangle_size` (m); calls `distance` for the centre of each cell.
    pub fn new(
        bounds: &Extent,
        triangle_size: f64,
        mut distance: impl FnMut(DVec3) -> f64,
    ) -> Self {
        let sides = bounds.high - bounds.low;
        let longest = sides.max_element();
        let edge = longest / (longest / (COARSENESS * triangle_size)).clamp(CELLS[0], CELLS[1]);
        let counts = sides.to_array().map(|side| ((side / edge).ceil() as usize).max(1));
        let rounding = ROUNDING * longest;
        let (low, inverse) = (bounds.low, 1.0 / edge);
        let mut grid = Self { low, edge, inverse, counts, distances: Vec::new(), rounding };
        grid.distances.reserve_exact(counts.iter().product());
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                for x in 0..counts[0] {
                    grid.distances.push(distance(grid.centre([x, y, z])) - rounding);
                }
            }
        }
        grid
    }

    fn centre(&self, cell: [usize; 3]) -> DVec3 {
        self.low + DVec3::from_array(cell.map(|i| i as f64 + 0.5)) * self.edge
    }

    /// A lower bound on the signed distance of a point (m).
    #[inline]
    pub fn lower_bound(&self, point: DVec3) -> f64 {
        let (distance, to_centre) = self.closest_cell(point);
        distance - to_centre
    }

    /// An upper bound on the signed distance of a point (m).
    #[inline]
    pub fn upper_bound(&self, point: DVec3) -> f64 {
        let (distance, to_centre) = self.closest_cell(point);
        distance + 2.0 * self.rounding + to_centre
    }

    /// The stored distance of the cell closest to a point, and the distance of the point from its centre (m).
    #[inline]
    fn closest_cell(&self, point: DVec3) -> (f64, f64) {
        let place = (point - self.low) * self.inverse;
        // the conversion saturates
        let cell = [0, 1, 2].map(|axis| (place[axis] as usize).min(self.counts[axis] - 1));
        let [x, y, z] = cell;
        let distance = self.distances[(z * self.counts[1] + y) * self.counts[0] + x];
        (distance, self.centre(cell).distance(point))
    }

    /// Heap memory in use (bytes).
    pub fn memory(&self) -> usize {
        size_of::<f64>() * self.distances.capacity()
    }
}
