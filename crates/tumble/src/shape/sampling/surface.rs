//! Poisson-disk sampling of a surface, maximal up to a known bound.
//!
//! Each triangle is divided into cells. In random order, each cell draws one random candidate point (a dart), which
//! is accepted if no accepted point is within the minimum distance. Then each cell not covered by a single point is
//! halved, and its halves draw candidates and are halved in turn, down to a tenth of the spacing. At the end no part
//! of the surface is farther from a point than the minimum distance plus that tenth.
//! Source: M. S. Ebeida, S. A. Mitchell, A. Patney, A. A. Davidson and J. D. Owens, "A simple algorithm for maximal
//! Poisson-disk sampling in high dimensions", Comput. Graph. Forum 31 (2012) 785, with triangles for squares.

use super::error::{SampleError, check_point_count};
use crate::shape::integrals::{NEGLIGIBLE, SIZES};
use crate::shape::mesh::Mesh;
use glam::DVec3;

/// Minimum distance between points, in units of the spacing.
const DISTANCE: f64 = 0.8;

/// Longest edge of an initial cell, in units of the spacing.
const COARSEST: f64 = 1.5;

/// Longest edge of a cell that may stay uncovered, in units of the spacing: the bound by which a gap can
/// exceed `DISTANCE`.
const FINEST: f64 = 0.1;

/// The number of passes over the cells that stand in for a random order, for cells about as large as the spacing.
const PASSES: u64 = 16;

/// Measured points per spacing squared.
const DENSITY: f64 = 1.1;

/// Lengths within this relative tolerance count as equal, so that a rotated mesh is divided in the same way.
const TIE: f64 = 1e-9;

/// The finaliser of SplitMix64, which maps a counter to random bits. Source: G. L. Steele, D. Lea and C. H. Flood,
/// "Fast splittable pseudorandom number generators", OOPSLA 2014.
fn mix(counter: u64) -> u64 {
    let z = counter.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Random bits as a number from 0 to 1.
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// A triangular part of a mesh triangle.
#[derive(Clone, Copy)]
struct Cell {
    corners: [DVec3; 3],
    /// Random bits from the triangle's index and the halvings; they determine the order and the darts.
    key: u64,
}

impl Cell {
    /// The squares of the edge lengths; edge i lies opposite corner i.
    fn edges(&self) -> [f64; 3] {
        let [a, b, c] = self.corners;
        [b.distance_squared(c), c.distance_squared(a), a.distance_squared(b)]
    }

    fn longest(&self) -> f64 {
        let [a, b, c] = self.edges();
        a.max(b).max(c)
    }

    /// A uniformly distributed random point of the cell.
    fn dart(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        let (u, v) = (unit(mix(self.key ^ 1)), unit(mix(self.key ^ 2)));
        // the far half of the parallelogram folds back onto the triangle
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        a + (b - a) * u + (c - a) * v
    }

    /// Whether the ball about `centre` with this squared radius contains the cell, which it does if it contains
    /// the corners.
    fn lies_within(&self, centre: DVec3, squared_radius: f64) -> bool {
        self.corners.iter().all(|v| v.distance_squared(centre) < squared_radius)
    }

    /// Bisects the cell at the middle of its longest edge, the first of equal ones.
    fn halves(&self) -> [Self; 2] {
        let edges = self.edges();
        let longest =
            (1..3).fold(0, |best, i| if edges[i] > edges[best] * (1.0 + TIE) { i } else { best });
        let [tip, a, b] = [0, 1, 2].map(|i| self.corners[(longest + i) % 3]);
        let middle = 0.5 * a + 0.5 * b;
        [
            Self { corners: [tip, a, middle], key: mix(self.key ^ 3) },
            Self { corners: [tip, middle, b], key: mix(self.key ^ 4) },
        ]
    }
}

/// The accepted points in a spatial hash table with chaining.
struct Points {
    points: Vec<DVec3>,
    origin: DVec3,
    distance: f64,
    /// Edge of a block: twice the minimum distance, so that a ball of that radius overlaps at most two blocks
    /// along each axis.
    block: f64,
    /// The latest point in each bucket, as index plus one; 0 for none.
    heads: Vec<u32>,
    /// For each point, the previous point in the same bucket.
    chain: Vec<u32>,
}

impl Points {
    /// An empty table for points above `low` in all coordinates, sized for the expected number.
    fn new(low: DVec3, distance: f64, expected: f64) -> Self {
        let slots = (expected as usize).max(64).next_power_of_two();
        let origin = low - DVec3::splat(4.0 * distance);
        let block = 2.0 * distance * (1.0 + TIE);
        Self {
            points: Vec::new(),
            origin,
            distance,
            block,
            heads: vec![0; slots],
            chain: Vec::new(),
        }
    }

    fn block_of(&self, place: DVec3) -> [i64; 3] {
        // all coordinates are above the origin, so truncation rounds down
        ((place - self.origin) / self.block).to_array().map(|x| x as i64)
    }

    fn slot(&self, block: [i64; 3]) -> usize {
        let [x, y, z] = block.map(|i| i as u64);
        let hash = x
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .wrapping_add(y.wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
            .wrapping_add(z.wrapping_mul(0x1656_67b1_9e37_79f9));
        mix(hash) as usize & (self.heads.len() - 1)
    }

    fn push(&mut self, point: DVec3) {
        let slot = self.slot(self.block_of(point));
        self.points.push(point);
        self.chain.push(self.heads[slot]);
        self.heads[slot] = self.points.len() as u32;
    }

    /// Calls `visit` for all points within `radius` of `place`, and possibly others.
    fn each_near(&self, place: DVec3, radius: f64, mut visit: impl FnMut(DVec3)) {
        let low = self.block_of(place - DVec3::splat(radius));
        let high = self.block_of(place + DVec3::splat(radius));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut link = self.heads[self.slot([x, y, z])];
                    while link > 0 {
                        let index = link as usize - 1;
                        visit(self.points[index]);
                        link = self.chain[index];
                    }
                }
            }
        }
    }

    /// Adds the cell's dart if no point is within the minimum distance.
    fn throw(&mut self, cell: &Cell) {
        let dart = cell.dart();
        let least = self.distance * self.distance;
        let mut free = true;
        self.each_near(dart, self.distance, |p| free &= p.distance_squared(dart) >= least);
        if free {
            self.push(dart);
        }
    }

    /// Bisects a cell and throws darts until points cover it, or its parts are of the finest size.
    fn fill(&mut self, buffers: &mut Buffers, cell: Cell, finest: f64) {
        // all points near the cell, looked up once for all its parts
        let Buffers { stack, near } = buffers;
        let [a, b, c] = cell.corners;
        let middle = (a + b + c) / 3.0;
        let extent = [a, b, c].map(|v| v.distance_squared(middle)).into_iter().fold(0.0, f64::max);
        let radius = (self.distance + extent.sqrt()) * (1.0 + TIE);
        near.clear();
        self.each_near(middle, radius, |p| {
            if p.distance_squared(middle) <= radius * radius {
                near.push(p);
            }
        });

        let limit = self.distance * self.distance;
        stack.push(cell);
        while let Some(cell) = stack.pop() {
            if cell.longest() <= finest || near.iter().any(|&p| cell.lies_within(p, limit)) {
                continue;
            }
            for half in cell.halves() {
                let dart = half.dart();
                if near.iter().all(|p| p.distance_squared(dart) >= limit) {
                    near.push(dart);
                    self.push(dart);
                }
                stack.push(half);
            }
        }
    }
}

/// Buffers that [`Points::fill`] reuses.
#[derive(Default)]
struct Buffers {
    stack: Vec<Cell>,
    near: Vec<DVec3>,
}

/// Orders the cells in passes over the surface, each with a random subset of the cells in the order of the mesh.
///
/// Within a pass, neighbouring cells are unlikely. A fully random order would be slow because of cache misses, and
/// the order of the mesh would bias the sample. Cells finer than the spacing need proportionally more passes.
fn shuffle(cells: &mut [Cell], expected: f64) {
    let cells_per_point = (cells.len() as f64 / (2.0 * expected).max(1.0)).ceil();
    let passes = PASSES * cells_per_point as u64;
    // a stable sort keeps the order of the mesh within a pass
    cells.sort_by_key(|cell| cell.key % passes);
}

/// The triangles, relative to `origin`, divided into cells of at most the coarsest size.
fn cells(mesh: &Mesh, origin: DVec3, spacing: f64) -> Vec<Cell> {
    let coarsest = COARSEST * COARSEST * spacing * spacing * (1.0 + TIE);
    let mut cells = Vec::new();
    let mut stack = Vec::new();
    for (&triangle, index) in mesh.triangles.iter().zip(0u64..) {
        let Some(corners) = mesh.corners(triangle) else { continue };
        let whole = Cell { corners: corners.map(|v| v - origin), key: mix(index) };
        if double_area(&whole) <= NEGLIGIBLE * whole.longest() {
            continue;
        }
        stack.push(whole);
        while let Some(cell) = stack.pop() {
            if cell.longest() > coarsest {
                stack.extend(cell.halves());
            } else {
                cells.push(cell);
            }
        }
    }
    cells
}

fn double_area(cell: &Cell) -> f64 {
    let [a, b, c] = cell.corners;
    (b - a).cross(c - a).length()
}

/// Estimates the number of points, and refuses too many before any work is done.
fn estimate(mesh: &Mesh, spacing: f64, size: f64) -> Result<f64, SampleError> {
    // in units of the spacing, to avoid overflow and underflow of the squares
    let (mut area, mut edges) = (0.0, 0.0);
    for corners in mesh.triangles.iter().filter_map(|&t| mesh.corners(t)) {
        let cell = Cell { corners: corners.map(|v| v / spacing), key: 0 };
        area += 0.5 * double_area(&cell);
        // a sliver has almost no area, but is divided along its length
        edges += 0.2 * (cell.longest().sqrt() - 1.0).max(0.0);
    }
    let points = DENSITY * area;
    check_point_count(spacing, points, 2.0, size)?;
    check_point_count(spacing, edges, 1.0, size)?;
    Ok(points)
}

/// Samples the surface: points at least `DISTANCE` spacings apart that cover it.
pub(super) fn surface(mesh: &Mesh, spacing: f64) -> Result<Vec<DVec3>, SampleError> {
    let bounds = mesh.bounds().ok_or(SampleError::NoSurface)?;
    let (origin, size) = (bounds.centre(), bounds.size());
    if size > 0.0 && !SIZES.contains(&size) {
        return Err(SampleError::OutOfRange { size });
    }
    let expected = estimate(mesh, spacing, size)?;
    let mut cells = cells(mesh, origin, spacing);
    if cells.is_empty() {
        return Err(SampleError::NoSurface);
    }

    shuffle(&mut cells, expected);
    let low = bounds.min - origin;
    let mut points = Points::new(low, DISTANCE * spacing, expected);
    for cell in &cells {
        points.throw(cell);
    }
    let finest = FINEST * FINEST * spacing * spacing * (1.0 + TIE);
    let mut buffers = Buffers::default();
    for cell in &cells {
        points.fill(&mut buffers, *cell, finest);
    }

    // adding the origin can make points coincide only if the spacing is below the rounding of coordinates
    let mut points = points.points;
    for point in &mut points {
        *point += origin;
    }
    Ok(points)
}
