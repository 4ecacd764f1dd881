//! The search of the tree for the triangle closest to a point.

use fearless_simd::{Level, Simd, dispatch, f64x4, prelude::*};
use glam::DVec3;

use super::tree::{LEAF, STACK_SIZE, Tree};
use super::triangle::WIDTH;

/// Factor on squared distances that allows for rounding in comparisons with the distance to a box.
const CLOSE: f64 = 1.0 + 1e-12;
/// The largest distance at which the neighbourhood of the closest triangle is searched, in units of its width.
const FAR: f64 = 3.0;
/// The number of groups in a patch.
pub(super) const PATCH_GROUPS: usize = 4;
/// Marks the absence of a group.
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
pub(super) struct Neighbourhood {
    /// Squared distances (m²) and indices of the closest groups, in ascending order.
    pub groups: [(f64, u32); PATCH_GROUPS],
    /// A lower bound on the squared distance of all other groups (m²).
    pub others: f64,
}

/// A kind of query.
pub(super) trait Query {
    /// The squared distance (m²) beyond which nothing has to be visited.
    fn limit(&self) -> f64;
    /// Visits a group, given the squared distances of its triangles.
    fn visit(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree);
    /// Whether a child of a node can be left out.
    #[inline(always)]
    fn leaves_out(&self, _node: u32, _lane: usize) -> bool {
        false
    }
    /// Notes that groups at this squared distance (m²) or beyond are skipped.
    #[inline(always)]
    fn skip(&mut self, _squared: f64) {}
}

/// Finds the closest triangle.
pub(super) struct NearestQuery {
    slot: usize,
    index: u32,
    pub squared: f64,
    limit: f64,
}

/// Finds any triangle within a distance.
struct AnyQuery {
    /// Negative once a triangle is found (m²).
    limit: f64,
    /// The group of that triangle.
    group: u32,
}

/// Finds the closest triangle and its neighbourhood.
struct NeighbourhoodQuery {
    nearest: NearestQuery,
    /// How much farther than the closest triangle the neighbourhood extends (m).
    width: f64,
    limit: f64,
    neighbourhood: Neighbourhood,
}

impl NearestQuery {
    #[inline(always)]
    pub fn new(most: f64) -> Self {
        // finite, so that missing boxes, which are at infinity, are farther
        let most = most.min(0.5 * f64::MAX);
        Self { slot: usize::MAX, index: u32::MAX, squared: most, limit: most * CLOSE }
    }

    pub fn found(&self) -> Option<Closest> {
        (self.slot != usize::MAX).then_some(Closest { slot: self.slot, squared: self.squared })
    }
}

impl Query for NearestQuery {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.limit
    }

    #[inline(always)]
    fn visit(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree) {
        // most groups have nothing closer: compare only the minimum
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

impl Query for NeighbourhoodQuery {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.limit
    }

    #[inline(always)]
    fn visit(&mut self, group: u32, squared: &[f64; WIDTH], tree: &Tree) {
        let least = least(squared);
        if least <= self.nearest.squared {
            self.nearest.visit(group, squared, tree);
            let distance = self.nearest.squared.sqrt();
            // far away, too much of the surface is at nearly the same distance
            let farther =
                if distance <= FAR * self.width { distance + self.width } else { distance };
            self.limit = farther * farther * CLOSE;
        }
        self.neighbourhood.insert(least, group);
    }

    #[inline(always)]
    fn skip(&mut self, squared: f64) {
        self.neighbourhood.others = self.neighbourhood.others.min(squared);
    }
}

impl Query for AnyQuery {
    #[inline(always)]
    fn limit(&self) -> f64 {
        self.limit
    }

    #[inline(always)]
    fn visit(&mut self, group: u32, squared: &[f64; WIDTH], _: &Tree) {
        if least(squared) <= self.limit {
            self.group = group;
            self.limit = -1.0;
        }
    }
}

impl Neighbourhood {
    /// Inserts a group in order; the farthest becomes one of the others.
    #[inline(always)]
    fn insert(&mut self, squared: f64, group: u32) {
        let mut inserted = (squared, group);
        for entry in &mut self.groups {
            if inserted.0 < entry.0 {
                std::mem::swap(entry, &mut inserted);
            }
        }
        self.others = self.others.min(inserted.0);
    }
}

#[inline(always)]
fn least([a, b, c, d]: &[f64; WIDTH]) -> f64 {
    a.min(*b).min(c.min(*d))
}

impl Tree {
    /// The triangle closest to a point, the one with the lowest index if several are equally close; `None` if all are
    /// farther than the root of `most` (m²). The group of slot `hint` is visited first.
    pub fn nearest(
        &self,
        level: Level,
        point: DVec3,
        most: f64,
        hint: Option<usize>,
    ) -> Option<Closest> {
        let hint = hint.map_or(NO_GROUP, |slot| (slot / WIDTH) as u32);
        let mut query = NearestQuery::new(most);
        dispatch!(level, simd => self.search(simd, point, hint, &mut query));
        query.found()
    }

    /// Runs a query. Group `hint` is visited first.
    pub fn run(&self, level: Level, point: DVec3, hint: u32, query: &mut impl Query) {
        dispatch!(level, simd => self.search(simd, point, hint, query));
    }

    /// As [`Self::nearest`], with the groups up to `width` (m) farther away. Group `hint` is visited first.
    pub fn nearest_with_neighbourhood(
        &self,
        level: Level,
        point: DVec3,
        most: f64,
        hint: u32,
        width: f64,
    ) -> (Option<Closest>, Neighbourhood) {
        let nearest = NearestQuery::new(most);
        let neighbourhood = Neighbourhood {
            groups: [(f64::INFINITY, NO_GROUP); PATCH_GROUPS],
            others: f64::INFINITY,
        };
        let mut query = NeighbourhoodQuery { limit: nearest.limit, nearest, width, neighbourhood };
        dispatch!(level, simd => self.search(simd, point, hint, &mut query));
        (query.nearest.found(), query.neighbourhood)
    }

    /// As [`Self::nearest`], among the triangles of these groups.
    pub fn nearest_of(&self, level: Level, point: DVec3, groups: &[u32]) -> Option<Closest> {
        let mut query = NearestQuery::new(f64::INFINITY);
        dispatch!(level, simd => self.visit_groups(simd, point, groups, &mut query));
        query.found()
    }

    /// A group with a triangle no farther from a point than the root of `most` (m²). Group `hint` is visited first.
    pub fn any_within(&self, level: Level, point: DVec3, most: f64, hint: u32) -> Option<u32> {
        let mut any = AnyQuery { limit: most.min(0.5 * f64::MAX), group: NO_GROUP };
        dispatch!(level, simd => self.search(simd, point, hint, &mut any));
        (any.group != NO_GROUP).then_some(any.group)
    }

    #[inline(always)]
    fn visit_groups<S: Simd>(
        &self,
        simd: S,
        point: DVec3,
        groups: &[u32],
        query: &mut NearestQuery,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let point = point.to_array().map(|x| f64x4::splat(simd, x));
                for &number in groups {
                    if let Some(group) = self.groups.get(number as usize) {
                        query.visit(number, &group.squared(simd, point), self);
                    }
                }
            },
        );
    }

    #[inline(always)]
    fn search<S: Simd>(&self, simd: S, point: DVec3, hint: u32, query: &mut impl Query) {
        simd.vectorize(
            #[inline(always)]
            || {
                let point = point.to_array().map(|x| f64x4::splat(simd, x));
                if let Some(group) = self.groups.get(hint as usize) {
                    query.visit(hint, &group.squared(simd, point), self);
                }
                let mut stack = [(0.0, 0u32); STACK_SIZE];
                let mut count = 1;
                while count > 0 {
                    count -= 1;
                    let (squared, child) = stack[count];
                    if squared > query.limit() {
                        query.skip(squared);
                        continue;
                    }
                    if child & LEAF != 0 {
                        let group = child & !LEAF;
                        if hint != group {
                            let squared = self.groups[group as usize].squared(simd, point);
                            query.visit(group, &squared, self);
                        }
                        continue;
                    }
                    let node = &self.nodes[child as usize];
                    let squared = node.squared(simd, point);
                    // push in order of descending distance, so that the nearest is popped first
                    let start = count;
                    let number = child;
                    for (lane, (&squared, &child)) in squared.iter().zip(&node.child).enumerate() {
                        if squared > query.limit() {
                            query.skip(squared);
                            continue;
                        }
                        if query.leaves_out(number, lane) {
                            continue;
                        }
                        let mut at = count;
                        while at > start && stack[at - 1].0 < squared {
                            stack[at] = stack[at - 1];
                            at -= 1;
                        }
                        stack[at] = (squared, child);
                        count += 1;
                    }
                }
            },
        );
    }
}
