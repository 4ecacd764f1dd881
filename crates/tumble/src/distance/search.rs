//! The search of the tree for the triangle closest to a point.

use fearless_simd::{Level, Simd, dispatch, f64x4, prelude::*};
use glam::DVec3;

use super::tree::{LEAF, Tree, WAITING};
use super::triangle::WIDTH;

/// By how much a squared distance may be larger than that to the box of the triangle, but for what [`super::tree`] adds to boxes.
const CLOSE: f64 = 1.0 + 1e-12;
/// Up to this distance more than the closest triangle is looked for, in units of how much farther that is.
const FAR: f64 = 3.0;
/// Groups that are remembered.
pub(super) const KEPT: usize = 4;
/// No group.
pub(super) const NO_GROUP: u32 = u32::MAX;

/// The closest triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closest {
    pub slot: usize,
    /// The squared distance (m²).
    pub squared: f64,
}

/// The closest groups.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around {
    /// Their squared distances (m²), and which they are, the closest first.
    pub groups: [(f64, u32); KEPT],
    /// All other groups are at least as far away (squared, m²).
    pub others: f64,
}

/// What a search looks for.
trait Looking {
    /// What is farther than the root of this (m²) need not be looked at.
    fn limit(&self) -> f64;
    /// A group that is looked at.
    fn look_at(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree);
    /// Groups that are not, since they are at least this far away (squared, m²).
    #[inline(always)]
    fn leave_out(&mut self, _squared: f64) {}
}

/// The closest so far.
struct Best {
    slot: usize,
    index: u32,
    squared: f64,
    limit: f64,
}

/// Whether anything is close enough.
struct Any {
    /// Less than zero once something is (m²).
    limit: f64,
    /// Which group.
    group: u32,
}

/// The closest so far, and what else is close.
struct Wide {
    best: Best,
    /// How much farther than the closest is looked (m).
    wider: f64,
    limit: f64,
    around: Around,
}

impl Best {
    #[inline(always)]
    fn new(most: f64) -> Self {
        // boxes that are missing are at infinity, and farther than this
        let most = most.min(0.5 * f64::MAX);
        Self { slot: usize::MAX, index: u32::MAX, squared: most, limit: most * CLOSE }
    }

    fn found(&self) -> Option<Closest> {
        (self.slot != usize::MAX).then_some(Closest { slot: self.slot, squared: self.squared })
    }
}

impl Looking for Best {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.limit
    }

    #[inline(always)]
    fn look_at(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree) {
        // most groups have nothing closer: one comparison for all
        if least(squared) > self.squared {
            return;
        }
        for (lane, &squared) in squared.iter().enumerate() {
            if squared > self.squared {
                continue;
            }
            let index = tree.groups[group as usize].index[lane];
            if squared < self.squared || index < self.index {
                self.slot = group as usize * WIDTH + lane;
                self.index = index;
                self.squared = squared;
                self.limit = squared * CLOSE;
            }
        }
    }
}

impl Looking for Wide {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.limit
    }

    #[inline(always)]
    fn look_at(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree) {
        let least = least(squared);
        if least <= self.best.squared {
            self.best.look_at(group, squared, tree);
            let distance = self.best.squared.sqrt();
            // from afar too much of the surface is about as close
            let farther =
                if distance <= FAR * self.wider { distance + self.wider } else { distance };
            self.limit = farther * farther * CLOSE;
        }
        self.around.add(least, group);
    }

    #[inline(always)]
    fn leave_out(&mut self, squared: f64) {
        self.around.others = self.around.others.min(squared);
    }
}

impl Looking for Any {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.limit
    }

    #[inline(always)]
    fn look_at(&mut self, group: u32, squared: &[f64; WIDTH], _: &Tree) {
        if least(squared) <= self.limit {
            self.group = group;
            self.limit = -1.0;
        }
    }
}

impl Around {
    /// Takes a group in its place; the farthest becomes one of the others.
    #[inline(always)]
    fn add(&mut self, squared: f64, group: u32) {
        let mut given = (squared, group);
        for kept in &mut self.groups {
            if given.0 < kept.0 {
                std::mem::swap(kept, &mut given);
            }
        }
        self.others = self.others.min(given.0);
    }
}

#[inline(always)]
fn least([a, b, c, d]: &[f64; WIDTH]) -> f64 {
    a.min(*b).min(c.min(*d))
}

impl Tree {
    /// The triangle closest to a point, of equally close ones that with the lowest index; none if all are
    /// farther than the root of `most` (m²). The group of slot `hint` is looked at first.
    pub fn nearest(
        &self,
        level: Level,
        point: DVec3,
        most: f64,
        hint: Option<usize>,
    ) -> Option<Closest> {
        let hint = hint.map_or(NO_GROUP, |slot| (slot / WIDTH) as u32);
        let mut best = Best::new(most);
        dispatch!(level, simd => self.search(simd, point, hint, &mut best));
        best.found()
    }

    /// As [`Self::nearest`], with the groups that are up to `wider` (m) farther away than that. Group `hint` is looked at first.
    pub fn nearest_around(
        &self,
        level: Level,
        point: DVec3,
        most: f64,
        hint: u32,
        wider: f64,
    ) -> (Option<Closest>, Around) {
        let best = Best::new(most);
        let around = Around { groups: [(f64::INFINITY, NO_GROUP); KEPT], others: f64::INFINITY };
        let mut wide = Wide { limit: best.limit, best, wider, around };
        dispatch!(level, simd => self.search(simd, point, hint, &mut wide));
        (wide.best.found(), wide.around)
    }

    /// As [`Self::nearest`] among the triangles of some groups.
    pub fn nearest_of(&self, level: Level, point: DVec3, groups: &[u32]) -> Option<Closest> {
        let mut best = Best::new(f64::INFINITY);
        dispatch!(level, simd => self.look_at(simd, point, groups, &mut best));
        best.found()
    }

    /// A group of which a triangle is no farther from a point than the root of `most` (m²). Group `hint` is looked at first.
    pub fn any_within(&self, level: Level, point: DVec3, most: f64, hint: u32) -> Option<u32> {
        let mut any = Any { limit: most.min(0.5 * f64::MAX), group: NO_GROUP };
        dispatch!(level, simd => self.search(simd, point, hint, &mut any));
        (any.group != NO_GROUP).then_some(any.group)
    }

    #[inline(always)]
    fn look_at<S: Simd>(&self, simd: S, point: DVec3, groups: &[u32], best: &mut Best) {
        simd.vectorize(
            #[inline(always)]
            || {
                let point = point.to_array().map(|x| f64x4::splat(simd, x));
                for &number in groups {
                    if let Some(group) = self.groups.get(number as usize) {
                        best.look_at(number, &group.squared(simd, point), self);
                    }
                }
            },
        );
    }

    #[inline(always)]
    fn search<S: Simd>(&self, simd: S, point: DVec3, hint: u32, looking: &mut impl Looking) {
        simd.vectorize(
            #[inline(always)]
            || {
                let point = point.to_array().map(|x| f64x4::splat(simd, x));
                if let Some(group) = self.groups.get(hint as usize) {
                    looking.look_at(hint, &group.squared(simd, point), self);
                }
                let mut waiting = [(0.0, 0u32); WAITING];
                let mut count = 1;
                while count > 0 {
                    count -= 1;
                    let (squared, child) = waiting[count];
                    if squared > looking.limit() {
                        looking.leave_out(squared);
                        continue;
                    }
                    if child & LEAF != 0 {
                        let group = child & !LEAF;
                        if hint != group {
                            let squared = self.groups[group as usize].squared(simd, point);
                            looking.look_at(group, &squared, self);
                        }
                        continue;
                    }
                    let node = &self.nodes[child as usize];
                    let squared = node.squared(simd, point);
                    // the nearest goes on top
                    let start = count;
                    for (&squared, &child) in squared.iter().zip(&node.child) {
                        if squared > looking.limit() {
                            looking.leave_out(squared);
                            continue;
                        }
                        let mut at = count;
                        while at > start && waiting[at - 1].0 < squared {
                            waiting[at] = waiting[at - 1];
                            at -= 1;
                        }
                        waiting[at] = (squared, child);
                        count += 1;
                    }
                }
            },
        );
    }
}
