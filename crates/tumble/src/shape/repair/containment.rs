//! Which closed surfaces lie inside which.
//!
//! A ray from a point inside a closed surface crosses it an odd number of times. Rays run along one direction, which is parallel to
//! no simple edge, from a few points of each surface. A grid across that direction holds the triangles.

use glam::{DMat3, DVec2, DVec3};

/// The most points of a surface from which rays start, of each kind: corners, and centres of triangles.
const SAMPLES: usize = 32;
/// The most cells along a side of the grid.
const MAX_SIDE: usize = 2048;
/// Above this number of surfaces, only those are judged in which the first ray finds something.
const MANY: usize = 1000;
/// The most tests of a ray against a triangle, for all rays together; a mesh that needs more is not judged.
const MAX_TESTS: usize = 100_000_000;
/// A point closer to a surface than this fraction of the mesh's size lies on it, and says nothing.
const ON_SURFACE: f64 = 1e-9;
/// A surface with small holes contains another if this share of the rays says so.
const MOST: f64 = 0.9;

/// Where a surface lies relative to the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Nesting {
    /// The number of surfaces around it.
    pub depth: usize,
    /// Whether it crosses another one.
    pub crosses: bool,
}

/// The triangles of a surface, rotated so that rays run along z.
pub(super) struct Surfaces {
    /// The corners of all triangles.
    triangles: Vec<[DVec3; 3]>,
    /// The surface of each triangle.
    owner: Vec<u32>,
    /// The bounds of each surface in the original axes.
    bounds: Vec<[DVec3; 2]>,
    size: f64,
}

impl Surfaces {
    /// Surfaces below `count`; each triangle names its own.
    pub fn new(count: usize, triangles: impl Iterator<Item = (u32, [DVec3; 3])>) -> Self {
        // a rotation by no simple angle about no simple axis
        let axis = DVec3::new(0.436_147, 0.771_923, 0.462_511).normalize();
        let turn = DMat3::from_axis_angle(axis, 1.193_817);
        let mut bounds = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; count];
        let (mut all, mut owner) = (Vec::new(), Vec::new());
        for (surface, corners) in triangles {
            let [low, high] = &mut bounds[surface as usize];
            for p in corners {
                (*low, *high) = (low.min(p), high.max(p));
            }
            all.push(corners.map(|p| turn * p));
            owner.push(surface);
        }
        let most = bounds.iter().map(|[low, high]| (*high - *low).max_element());
        let size = most.fold(0.0, f64::max);
        Self { triangles: all, owner, bounds, size }
    }

    /// Where each surface lies; `None` if that takes too long to find out.
    pub fn nesting(&self) -> Option<Vec<Nesting>> {
        let count = self.bounds.len();
        let mut nesting = vec![Nesting::default(); count];
        if count < 2 {
            return Some(nesting);
        }
        let grid = Grid::new(&self.triangles);
        let mut by_owner: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (triangle, &owner) in (0u32..).zip(&self.owner) {
            by_owner[owner as usize].push(triangle);
        }
        let mut tests = 0;
        for (surface, own) in by_owner.iter().enumerate() {
            if tests > MAX_TESTS {
                return None;
            }
            // of many surfaces, most are alone: one ray tells
            let is_alone = count > MANY
                && self
                    .votes(&grid, surface as u32, self.starts(own).take(1), &mut tests)
                    .is_empty();
            if is_alone {
                continue;
            }
            let votes = self.votes(&grid, surface as u32, self.starts(own), &mut tests);
            let asked = self.starts(own).count();
            for of_one in votes.chunk_by(|a, b| a.surface == b.surface) {
                self.judge(surface, asked, of_one, &mut nesting);
            }
        }
        Some(nesting)
    }

    /// What rays from these points of a surface say about others, sorted by the other surface.
    fn votes(
        &self,
        grid: &Grid,
        surface: u32,
        starts: impl Iterator<Item = DVec3>,
        tests: &mut usize,
    ) -> Vec<Vote> {
        let mut votes = Vec::new();
        for start in starts {
            votes.extend(self.crossed(grid, surface, start, tests));
        }
        votes.sort_unstable_by_key(|vote| vote.surface);
        votes
    }

    /// Decides by the votes about another surface whether this one lies within it or crosses it.
    fn judge(&self, surface: usize, asked: usize, votes: &[Vote], nesting: &mut [Nesting]) {
        let other = votes[0].surface as usize;
        let on = votes.iter().filter(|vote| vote.is_on).count();
        let inside = votes.iter().filter(|vote| !vote.is_on && vote.is_inside).count() as f64;
        let clear = (asked - on) as f64;
        if inside > 0.0 && inside >= MOST * clear && self.is_boxed(surface, other) {
            nesting[surface].depth += 1;
        } else if inside > 0.0 && inside >= (1.0 - MOST) * clear {
            nesting[surface].crosses = true;
            nesting[other].crosses = true;
        }
    }

    /// The points of a surface from which rays start.
    fn starts<'a>(&'a self, own: &'a [u32]) -> impl Iterator<Item = DVec3> + 'a {
        let stride = own.len().div_ceil(SAMPLES).max(1);
        own.iter().step_by(stride).flat_map(|&t| {
            let [a, b, c] = self.triangles[t as usize];
            [a, (a + b + c) / 3.0]
        })
    }

    /// Whether the box of a surface is within that of another.
    fn is_boxed(&self, inner: usize, outer: usize) -> bool {
        let ([low, high], [outer_low, outer_high]) = (self.bounds[inner], self.bounds[outer]);
        low.cmpge(outer_low).all() && high.cmple(outer_high).all()
    }

    /// What a ray along z says about each surface that it meets, other than its own.
    fn crossed(&self, grid: &Grid, own: u32, start: DVec3, tests: &mut usize) -> Vec<Vote> {
        let near = ON_SURFACE * self.size;
        let mut hits: Vec<Vote> = Vec::new();
        let cell = grid.at(start.truncate());
        *tests += cell.len();
        for &triangle in cell {
            let surface = self.owner[triangle as usize];
            if surface == own {
                continue;
            }
            if let Some(height) = height_at(self.triangles[triangle as usize], start.truncate()) {
                let above = height - start.z;
                let is_on = above.abs() <= near;
                if is_on || above > 0.0 {
                    hits.push(Vote { surface, is_inside: true, is_on });
                }
            }
        }
        hits.sort_unstable_by_key(|hit| hit.surface);
        let of_each = hits.chunk_by(|a, b| a.surface == b.surface).map(|of_one| Vote {
            surface: of_one[0].surface,
            is_inside: of_one.len() % 2 == 1,
            is_on: of_one.iter().any(|hit| hit.is_on),
        });
        of_each.filter(|vote| vote.is_inside || vote.is_on).collect()
    }
}

/// What a ray says about a surface.
#[derive(Clone, Copy)]
struct Vote {
    surface: u32,
    is_inside: bool,
    is_on: bool,
}

/// The height of a triangle above a point of the plane, if it is above or below it.
fn height_at([a, b, c]: [DVec3; 3], foot: DVec2) -> Option<f64> {
    // the same bits for both triangles of an edge: its ends in a fixed order
    let side = |p: DVec3, q: DVec3| {
        let is_swapped = (p.x, p.y) > (q.x, q.y);
        let (from, to) = if is_swapped { (q, p) } else { (p, q) };
        let value = (to.truncate() - from.truncate()).perp_dot(foot - from.truncate());
        if is_swapped { -value } else { value }
    };
    let sides = [side(b, c), side(c, a), side(a, b)];
    let is_inside = sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s < 0.0);
    let sum: f64 = sides.iter().sum();
    if !is_inside || sum == 0.0 {
        return None;
    }
    Some((sides[0] * a.z + sides[1] * b.z + sides[2] * c.z) / sum)
}

/// The triangles above each cell of the xy plane.
struct Grid {
    low: DVec2,
    cell: DVec2,
    side: usize,
    /// The start of the list of each cell, and the end of the last.
    starts: Vec<usize>,
    entries: Vec<u32>,
}

impl Grid {
    fn new(triangles: &[[DVec3; 3]]) -> Self {
        let corners = || triangles.iter().flatten().map(|p| p.truncate());
        let low = corners().fold(DVec2::INFINITY, DVec2::min);
        let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
        let mut side = ((triangles.len() as f64).sqrt() as usize).clamp(1, MAX_SIDE);
        loop {
            let cell = ((high - low) / side as f64).max(DVec2::splat(f64::MIN_POSITIVE));
            let mut grid = Self { low, cell, side, starts: Vec::new(), entries: Vec::new() };
            let total: usize = triangles.iter().map(|&t| grid.cell_count(t)).sum();
            // long triangles would fill many fine cells
            if side == 1 || total <= 16 * triangles.len() + 1000 {
                grid.fill(triangles, total);
                return grid;
            }
            side /= 2;
        }
    }

    fn fill(&mut self, triangles: &[[DVec3; 3]], total: usize) {
        let mut starts = vec![0usize; self.side * self.side + 1];
        for &t in triangles {
            self.cells(t).for_each(|cell| starts[cell + 1] += 1);
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut entries = vec![0u32; total];
        for (index, &t) in (0u32..).zip(triangles) {
            for cell in self.cells(t) {
                entries[next[cell]] = index;
                next[cell] += 1;
            }
        }
        (self.starts, self.entries) = (starts, entries);
    }

    fn column(&self, p: DVec2) -> [usize; 2] {
        let place = (p - self.low) / self.cell;
        // a cast of a float saturates
        [place.x, place.y].map(|x| (x as usize).min(self.side - 1))
    }

    /// The lowest and the highest cell that the bounds of a triangle meet, along x and y.
    fn cell_range(&self, corners: [DVec3; 3]) -> [[usize; 2]; 2] {
        let [a, b, c] = corners.map(|p| p.truncate());
        [self.column(a.min(b).min(c)), self.column(a.max(b).max(c))]
    }

    fn cell_count(&self, corners: [DVec3; 3]) -> usize {
        let [from, to] = self.cell_range(corners);
        (to[0] - from[0] + 1) * (to[1] - from[1] + 1)
    }

    /// The cells that the bounds of a triangle meet.
    fn cells(&self, corners: [DVec3; 3]) -> impl Iterator<Item = usize> + use<> {
        let [from, to] = self.cell_range(corners);
        let side = self.side;
        (from[1]..=to[1]).flat_map(move |y| (from[0]..=to[0]).map(move |x| y * side + x))
    }

    /// The triangles that may be above or below a point.
    fn at(&self, foot: DVec2) -> &[u32] {
        let [x, y] = self.column(foot);
        let cell = y * self.side + x;
        &self.entries[self.starts[cell]..self.starts[cell + 1]]
    }
}
