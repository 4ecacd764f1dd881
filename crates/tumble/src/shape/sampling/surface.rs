//! Points spread evenly over a surface: a Poisson-disk sample, maximal but for a known bound.
//!
//! Each triangle is cut into cells, and each cell throws one dart at itself, the cells in random order; a dart that
//! lands free of all points becomes a point. Then each cell that no single point covers is halved, and its halves
//! throw and are halved in turn, down to a tenth of the spacing. Then the surface is covered: nowhere is the nearest
//! point further than the least distance between points and that tenth.
//! Source: M. S. Ebeida, S. A. Mitchell, A. Patney, A. A. Davidson and J. D. Owens, "A simple algorithm for maximal
//! Poisson-disk sampling in high dimensions", Comput. Graph. Forum 31 (2012) 785, with triangles for squares.

use super::{SampleError, affordable};
use crate::shape::Mesh;
use crate::shape::integrals::{NOTHING, SIZES};
use glam::DVec3;

/// Least distance between points, as a part of the spacing.
const DISTANCE: f64 = 0.8;

/// Longest edge of a cell at the start, as a part of the spacing.
const COARSEST: f64 = 1.5;

/// Longest edge of the cells that are given up uncovered: the most that a hole can exceed `DISTANCE`.
const FINEST: f64 = 0.1;

/// Passes over the cells that take the place of a random order, where cells are about as large as the spacing.
const PASSES: u64 = 16;

/// Points per spacing squared that such a sample has; measured.
const DENSITY: f64 = 1.1;

/// Lengths within this part of each other count as equal, so that a turned mesh is cut alike.
const TIE: f64 = 1e-9;

/// The finaliser of SplitMix64: a counter in, random bits out. Source: G. L. Steele, D. Lea and C. H. Flood,
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

/// A piece of a triangle.
#[derive(Clone, Copy)]
struct Cell {
    corners: [DVec3; 3],
    /// Random, from the triangle's index and the halvings that led here: order and darts follow from it.
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

    /// A point of the cell, evenly at random.
    fn dart(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        let (u, v) = (unit(mix(self.key ^ 1)), unit(mix(self.key ^ 2)));
        // the far half of the parallelogram folds back onto the triangle
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        a + (b - a) * u + (c - a) * v
    }

    /// Whether the ball around `centre` of this squared radius covers the cell: it does if it holds the corners.
    fn lies_within(&self, centre: DVec3, squared_radius: f64) -> bool {
        self.corners.iter().all(|v| v.distance_squared(centre) < squared_radius)
    }

    /// Cuts the cell at the middle of its longest edge, the first of equals.
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

/// The points so far, to be found by place: a hash table of chains, one per block of space.
struct Points {
    points: Vec<DVec3>,
    origin: DVec3,
    distance: f64,
    /// Edge of a block: two distances, so that a ball of that radius touches at most two blocks along each axis.
    block: f64,
    /// The newest point in each slot, as index plus one; 0 for none.
    heads: Vec<u32>,
    /// The next older point in the same slot, for each point.
    chain: Vec<u32>,
}

impl Points {
    /// For points above `low` in all coordinates, and about as many as expected.
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
        // all places lie above the origin, where cutting the fraction off rounds down
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

    /// Calls `visit` for all points within `reach` of `place`, and some more.
    fn each_near(&self, place: DVec3, reach: f64, mut visit: impl FnMut(DVec3)) {
        let low = self.block_of(place - DVec3::splat(reach));
        let high = self.block_of(place + DVec3::splat(reach));
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

    /// Adds the cell's dart if it lands free.
    fn throw(&mut self, cell: &Cell) {
        let dart = cell.dart();
        let least = self.distance * self.distance;
        let mut free = true;
        self.each_near(dart, self.distance, |p| free &= p.distance_squared(dart) >= least);
        if free {
            self.push(dart);
        }
    }

    /// Halves a cell and throws darts until points cover it, or pieces are down to the finest size.
    fn fill(&mut self, spare: &mut Spare, cell: Cell, finest: f64) {
        // what can matter to any piece, looked up once: a piece and its darts lie within the cell
        let Spare { stack, near } = spare;
        let [a, b, c] = cell.corners;
        let middle = (a + b + c) / 3.0;
        let extent = [a, b, c].map(|v| v.distance_squared(middle)).into_iter().fold(0.0, f64::max);
        let reach = (self.distance + extent.sqrt()) * (1.0 + TIE);
        near.clear();
        self.each_near(middle, reach, |p| {
            if p.distance_squared(middle) <= reach * reach {
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

/// Memory that `Points::fill` uses again for each cell.
#[derive(Default)]
struct Spare {
    stack: Vec<Cell>,
    near: Vec<DVec3>,
}

/// Puts the cells in an order that is random near by and orderly from afar: passes over the whole surface, each
/// over a random part of the cells in which no two are likely to be neighbours.
///
/// A wholly random order would wait for memory most of the time; a wholly orderly one would pack the points
/// against each other. Of cells finer than the spacing it takes the more passes, the finer they are.
fn shuffle(cells: &mut [Cell], expected: f64) {
    let crowd = (cells.len() as f64 / (2.0 * expected).max(1.0)).ceil();
    let passes = PASSES * crowd as u64;
    // a stable sort, so that each pass keeps the mesh's own order
    cells.sort_by_key(|cell| cell.key % passes);
}

/// The triangles, relative to `origin`, in cells of at most the coarsest size.
fn cells(mesh: &Mesh, origin: DVec3, spacing: f64) -> Vec<Cell> {
    let coarsest = COARSEST * COARSEST * spacing * spacing * (1.0 + TIE);
    let mut cells = Vec::new();
    let mut stack = Vec::new();
    for (&triangle, index) in mesh.triangles.iter().zip(0u64..) {
        let Some(corners) = mesh.corners(triangle) else { continue };
        let whole = Cell { corners: corners.map(|v| v - origin), key: mix(index) };
        if double_area(&whole) <= NOTHING * whole.longest() {
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

/// Refuses before any work what would make too many points; returns about how many there will be.
fn estimate(mesh: &Mesh, spacing: f64, size: f64) -> Result<f64, SampleError> {
    // in units of the spacing, so that no square leaves the range of doubles before its time
    let (mut area, mut edges) = (0.0, 0.0);
    for corners in mesh.triangles.iter().filter_map(|&t| mesh.corners(t)) {
        let cell = Cell { corners: corners.map(|v| v / spacing), key: 0 };
        area += 0.5 * double_area(&cell);
        // a sliver has no area to speak of, but is cut all along
        edges += 0.2 * (cell.longest().sqrt() - 1.0).max(0.0);
    }
    let points = DENSITY * area;
    affordable(spacing, points, 2.0, size)?;
    affordable(spacing, edges, 1.0, size)?;
    Ok(points)
}

/// Points on the surface, at least `DISTANCE` spacings apart and covering it.
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
    let mut spare = Spare::default();
    for cell in &cells {
        points.fill(&mut spare, *cell, finest);
    }

    // the shift back may round two points together only where the spacing is below a coordinate's last bits
    let mut points = points.points;
    for point in &mut points {
        *point += origin;
    }
    Ok(points)
}
