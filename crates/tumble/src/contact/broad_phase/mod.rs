//! Which balls overlap: the broad phase, on a grid for each size of ball.
//!
//! Balls are sorted into levels by their radius, a factor of two each, and every level has cells wider than two of its
//! largest balls ([`level`]). So a ball finds all partners of its own level in its own cell and the 26 around it, of
//! which it visits one half: the other half finds it. Each ball also looks into every coarser level, where its radius
//! and the level's largest cover at most three cells an axis; finer levels find it. A drum among gravel costs each
//! grain one look, whatever the ratio of their sizes.
//!
//! Pairs come in the order of their numbers ([`order`]), so the result is the same for any number of threads.

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

/// Up to so many balls, each is tested against each: quicker than any grid.
const FEW: usize = 32;

/// Balls of one level that one task looks after: a fixed number, whatever the number of threads.
const CHUNK: usize = 256;

/// A ball around a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ball {
    /// Centre (m), finite.
    pub centre: DVec3,
    /// Radius (m), finite and not negative: of the body and of whatever skin it wears.
    pub radius: f64,
    /// Whether it can be pushed: of two balls that cannot, no pair is wanted.
    pub active: bool,
}

/// Finds pairs of balls that overlap. What it keeps between calls is room, nothing that changes a result.
#[derive(Clone, Debug, Default)]
pub(super) struct Grid {
    sizes: Sizes,
    /// Coarsest first; those beyond `level_count` only keep their room.
    levels: Vec<Level>,
    level_count: usize,
    /// Those beyond `chunk_count` only keep their room.
    chunks: Vec<Chunk>,
    chunk_count: usize,
    order: Order,
}

/// Some balls of a level, neighbours in the order of its cells.
#[derive(Clone, Debug, Default)]
struct Chunk {
    level: usize,
    balls: std::ops::Range<usize>,
    ranges: Vec<Range>,
    found: FoundPairs,
}

impl Grid {
    /// All pairs a < b of balls with |x_a − x_b| ≤ r_a + r_b, not both inactive, sorted. Pairs that miss each other
    /// by less than 10⁻¹² of r_a + r_b may be among them, so that rounding loses none. At most 2³² balls.
    pub(super) fn pairs(&mut self, balls: &[Ball]) -> &[[u32; 2]] {
        if balls.len() <= FEW {
            return self.order.each_with_each(balls);
        }
        self.file(balls);
        self.cut();
        self.look();
        let found = self.chunks[..self.chunk_count].iter().map(|chunk| &chunk.found);
        self.order.gather(found, balls.len())
    }

    /// Files every ball at the level of its size.
    fn file(&mut self, balls: &[Ball]) {
        self.level_count = self.sizes.sort(balls);
        if self.levels.len() < self.level_count {
            self.levels.resize_with(self.level_count, Level::default);
        }
        for (index, level) in self.levels[..self.level_count].iter_mut().enumerate() {
            level.file(balls, self.sizes.of_level(index));
        }
    }

    /// Cuts the levels into chunks.
    fn cut(&mut self) {
        self.chunk_count = 0;
        for (level, filed) in self.levels[..self.level_count].iter().enumerate() {
            for start in (0..filed.len()).step_by(CHUNK) {
                if self.chunks.len() == self.chunk_count {
                    self.chunks.push(Chunk::default());
                }
                let chunk = &mut self.chunks[self.chunk_count];
                chunk.level = level;
                chunk.balls = start..filed.len().min(start + CHUNK);
                self.chunk_count += 1;
            }
        }
    }

    /// Finds the pairs of every chunk.
    fn look(&mut self) {
        let levels = &self.levels[..self.level_count];
        self.chunks[..self.chunk_count].par_iter_mut().for_each(|chunk| chunk.look(levels));
    }
}

impl Chunk {
    /// All pairs of these balls with balls behind them at their level and with those of coarser levels.
    fn look(&mut self, levels: &[Level]) {
        let Self { level, balls, ranges, found } = self;
        found.clear();
        let own = &levels[*level];
        own.look_around(balls.clone(), ranges, found);
        for coarser in &levels[..*level] {
            coarser.look_up(own, balls.clone(), ranges, found);
        }
    }
}
