//! A coarse grid of signed distances: tells at once of points far outside that they are.
//!
//! A signed distance grows no faster than one goes, so that the distance at a cell's centre bounds it all around.

use glam::DVec3;

use super::tree::Extent;

/// Cells along the longest side of the box, at least and at most.
const CELLS: [f64; 2] = [12.0, 32.0];
/// Between these, cells are so many times as large as triangles.
const COARSENESS: f64 = 3.0;
/// What rounding may have added to a distance, in units of the box's longest side.
const ROUNDING: f64 = 1e-12;

/// The grid.
#[derive(Clone, Debug)]
pub(super) struct Coarse {
    low: DVec3,
    /// Edge of a cell (m).
    edge: f64,
    /// 1/edge (m⁻¹).
    inverse: f64,
    counts: [usize; 3],
    /// Signed distances of the cells' centres, less their rounding (m).
    distances: Vec<f64>,
    /// That rounding (m).
    rounding: f64,
}

impl Coarse {
    /// Asks for the signed distance at the centre of each cell of a grid over the box of triangles about as large as `grain` (m).
    pub fn over(bounds: &Extent, grain: f64, mut distance: impl FnMut(DVec3) -> f64) -> Self {
        let sides = bounds.high - bounds.low;
        let longest = sides.max_element();
        let edge = longest / (longest / (COARSENESS * grain)).clamp(CELLS[0], CELLS[1]);
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

    /// The signed distance of a point is at least this (m).
    #[inline]
    pub fn at_least(&self, point: DVec3) -> f64 {
        let (distance, way) = self.nearby(point);
        distance - way
    }

    /// The signed distance of a point is at most this (m).
    #[inline]
    pub fn at_most(&self, point: DVec3) -> f64 {
        let (distance, way) = self.nearby(point);
        distance + 2.0 * self.rounding + way
    }

    /// The distance that is kept of the cell closest to a point, and how far away its centre is (m).
    #[inline]
    fn nearby(&self, point: DVec3) -> (f64, f64) {
        let place = (point - self.low) * self.inverse;
        // the conversion saturates
        let cell = [0, 1, 2].map(|axis| (place[axis] as usize).min(self.counts[axis] - 1));
        let [x, y, z] = cell;
        let distance = self.distances[(z * self.counts[1] + y) * self.counts[0] + x];
        (distance, self.centre(cell).distance(point))
    }

    /// Bytes in use.
    pub fn memory(&self) -> usize {
        size_of::<f64>() * self.distances.capacity()
    }
}
