//! Balls of about one size, sorted by the cell that their centre is in.
//!
//! Cells are numbered with x fastest, so neighbouring cells of a row are one range of balls. Along an axis of more
//! than 2²¹ cells the numbers repeat: balls that are far apart may then share a cell, which costs tests and loses
//! nothing, and a body that fell out of the world does not crowd the others into one cell.

use std::ops::Range as Span;

use glam::DVec3;

use super::Ball;
use super::order::FoundPairs;
use super::overlap::{Sphere, are_ordinary, overlaps, overlaps_ordinary};

/// Balls from … to before …, in the order of the level.
pub(super) type Range = (u32, u32);

/// Cells along an axis after which their numbers repeat: the numbers of all cells fit into 63 bits.
const PERIOD: i64 = 1 << 21;

/// Farther from the origin than so many cells, all is in the outermost cell.
const FARTHEST: f64 = (1_u64 << 40) as f64;

/// Cells are wider than two of the largest balls by this factor: see [`Level::look_around`].
const ROOMY: f64 = 1.0 + 1.0 / 256.0;

/// A finer ball radii farther by this factor when it looks up: more than [`overlaps`] allows for rounding.
const FARTHER: f64 = 1.0 + 1e-11;

/// Buckets of the sort, at most, for each ball.
const BUCKETS_A_BALL: u64 = 4;

/// A grid with balls of about one size.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    /// 1 / width of a cell (1/m), 0 where one cell holds everything.
    per_width: f64,
    /// The smallest and the largest radius (m).
    least: f64,
    largest: f64,
    axes: [Axis; 3],
    /// Cells 2ˢ at a time are a bucket of the sort.
    shift: u32,
    /// The first ball of each bucket, and the end.
    starts: Vec<u32>,
    /// In the order of cells, then numbers; `spheres` are in the same order.
    entries: Vec<Entry>,
    spheres: Vec<Sphere>,
    /// Distances from the origin (m), while their median is looked for.
    distances: Vec<f64>,
}

/// Cells along an axis.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// The first, counted from the origin.
    base: i64,
    count: i64,
    /// Whether cell `count` is cell 0 again. Otherwise the first and the last are empty.
    repeats: bool,
}

/// A ball that is filed.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    cell: u64,
    number: u32,
    active: bool,
}

impl Axis {
    /// For cells of balls from … to …
    fn new(lowest: i64, highest: i64) -> Self {
        let count = highest - lowest + 3;
        Self { base: lowest - 1, count: count.min(PERIOD), repeats: count > PERIOD }
    }

    /// The number here of a cell counted from the origin; outside of the range where cells do not repeat.
    fn place(&self, cell: i64) -> i64 {
        if self.repeats { (cell - self.base).rem_euclid(PERIOD) } else { cell - self.base }
    }

    /// What a step beyond the ends leads to.
    fn wrap(&self, place: i64) -> i64 {
        if place < 0 {
            place + self.count
        } else if place >= self.count {
            place - self.count
        } else {
            place
        }
    }

    /// First place and number of cells among cells from … to …, counted from the origin.
    fn places(&self, from: i64, to: i64) -> (i64, i64) {
        let (first, extent) = (self.place(from), to - from);
        if self.repeats {
            return (first, extent + 1);
        }
        let (from, to) = (first.max(0), (first + extent).min(self.count - 1));
        (from, to - from + 1)
    }
}

impl Level {
    /// How many balls are filed.
    pub(super) fn len(&self) -> usize {
        self.entries.len()
    }

    /// How many balls the fullest cell has.
    #[cfg(test)]
    pub(super) fn most_in_a_cell(&self) -> usize {
        self.entries.chunk_by(|a, b| a.cell == b.cell).map(<[_]>::len).max().unwrap_or(0)
    }

    /// Files these balls and forgets those before.
    pub(super) fn file(&mut self, balls: &[Ball], numbers: &[u32]) {
        self.measure(balls, numbers);
        self.sort(balls, numbers);
        self.spheres.clear();
        self.spheres.extend(self.entries.iter().map(|entry| {
            let ball = &balls[entry.number as usize];
            Sphere { centre: ball.centre, radius: ball.radius }
        }));
    }

    /// Chooses width and number of cells.
    fn measure(&mut self, balls: &[Ball], numbers: &[u32]) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        (self.least, self.largest) = (f64::INFINITY, 0.0);
        for number in numbers {
            let ball = &balls[*number as usize];
            low = low.min(ball.centre);
            high = high.max(ball.centre);
            self.least = self.least.min(ball.radius);
            self.largest = self.largest.max(ball.radius);
        }
        let mut width = 2.0 * self.largest * ROOMY;
        if width < low.abs().max(high.abs()).max_element() / FARTHEST {
            // points, or nearly: any width will do that tells half of them apart
            self.distances.clear();
            let distance = |number: &u32| balls[*number as usize].centre.abs().max_element();
            self.distances.extend(numbers.iter().map(distance));
            let middle = self.distances.len() / 2;
            let (_, median, _) = self.distances.select_nth_unstable_by(middle, f64::total_cmp);
            width = width.max(*median / (PERIOD / 4) as f64);
        }
        // where the width is infinite, its inverse is 0; it must not be infinite itself
        self.per_width = 1.0 / width.max(1e-300);
        let (low, high) = (self.cell(low), self.cell(high));
        self.axes = [0, 1, 2].map(|axis| Axis::new(low[axis], high[axis]));
    }

    /// The cell of a place, counted from the origin along each axis. Never decreases where a coordinate increases.
    #[inline(always)]
    fn cell(&self, place: DVec3) -> [i64; 3] {
        [place.x, place.y, place.z].map(|coordinate| {
            let scaled = (coordinate * self.per_width).clamp(-FARTHEST, FARTHEST);
            // rounded down; the platform's `floor` is a call
            let towards_zero = scaled as i64;
            towards_zero - i64::from(towards_zero as f64 > scaled)
        })
    }

    /// The number of the cell 0 of a row.
    fn row(&self, y: i64, z: i64) -> u64 {
        let [along_x, along_y, _] = &self.axes;
        ((z * along_y.count + y) * along_x.count) as u64
    }

    /// Sorts by cell, then number: a counting sort by bucket, which leaves the index to the buckets behind, then
    /// each bucket of more than one cell.
    fn sort(&mut self, balls: &[Ball], numbers: &[u32]) {
        let [along_x, along_y, along_z] = self.axes;
        let cell_count = along_x.count as u64 * along_y.count as u64 * along_z.count as u64;
        self.shift = 0;
        while cell_count >> self.shift > BUCKETS_A_BALL * numbers.len() as u64 {
            self.shift += 1;
        }
        let mut starts = std::mem::take(&mut self.starts);
        let mut entries = std::mem::take(&mut self.entries);
        let entry = |number: u32| {
            let ball = &balls[number as usize];
            let cell = self.cell(ball.centre);
            let [x, y, z] = [0, 1, 2].map(|axis| self.axes[axis].place(cell[axis]));
            Entry { cell: self.row(y, z) + x as u64, number, active: ball.active }
        };
        // two behind: what is counted there ends as the start
        starts.clear();
        starts.resize((cell_count >> self.shift) as usize + 3, 0);
        for number in numbers {
            starts[(entry(*number).cell >> self.shift) as usize + 2] += 1;
        }
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        entries.resize(numbers.len(), Entry::default());
        for number in numbers {
            let entry = entry(*number);
            let next = &mut starts[(entry.cell >> self.shift) as usize + 1];
            entries[*next as usize] = entry;
            *next += 1;
        }
        if self.shift > 0 {
            for bucket in starts.windows(2) {
                let bucket = &mut entries[bucket[0] as usize..bucket[1] as usize];
                bucket.sort_unstable_by_key(|entry| (entry.cell, entry.number));
            }
        }
        (self.starts, self.entries) = (starts, entries);
    }

    /// The first ball that is in this cell or a later one.
    fn first_from(&self, cell: u64) -> u32 {
        let bucket = (cell >> self.shift) as usize;
        let start = self.starts[bucket];
        if self.shift == 0 {
            return start;
        }
        let bucket = &self.entries[start as usize..self.starts[bucket + 1] as usize];
        start + bucket.partition_point(|entry| entry.cell < cell) as u32
    }

    /// Adds the balls of some cells of a row: `count` from place `first` on.
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

    /// Pairs of these balls with those behind them here, each pair once: with later balls of their cell, and with one
    /// half of the cells around, those of which the first step that is not 0 of z, y, x is forward.
    ///
    /// No overlapping pair is farther apart than a cell and its neighbour: with w ≥ 2 (1 + 1/256) times the largest
    /// radius, x / w differ by less than 1 − 2⁻⁹. Up to 2⁴¹, rounding adds less than 2⁻¹² to each; beyond, both are
    /// cut to the same [`FARTHEST`], and cutting never takes two apart. So x / w as computed differ by less than 1
    /// and what they are rounded down to, by at most 1.
    pub(super) fn look_around(
        &self,
        balls: Span<usize>,
        ranges: &mut Vec<Range>,
        found: &mut FoundPairs,
    ) {
        let ordinary = are_ordinary(2.0 * self.least, 2.0 * self.largest);
        let (mut cell, mut behind) = (u64::MAX, 0);
        for index in balls {
            let (entry, sphere) = (self.entries[index], &self.spheres[index]);
            if entry.cell != cell {
                cell = entry.cell;
                ranges.clear();
                behind = self.find_around(sphere.centre, ranges);
            }
            let own = (index as u32 + 1, behind);
            self.test((&entry, sphere), own, ordinary, found);
            for range in ranges.iter() {
                self.test((&entry, sphere), *range, ordinary, found);
            }
        }
    }

    /// Adds the half of the cells around that of a ball; returns the end of its own row's part.
    fn find_around(&self, centre: DVec3, ranges: &mut Vec<Range>) -> u32 {
        let cell = self.cell(centre);
        let [x, y, z] = [0, 1, 2].map(|axis| self.axes[axis].place(cell[axis]));
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

    /// Pairs of these balls of a finer level with those here.
    ///
    /// With s the sum of a ball's radius and the largest here, every ball here that overlaps it has its centre from
    /// x − s to x + s, as computed too: rounding never changes the order of two numbers. s is less than the width of a
    /// cell, so this is at most three cells an axis.
    pub(super) fn look_up(
        &self,
        finer: &Self,
        balls: Span<usize>,
        ranges: &mut Vec<Range>,
        found: &mut FoundPairs,
    ) {
        let ordinary = are_ordinary(finer.least + self.least, finer.largest + self.largest);
        let mut block = None;
        for (entry, sphere) in finer.entries[balls.clone()].iter().zip(&finer.spheres[balls]) {
            let radius = DVec3::splat((sphere.radius + self.largest) * FARTHER);
            let corners = (self.cell(sphere.centre - radius), self.cell(sphere.centre + radius));
            if block != Some(corners) {
                block = Some(corners);
                ranges.clear();
                self.find_between(corners.0, corners.1, ranges);
            }
            for range in ranges.iter() {
                self.test((entry, sphere), *range, ordinary, found);
            }
        }
    }

    /// Adds the cells from … to …, counted from the origin.
    fn find_between(&self, from: [i64; 3], to: [i64; 3], ranges: &mut Vec<Range>) {
        let [xs, ys, zs] = [0, 1, 2].map(|axis| self.axes[axis].places(from[axis], to[axis]));
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

    /// Pairs of a ball with a range of those here.
    #[inline(always)]
    fn test(
        &self,
        (entry, sphere): (&Entry, &Sphere),
        range: Range,
        ordinary: bool,
        found: &mut FoundPairs,
    ) {
        let range = range.0 as usize..range.1 as usize;
        let others = self.entries[range.clone()].iter().zip(&self.spheres[range]);
        if ordinary {
            let hit = |(other, other_sphere): (&Entry, &Sphere)| {
                let wanted = entry.active | other.active;
                (overlaps_ordinary(sphere, other_sphere) & wanted, other.number)
            };
            found.keep(others.map(hit), entry.number);
        } else {
            let hit = |(other, other_sphere): (&Entry, &Sphere)| {
                let wanted = entry.active | other.active;
                (wanted && overlaps(sphere, other_sphere), other.number)
            };
            found.keep(others.map(hit), entry.number);
        }
    }
}
