//! One level of the grid: balls of similar size, sorted by the cell of their centre.
//!
//! Cell indices run fastest along x, so neighbouring cells of a row are one range of balls. Along an axis of more than 2²¹ cells the
//! indices repeat. Distant balls may then share a cell, which costs tests and misses no pair; and a body that has left the
//! scene does not force the others into one large cell.

use std::ops::Range as Span;

use glam::DVec3;

use super::Ball;
use super::order::FoundPairs;
use super::overlap::{Sphere, are_ordinary, overlaps, overlaps_ordinary};

/// A range of balls in the order of the level: start and end.
pub(super) type Range = (u32, u32);

/// Number of cells along an axis after which indices repeat, so that all cell indices fit into 63 bits.
const PERIOD: i64 = 1 << 21;

/// Centres farther from the origin than this many cells are clamped to the outermost cell.
const FARTHEST: f64 = (1_u64 << 40) as f64;

/// Cells are wider than the largest diameter by this factor: see [`Level::search_same_level`].
const CELL_FACTOR: f64 = 1.0 + 1.0 / 256.0;

/// The search range of a finer ball is enlarged by this factor: more than [`overlaps`] allows for rounding.
const RANGE_FACTOR: f64 = 1.0 + 1e-11;

/// The largest number of sort buckets per ball.
const BUCKETS_PER_BALL: u64 = 4;

/// A uniform grid with balls of similar size.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    /// 1 / cell width (1/m); 0 where one cell holds everything.
    inverse_width: f64,
    /// The smallest and the largest radius (m).
    smallest: f64,
    largest: f64,
    axes: [Axis; 3],
    /// 2^shift consecutive cells are one bucket of the sort.
    shift: u32,
    /// The first ball of each bucket, and the end.
    starts: Vec<u32>,
    /// Sorted by cell, then index; `spheres` are in the same order.
    entries: Vec<Entry>,
    spheres: Vec<Sphere>,
    /// Buffer: distances from the origin (m), for their median.
    distances: Vec<f64>,
}

/// The cells along one axis.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// The first cell, counted from the origin.
    base: i64,
    count: i64,
    /// Whether cell `count` is cell 0 again. Otherwise the first and the last cell are empty.
    repeats: bool,
}

/// A ball in the grid.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    cell: u64,
    index: u32,
    active: bool,
}

impl Axis {
    /// For balls in cells from `lowest` to `highest`.
    fn new(lowest: i64, highest: i64) -> Self {
        let count = highest - lowest + 3;
        Self { base: lowest - 1, count: count.min(PERIOD), repeats: count > PERIOD }
    }

    /// The local index of a cell counted from the origin; out of range for cells outside the grid, where indices do not repeat.
    fn local(&self, cell: i64) -> i64 {
        if self.repeats { (cell - self.base).rem_euclid(PERIOD) } else { cell - self.base }
    }

    /// Wraps a local index that is one step beyond the ends.
    fn wrap(&self, local: i64) -> i64 {
        if local < 0 {
            local + self.count
        } else if local >= self.count {
            local - self.count
        } else {
            local
        }
    }

    /// First local index and number of the cells between two cells counted from the origin, inclusive.
    fn local_range(&self, from: i64, to: i64) -> (i64, i64) {
        let (first, extent) = (self.local(from), to - from);
        if self.repeats {
            return (first, extent + 1);
        }
        let (from, to) = (first.max(0), (first + extent).min(self.count - 1));
        (from, to - from + 1)
    }
}

impl Level {
    /// Number of balls.
    pub(super) fn len(&self) -> usize {
        self.entries.len()
    }

    /// Number of balls in the fullest cell.
    #[cfg(test)]
    pub(super) fn max_cell_count(&self) -> usize {
        self.entries.chunk_by(|a, b| a.cell == b.cell).map(<[_]>::len).max().unwrap_or(0)
    }

    /// Replaces the content by the balls with these indices.
    pub(super) fn insert(&mut self, balls: &[Ball], indices: &[u32]) {
        self.choose_cells(balls, indices);
        self.sort(balls, indices);
        self.spheres.clear();
        self.spheres.extend(self.entries.iter().map(|entry| {
            let ball = &balls[entry.index as usize];
            Sphere { centre: ball.centre, radius: ball.radius }
        }));
    }

    /// Chooses the width and the number of cells.
    fn choose_cells(&mut self, balls: &[Ball], indices: &[u32]) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        (self.smallest, self.largest) = (f64::INFINITY, 0.0);
        for index in indices {
            let ball = &balls[*index as usize];
            low = low.min(ball.centre);
            high = high.max(ball.centre);
            self.smallest = self.smallest.min(ball.radius);
            self.largest = self.largest.max(ball.radius);
        }
        let mut width = 2.0 * self.largest * CELL_FACTOR;
        if width < low.abs().max(high.abs()).max_element() / FARTHEST {
            // radii are zero or tiny: take a width that separates half of the centres
            self.distances.clear();
            let distance = |index: &u32| balls[*index as usize].centre.abs().max_element();
            self.distances.extend(indices.iter().map(distance));
            let middle = self.distances.len() / 2;
            let (_, median, _) = self.distances.select_nth_unstable_by(middle, f64::total_cmp);
            width = width.max(*median / (PERIOD / 4) as f64);
        }
        // an infinite width has the inverse 0; a zero width must not have an infinite one
        self.inverse_width = 1.0 / width.max(1e-300);
        let (low, high) = (self.cell(low), self.cell(high));
        self.axes = [0, 1, 2].map(|axis| Axis::new(low[axis], high[axis]));
    }

    /// The cell of a point, counted from the origin along each axis. It never decreases where a coordinate increases.
    #[inline(always)]
    fn cell(&self, point: DVec3) -> [i64; 3] {
        [point.x, point.y, point.z].map(|coordinate| {
            let scaled = (coordinate * self.inverse_width).clamp(-FARTHEST, FARTHEST);
            // round down without a call to `floor`
            let towards_zero = scaled as i64;
            towards_zero - i64::from(towards_zero as f64 > scaled)
        })
    }

    /// Index of the first cell of a row.
    fn row(&self, y: i64, z: i64) -> u64 {
        let [along_x, along_y, _] = &self.axes;
        ((z * along_y.count + y) * along_x.count) as u64
    }

    /// Sorts by cell, then index: a counting sort by bucket, whose starts serve as a table of buckets, then a sort of each bucket of
    /// more than one cell.
    fn sort(&mut self, balls: &[Ball], indices: &[u32]) {
        let [along_x, along_y, along_z] = self.axes;
        let cell_count = along_x.count as u64 * along_y.count as u64 * along_z.count as u64;
        self.shift = 0;
        while cell_count >> self.shift > BUCKETS_PER_BALL * indices.len() as u64 {
            self.shift += 1;
        }
        let mut starts = std::mem::take(&mut self.starts);
        let mut entries = std::mem::take(&mut self.entries);
        let entry = |index: u32| {
            let ball = &balls[index as usize];
            let cell = self.cell(ball.centre);
            let [x, y, z] = [0, 1, 2].map(|axis| self.axes[axis].local(cell[axis]));
            Entry { cell: self.row(y, z) + x as u64, index, active: ball.active }
        };
        // counts are stored two places ahead, so that after the prefix sum and the insertion each entry is a start
        starts.clear();
        starts.resize((cell_count >> self.shift) as usize + 3, 0);
        for index in indices {
            starts[(entry(*index).cell >> self.shift) as usize + 2] += 1;
        }
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        entries.resize(indices.len(), Entry::default());
        for index in indices {
            let entry = entry(*index);
            let next = &mut starts[(entry.cell >> self.shift) as usize + 1];
            entries[*next as usize] = entry;
            *next += 1;
        }
        if self.shift > 0 {
            for bucket in starts.windows(2) {
                let bucket = &mut entries[bucket[0] as usize..bucket[1] as usize];
                bucket.sort_unstable_by_key(|entry| (entry.cell, entry.index));
            }
        }
        (self.starts, self.entries) = (starts, entries);
    }

    /// The first ball in this cell or a later one.
    fn first_from(&self, cell: u64) -> u32 {
        let bucket = (cell >> self.shift) as usize;
        let start = self.starts[bucket];
        if self.shift == 0 {
            return start;
        }
        let bucket = &self.entries[start as usize..self.starts[bucket + 1] as usize];
        start + bucket.partition_point(|entry| entry.cell < cell) as u32
    }

    /// Adds the balls of `count` cells of a row, from local index `first` on.
    #[inline(always)]
    fn add_row(&self, row: u64, (first, count): (i64, i64), ranges: &mut Vec<Range>) {
        let mut add = |from: i64, to: i64| {
            let range = (self.first_from(row + from as u64), self.first_from(row + to as u64));
            if range.0 < range.1 {
                ranges.push(range);
            }
        };
        let end = self.axes[0].count;
        if first < 0 {
            add(0, first + count);
            add(first + end, end);
        } else if first + count > end {
            add(first, end);
            add(0, first + count - end);
        } else {
            add(first, first + count);
        }
    }

    /// Finds pairs of these balls with balls of this level, each pair once: with later balls of the same cell, and with one half of
    /// the cells around it, those whose first nonzero offset in the order z, y, x is positive.
    ///
    /// The cells of an overlapping pair are equal or adjacent: with w ≥ 2 (1 + 1/256) times the largest radius, the values x / w differ by less
    /// than 1 − 2⁻⁹. Up to 2⁴¹, rounding adds less than 2⁻¹² to each; beyond, both are clamped to the same [`FARTHEST`], and
    /// clamping never increases a difference. So the computed x / w differ by less than 1, and their floors by at most 1.
    pub(super) fn search_same_level(
        &self,
        balls: Span<usize>,
        ranges: &mut Vec<Range>,
        pairs: &mut FoundPairs,
    ) {
        let ordinary = are_ordinary(2.0 * self.smallest, 2.0 * self.largest);
        let (mut cell, mut row_end) = (u64::MAX, 0);
        for index in balls {
            let (entry, sphere) = (self.entries[index], &self.spheres[index]);
            if entry.cell != cell {
                cell = entry.cell;
                ranges.clear();
                row_end = self.list_forward_cells(sphere.centre, ranges);
            }
            let own = (index as u32 + 1, row_end);
            self.test((&entry, sphere), own, ordinary, pairs);
            for range in ranges.iter() {
                self.test((&entry, sphere), *range, ordinary, pairs);
            }
        }
    }

    /// Lists the forward half of the cells around that of a ball; returns the end of the part in its own row.
    fn list_forward_cells(&self, centre: DVec3, ranges: &mut Vec<Range>) -> u32 {
        let cell = self.cell(centre);
        let [x, y, z] = [0, 1, 2].map(|axis| self.axes[axis].local(cell[axis]));
        let [along_x, along_y, along_z] = &self.axes;
        let row = self.row(y, z);
        for (dy, dz) in [(1, 0), (-1, 1), (0, 1), (1, 1)] {
            let row = self.row(along_y.wrap(y + dy), along_z.wrap(z + dz));
            self.add_row(row, (x - 1, 3), ranges);
        }
        if x + 1 == along_x.count {
            self.add_row(row, (0, 1), ranges);
            self.first_from(row + along_x.count as u64)
        } else {
            self.first_from(row + x as u64 + 2)
        }
    }

    /// Finds pairs of these balls of a finer level with balls of this level.
    ///
    /// With s the sum of a ball's radius and the largest radius here, every ball here that overlaps it has its centre between x − s and
    /// x + s, also as computed, since rounding is monotonic. s is less than a cell width, so these are at most three cells
    /// along each axis.
    pub(super) fn search_from_finer(
        &self,
        finer: &Self,
        balls: Span<usize>,
        ranges: &mut Vec<Range>,
        pairs: &mut FoundPairs,
    ) {
        let ordinary = are_ordinary(finer.smallest + self.smallest, finer.largest + self.largest);
        let mut block = None;
        for (entry, sphere) in finer.entries[balls.clone()].iter().zip(&finer.spheres[balls]) {
            let range = DVec3::splat((sphere.radius + self.largest) * RANGE_FACTOR);
            let corners = (self.cell(sphere.centre - range), self.cell(sphere.centre + range));
            if block != Some(corners) {
                block = Some(corners);
                ranges.clear();
                self.list_cells(corners.0, corners.1, ranges);
            }
            for range in ranges.iter() {
                self.test((entry, sphere), *range, ordinary, pairs);
            }
        }
    }

    /// Lists the cells between two corners, counted from the origin, inclusive.
    fn list_cells(&self, from: [i64; 3], to: [i64; 3], ranges: &mut Vec<Range>) {
        let [xs, ys, zs] = [0, 1, 2].map(|axis| self.axes[axis].local_range(from[axis], to[axis]));
        if xs.1 <= 0 {
            return;
        }
        for z in zs.0..zs.0 + zs.1 {
            for y in ys.0..ys.0 + ys.1 {
                let row = self.row(self.axes[1].wrap(y), self.axes[2].wrap(z));
                self.add_row(row, xs, ranges);
            }
        }
    }

    /// Tests a ball against a range of balls of this level.
    #[inline(always)]
    fn test(
        &self,
        (entry, sphere): (&Entry, &Sphere),
        range: Range,
        ordinary: bool,
        pairs: &mut FoundPairs,
    ) {
        let range = range.0 as usize..range.1 as usize;
        let others = self.entries[range.clone()].iter().zip(&self.spheres[range]);
        if ordinary {
            let hit = |(other, other_sphere): (&Entry, &Sphere)| {
                let wanted = entry.active | other.active;
                (overlaps_ordinary(sphere, other_sphere) & wanted, other.index)
            };
            pairs.add_hits(others.map(hit), entry.index);
        } else {
            let hit = |(other, other_sphere): (&Entry, &Sphere)| {
                let wanted = entry.active | other.active;
                (wanted && overlaps(sphere, other_sphere), other.index)
            };
            pairs.add_hits(others.map(hit), entry.index);
        }
    }
}
