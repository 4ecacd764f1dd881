//! Which level a ball belongs to.

use super::Ball;

/// Size classes of radii: the exponent of the double and the first bits of its mantissa.
const CLASS_BITS: u32 = 2;
const CLASS_COUNT: usize = 2048 << CLASS_BITS;

/// The largest number of levels: each costs every finer ball a search. Sizes that span more than a factor of 2³² get levels for more
/// than a factor of two.
const MAX_LEVELS: usize = 32;

/// Balls by level, coarsest first.
#[derive(Clone, Debug, Default)]
pub(super) struct Sizes {
    /// One bit for each class that has a ball.
    classes: Vec<u64>,
    /// The level of each class that has a ball.
    level_of_class: Vec<u8>,
    /// Where each level starts in `order`, and the end.
    starts: Vec<u32>,
    /// Indices of the balls, level by level, ascending within each.
    order: Vec<u32>,
}

/// The size class of a radius; it never decreases where the radius increases.
fn class(radius: f64) -> usize {
    // adding zero makes a negative zero positive
    ((radius + 0.0).to_bits() >> (52 - CLASS_BITS)) as usize % CLASS_COUNT
}

impl Sizes {
    /// Sorts the balls by level; returns how many levels there are.
    pub(super) fn sort(&mut self, balls: &[Ball]) -> usize {
        self.classes.clear();
        self.classes.resize(CLASS_COUNT / 64, 0);
        self.level_of_class.resize(CLASS_COUNT, 0);
        for ball in balls {
            let class = class(ball.radius);
            self.classes[class / 64] |= 1 << (class % 64);
        }
        let mut octaves = 1;
        while self.make_levels(octaves) > MAX_LEVELS {
            octaves *= 2;
        }
        self.sort_by_level(balls);
        self.starts.len() - 1
    }

    /// The indices of the balls of a level, ascending.
    pub(super) fn of_level(&self, level: usize) -> &[u32] {
        &self.order[self.starts[level] as usize..self.starts[level + 1] as usize]
    }

    /// Assigns levels from the largest class down, each spanning `octaves` octaves of radius; returns how many.
    fn make_levels(&mut self, octaves: usize) -> usize {
        let width = octaves << CLASS_BITS;
        let (mut level_count, mut below) = (0, CLASS_COUNT);
        for (word, bits) in self.classes.iter().enumerate().rev() {
            let mut bits = *bits;
            while bits != 0 {
                let bit = bits.ilog2() as usize;
                bits ^= 1 << bit;
                let class = 64 * word + bit;
                if level_count == 0 || class < below {
                    level_count += 1;
                    below = (class + 1).saturating_sub(width);
                }
                // beyond MAX_LEVELS the value is not used
                self.level_of_class[class] = (level_count - 1) as u8;
            }
        }
        self.starts.clear();
        self.starts.resize(level_count + 1, 0);
        level_count
    }

    /// A counting sort, stable within a level.
    fn sort_by_level(&mut self, balls: &[Ball]) {
        self.order.resize(balls.len(), 0);
        if self.starts.len() == 2 {
            self.starts[1] = balls.len() as u32;
            self.order.iter_mut().zip(0..).for_each(|(slot, number)| *slot = number);
            return;
        }
        let level = |ball: &Ball| usize::from(self.level_of_class[class(ball.radius)]);
        let mut next = [0; MAX_LEVELS];
        balls.iter().for_each(|ball| next[level(ball)] += 1);
        let mut total = 0;
        for (next, start) in next.iter_mut().zip(&mut self.starts[..]) {
            (*start, *next, total) = (total, total, total + *next);
        }
        if let Some(end) = self.starts.last_mut() {
            *end = total;
        }
        for (number, ball) in (0..).zip(balls) {
            let next = &mut next[level(ball)];
            self.order[*next as usize] = number;
            *next += 1;
        }
    }
}
