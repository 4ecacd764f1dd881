//! Broad phase: which bounding balls overlap, by a hierarchical grid.
//!
//! Balls are sorted into levels by radius, one level for each factor of two. The cells of a level are wider than the diameter
//! of its largest ball ([`level`]), so all partners of a ball at its own level are in its cell and the 26 cells around it. It
//! visits one half of these; the other half finds the ball. Each ball also searches every coarser level, where it covers at most
//! three cells along each axis. A large drum among gravel costs each grain one search, whatever the ratio of sizes.
//!
//! Pairs are sorted by the indices of their balls ([`order`]), so the result is the same for any number of threads.

mod level;
mod order;
mod overlap;
mod sizes;
#[cfg(test)]
mod tests;

use glam::DVec3;
use rayon::prelude::*;

use level::{Level, Range};
use order::{FoundPairs, Order};
use sizes::Sizes;

/// Up to this number of balls, every pair is tested: faster than any grid.
const BRUTE_FORCE_COUNT: usize = 32;

/// Number of balls of one level in a task; it does not depend on the number of threads.
const BALLS_PER_TASK: usize = 256;

/// A ball around a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ball {
    /// Centre (m), finite.
    pub centre: DVec3,
    /// Radius (m), finite and not negative: of the body and its skin.
    pub radius: f64,
    /// Whether forces move the body; two inactive balls are no pair.
    pub active: bool,
}

/// Finds pairs of balls that overlap. It keeps buffers between calls, and nothing that changes a result.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    sizes: Sizes,
    /// Coarsest first; entries from `level_count` on are spare buffers.
    levels: Vec<Level>,
    level_count: usize,
    /// Entries from `chunk_count` on are spare buffers.
    chunks: Vec<Chunk>,
    chunk_count: usize,
    order: Order,
}

/// Some balls of a level, consecutive in the order of its cells.
#[derive(Clone, Debug, Default)]
struct Chunk {
    level: usize,
    balls: std::ops::Range<usize>,
    ranges: Vec<Range>,
    pairs: FoundPairs,
}

impl Grid {
    /// All pairs a < b of balls with |x_a − x_b| ≤ r_a + r_b, not both inactive, sorted. Pairs that miss each other
    /// by less than 10⁻¹² of r_a + r_b may be among them, so that rounding loses none. At most 2³² balls.
    pub(super) fn pairs(&mut self, balls: &[Ball]) -> &[[u32; 2]] {
        if balls.len() <= BRUTE_FORCE_COUNT {
            return self.order.brute_force(balls);
        }
        self.insert(balls);
        self.divide();
        self.search();
        let found = self.chunks[..self.chunk_count].iter().map(|chunk| &chunk.pairs);
        self.order.sort(found, balls.len())
    }

    /// Inserts every ball into the level of its size.
    fn insert(&mut self, balls: &[Ball]) {
        self.level_count = self.sizes.sort(balls);
        if self.levels.len() < self.level_count {
            self.levels.resize_with(self.level_count, Level::default);
        }
        for (index, level) in self.levels[..self.level_count].iter_mut().enumerate() {
            level.insert(balls, self.sizes.of_level(index));
        }
    }

    /// Divides the levels into chunks.
    fn divide(&mut self) {
        self.chunk_count = 0;
        for (level, balls) in self.levels[..self.level_count].iter().enumerate() {
            for start in (0..balls.len()).step_by(BALLS_PER_TASK) {
                if self.chunks.len() == self.chunk_count {
                    self.chunks.push(Chunk::default());
                }
                let chunk = &mut self.chunks[self.chunk_count];
                chunk.level = level;
                chunk.balls = start..balls.len().min(start + BALLS_PER_TASK);
                self.chunk_count += 1;
            }
        }
    }

    /// Finds the pairs of every chunk.
    fn search(&mut self) {
        let levels = &self.levels[..self.level_count];
        self.chunks[..self.chunk_count].par_iter_mut().for_each(|chunk| chunk.search(levels));
    }
}

impl Chunk {
    /// Finds the pairs of these balls with later balls of their level and with the balls of coarser levels.
    fn search(&mut self, levels: &[Level]) {
        let Self { level, balls, ranges, pairs } = self;
        pairs.clear();
        let own = &levels[*level];
        own.search_same_level(balls.clone(), ranges, pairs);
        for coarser in &levels[..*level] {
            coarser.search_from_finer(own, balls.clone(), ranges, pairs);
        }
    }
}
