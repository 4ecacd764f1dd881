//! Pairs as they are found, and in the order of their numbers.

use super::Ball;
use super::overlap::{Sphere, overlaps};

/// Pairs a < b as they are found.
#[derive(Clone, Debug, Default)]
pub(super) struct FoundPairs {
    /// Those beyond `count` are room.
    pairs: Vec<[u32; 2]>,
    count: usize,
}

impl FoundPairs {
    /// Forgets all, keeps the room.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Keeps those of the candidates that are hits. Every candidate is written, hits move on: a branch here is
    /// guessed wrong as often as a ball has a partner, which costs more than all the rest.
    #[inline(always)]
    pub(super) fn keep(
        &mut self,
        candidates: impl ExactSizeIterator<Item = (bool, u32)>,
        number: u32,
    ) {
        let end = self.count + candidates.len();
        if self.pairs.len() < end {
            self.pairs.resize(end.next_power_of_two(), [0; 2]);
        }
        let slots = &mut self.pairs[self.count..end];
        let mut count = 0;
        for (hit, other) in candidates {
            slots[count] = [number.min(other), number.max(other)];
            count += usize::from(hit);
        }
        self.count += count;
    }

    /// What was found.
    fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs[..self.count]
    }
}

/// The sorted pairs, and room to sort them.
#[derive(Clone, Debug, Default)]
pub(super) struct Order {
    pairs: Vec<[u32; 2]>,
    /// First numbers of the pairs, in the order of their second.
    firsts: Vec<u32>,
    /// Where the pairs of each first number go, and of each second.
    first_starts: Vec<u32>,
    second_starts: Vec<u32>,
}

impl Order {
    /// Tests every ball against every other.
    pub(super) fn each_with_each(&mut self, balls: &[Ball]) -> &[[u32; 2]] {
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

    /// Sorts what was found among so many balls: a counting sort by the second number, then one by the first,
    /// which keeps the order of the second.
    pub(super) fn gather<'a>(
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
        let total = add_up(first_starts);
        add_up(second_starts);
        firsts.resize(total, 0);
        for found in found {
            for [a, b] in found {
                let start = &mut second_starts[*b as usize];
                firsts[*start as usize] = *a;
                *start += 1;
            }
        }
        pairs.resize(total, [0; 2]);
        // by now, each start of a second number is its end
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
fn add_up(counts: &mut [u32]) -> usize {
    let mut total = 0;
    for count in counts {
        (*count, total) = (total, total + *count);
    }
    total as usize
}
