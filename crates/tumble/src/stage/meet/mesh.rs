//! Particles near the mesh of another body: how long their list holds, and where they touch.

use glam::{DMat3, DVec3};

use super::list::{Pair, Point};
use super::pose::Pose;
use crate::distance::Patch;
use crate::state::PairOrder;
use crate::{BodyModel, SignedDistance};

/// Of a point: nothing is known of the mesh near it.
pub(super) const NO_PATCH: u32 = u32::MAX;
/// How much farther than is needed particles are listed: the list holds the longer.
const ROOM: f64 = 2.0;
/// Points that are passed over together.
pub(super) const BLOCK: usize = 16;

/// What is known of meshes and the particles near them.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// Of points that were looked at.
    patches: Vec<Patch>,
    /// Of pairs, in their order.
    listings: Vec<Listing>,
    /// Of blocks of points, pair by pair: no contact until then on the clock of the pair (m).
    quiet: Vec<f64>,
}

/// What is known of the particles of a body near the mesh of another. It has a clock: the way that particles have come against the mesh.
#[derive(Clone, Copy, Debug)]
struct Listing {
    key: PairOrder,
    /// How the bodies lay when they were listed.
    view: View,
    /// Particles that were no farther away than this and their reach are listed (m).
    margin: f64,
    /// How the bodies lay last.
    latest: View,
    /// How far both together had travelled then (m).
    travel: f64,
    /// No particle had come farther against the mesh by then (m).
    clock: f64,
    /// No contact until then on that clock (m).
    quiet: f64,
    /// Its blocks of points, as a range.
    blocks: [u32; 2],
}

/// How the particles of a body lie in the frame of another.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub turn: DMat3,
    pub way: DVec3,
    /// How far the farthest particle is from the centre of mass (m).
    extent: f64,
    /// What rounding may do to places (m).
    rounding: f64,
}

impl View {
    pub fn of(body: &BodyModel, pose: &Pose, other: &Pose) -> Self {
        let back = other.rotation.transpose();
        let size = pose.position.length() + other.position.length() + body.extent;
        Self {
            turn: back * pose.rotation,
            way: back * (pose.position - other.position),
            extent: body.extent,
            rounding: 16.0 * f64::EPSILON * size,
        }
    }

    /// How far a particle may have come between two views (m).
    fn travel(&self, before: &Self) -> f64 {
        let turn = self.turn - before.turn;
        let [x, y, z] = [turn.x_axis, turn.y_axis, turn.z_axis].map(DVec3::length_squared);
        let way = (self.way - before.way).length() + (x + y + z).sqrt() * self.extent;
        way * (1.0 + 1e-9) + self.rounding + before.rounding
    }
}

impl Known {
    pub fn clear(&mut self) {
        self.patches.clear();
        self.listings.clear();
        self.quiet.clear();
    }

    /// How far (m) beyond their reach the particles of a pair must be listed anew; none where those of the list before will do, which holds
    /// all of up to `margin` (m).
    pub fn list(&mut self, before: &Self, key: PairOrder, view: &View, margin: f64) -> Option<f64> {
        let start = self.quiet.len() as u32;
        let found = before.listings.binary_search_by_key(&key, |listing| listing.key);
        let Some(old) = found.ok().map(|found| before.listings[found]) else {
            let (view, margin) = (*view, ROOM * margin);
            self.listings.push(Listing {
                key,
                view,
                margin,
                latest: view,
                travel: f64::NEG_INFINITY,
                clock: 0.0,
                quiet: 0.0,
                blocks: [start, start],
            });
            return Some(margin);
        };
        if view.travel(&old.view) + margin <= old.margin {
            let [from, to] = old.blocks.map(|block| block as usize);
            self.quiet.extend_from_slice(&before.quiet[from..to]);
            self.listings.push(Listing { blocks: [start, self.quiet.len() as u32], ..old });
            return None;
        }
        let margin = ROOM * margin;
        let blocks = [start, start];
        self.listings.push(Listing { view: *view, margin, quiet: 0.0, blocks, ..old });
        Some(margin)
    }

    /// Adds blocks for so many points to the latest listing; returns its number.
    pub fn finish(&mut self, points: usize) -> u32 {
        let Some(listing) = self.listings.last_mut() else { return 0 };
        listing.blocks[1] += points.div_ceil(BLOCK) as u32;
        self.quiet.resize(listing.blocks[1] as usize, 0.0);
        self.listings.len() as u32 - 1
    }

    /// What the clock of a pair says for a view of it, when both bodies have travelled so far together, and until when it is quiet (m).
    pub fn time(&mut self, listing: u32, view: &View, travel: f64) -> (f64, f64) {
        let listing = &mut self.listings[listing as usize];
        // what both have in common does not count
        let way = view.travel(&listing.latest).min(travel - listing.travel);
        listing.clock = (listing.clock + way) * (1.0 + 4.0 * f64::EPSILON);
        (listing.latest, listing.travel) = (*view, travel);
        (listing.clock, listing.quiet)
    }

    /// Until when a block of points of a pair is quiet (m).
    pub fn of_block(&mut self, listing: u32, block: usize) -> &mut f64 {
        &mut self.quiet[self.listings[listing as usize].blocks[0] as usize + block]
    }

    /// Until when a pair is quiet (m).
    pub fn of_pair(&mut self, listing: u32) -> &mut f64 {
        &mut self.listings[listing as usize].quiet
    }

    /// A point of the list before, with what is known of it.
    pub fn carry(&mut self, before: &Self, point: &Point) -> Point {
        let patch = before.patches.get(point.other as usize);
        Point { other: patch.map_or(NO_PATCH, |&patch| self.add(patch)), ..*point }
    }

    fn add(&mut self, patch: Patch) -> u32 {
        self.patches.push(patch);
        self.patches.len() as u32 - 1
    }

    fn of(&mut self, point: &mut Point) -> &mut Patch {
        if point.other == NO_PATCH {
            point.other = self.add(Patch::NONE);
        }
        &mut self.patches[point.other as usize]
    }
}

/// How a particle is held against a mesh.
pub(super) struct Look<'a> {
    pub pair: &'a Pair,
    pub known: &'a mut Known,
    /// Whether a particle that surely does not touch needs its distance all the same.
    pub exact: bool,
    /// How far beyond its reach it is looked for (m).
    pub margin: f64,
}

impl Look<'_> {
    /// Where a particle is that touches the mesh of a body, the direction out of that, and how deep (m); or how far it is from there
    /// (m), or less.
    pub fn touch_mesh(
        &mut self,
        point: &mut Point,
        (body, pose): (&BodyModel, &Pose),
        (other, other_pose): (&BodyModel, &Pose),
    ) -> Result<(DVec3, DVec3, f64), f64> {
        let pair = self.pair;
        let Some(solid) = &other.solid else { return Err(self.margin) };
        let place = pose.place(body, point.particle);
        let inward = other_pose.rotation.transpose() * (place - other_pose.position);
        if !self.exact
            && let Some(gap) = self.gap(solid, point, inward)
        {
            return Err(gap);
        }
        let patch = self.known.of(point);
        let nearest = solid.query_near(inward, patch, pair.reach + self.margin);
        let Some(nearest) = nearest else { return Err(self.margin) };
        let depth = pair.reach - nearest.distance;
        if depth <= 0.0 {
            return Err(-depth);
        }
        let out = other_pose.rotation * nearest.gradient;
        Ok((place, out, depth))
    }

    /// A distance (m) by which a particle is surely too far away to touch.
    #[inline(always)]
    fn gap(&self, solid: &SignedDistance, point: &Point, place: DVec3) -> Option<f64> {
        let reach = self.pair.reach;
        // both may have come far, and yet not against each other
        if let Some(patch) = self.known.patches.get(point.other as usize) {
            let gap = patch.at_least(place) - reach;
            if gap > 0.0 {
                return Some(gap);
            }
            // what touched the moment before will again
            if point.quiet == 0.0 {
                return None;
            }
        }
        let gap = solid.at_least(place) - reach;
        (gap > 0.0).then_some(gap)
    }
}

#[cfg(test)]
mod tests;
