//! Pairs as they are found, and sorted by index.

use super::Ball;
use super::overlap::{Sphere, overlaps};

/// Pairs a < b as they are found.
#[derive(Clone, Debug, Default)]
pub(super) struct FoundPairs {
    /// Entries from `count` on are spare.
    pairs: Vec<[u32; 2]>,
    count: usize,
}

impl FoundPairs {
    /// Removes all pairs and keeps the buffer.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds the candidates that are hits, as pairs with ball `index`. Every candidate is written and only hits advance the end:
    /// a branch would be mispredicted about once per overlapping pair, which costs more than all the rest.
    #[inline(always)]
    pub(super) fn add_hits(
        &mut self,
        candidates: impl ExactSizeIterator<Item = (bool, u32)>,
        index: u32,
    ) {
        let end = self.count + candidates.len();
        if self.pairs.len() < end {
            self.pairs.resize(end.next_power_of_two(), [0; 2]);
        }
        let slots = &mut self.pairs[self.count..end];
        let mut count = 0;
        for (hit, other) in candidates {
            slots[count] = [index.min(other), index.max(other)];
            count += usize::from(hit);
        }
        self.count += count;
    }

    /// The pairs.
    fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs[..self.count]
    }
}

/// The sorted pairs, with buffers to sort them.
#[derive(Clone, Debug, Default)]
pub(super) struct Order {
    pairs: Vec<[u32; 2]>,
    /// First indices of the pairs, sorted by second index.
    firsts: Vec<u32>,
    /// Where the pairs of each first index go, and those of each second index.
    first_starts: Vec<u32>,
    second_starts: Vec<u32>,
}

impl Order {
    /// Tests every pair of balls.
    pub(super) fn brute_force(&mut self, balls: &[Ball]) -> &[[u32; 2]] {
        self.pairs.clear();
        let sphere = |ball: &Ball| Sphere { centre: ball.centre, radius: ball.radius };
        for (a, ball) in balls.iter().enumerate() {
            for (b, other) in balls.iter().enumerate().skip(a + 1) {
                if (ball.active || other.active) && overlaps(&sphere(ball), &sphere(other)) {
                    self.pairs.push([a as u32, b as u32]);
                }
            }
        }
        &self.pairs
    }

    /// Sorts the pairs found among `ball_count` balls: a counting sort by the second index, then a stable one by the first.
    pub(super) fn sort<'a>(
        &mut self,
        found: impl Iterator<Item = &'a FoundPairs> + Clone,
        ball_count: usize,
    ) -> &[[u32; 2]] {
        let Self { pairs, firsts, first_starts, second_starts } = self;
        for starts in [&mut *first_starts, &mut *second_starts] {
            starts.clear();
            starts.resize(ball_count, 0);
        }
        let found = found.map(FoundPairs::pairs);
        for [a, b] in found.clone().flatten() {
            first_starts[*a as usize] += 1;
            second_starts[*b as usize] += 1;
        }
        let total = prefix_sum(first_starts);
        prefix_sum(second_starts);
        firsts.resize(total, 0);
        for found in found {
            for [a, b] in found {
                let start = &mut second_starts[*b as usize];
                firsts[*start as usize] = *a;
                *start += 1;
            }
        }
        pairs.resize(total, [0; 2]);
        // by now the start of each second index has advanced to its end
        let mut from = 0;
        for (b, to) in (0..).zip(&*second_starts) {
            for a in &firsts[from..*to as usize] {
                let start = &mut first_starts[*a as usize];
                pairs[*start as usize] = [*a, b];
                *start += 1;
            }
            from = *to as usize;
        }
        pairs
    }
}

/// Turns counts into starts; returns the sum.
fn prefix_sum(counts: &mut [u32]) -> usize {
    let mut total = 0;
    for count in counts {
        (*count, total) = (total, total + *count);
    }
    total as usize
}
