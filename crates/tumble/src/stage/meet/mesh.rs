//! Particles near the mesh of another body: how long their list holds, and where they touch.

use glam::{DMat3, DVec3};

use super::list::{Pair, Point};
use super::pose::Pose;
use crate::BodyModel;
use crate::distance::Patch;
use crate::state::PairOrder;

/// Of a point: nothing is known of the mesh near it.
pub(super) const NO_PATCH: u32 = u32::MAX;
/// How much farther than is needed particles are listed: the list holds the longer.
const ROOM: f64 = 3.0;

/// What is known of meshes and the particles near them.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// Of points that were looked at.
    patches: Vec<Patch>,
    /// Of pairs, in their order.
    listings: Vec<Listing>,
}

/// How two bodies lay when the particles of one near the mesh of the other were listed.
#[derive(Clone, Copy, Debug)]
struct Listing {
    key: PairOrder,
    view: View,
    /// Particles that were no farther away than this and their reach are listed (m).
    margin: f64,
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
    }

    /// How far (m) beyond their reach the particles of a pair must be listed anew; none where those of the list before will do, which holds
    /// all of up to `margin` (m).
    pub fn list(
        &mut self,
        before: &Self,
        key: PairOrder,
        view: &View,
        margin: f64,
    ) -> Option<f64> {
        let found = before.listings.binary_search_by_key(&key, |listing| listing.key);
        let listing = found.ok().map(|found| before.listings[found]);
        if let Some(listing) = listing
            && view.travel(&listing.view) + margin <= listing.margin
        {
            self.listings.push(listing);
            return None;
        }
        let listing = Listing { key, view: *view, margin: ROOM * margin };
        self.listings.push(listing);
        Some(listing.margin)
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
}

impl Look<'_> {
    /// Where a particle touches the mesh of a body, the direction out of that, and how deep (m); or how far it is from there (m), or
    /// less.
    pub fn touch_mesh(
        &mut self,
        point: &mut Point,
        (body, pose): (&BodyModel, &Pose),
        (other, other_pose): (&BodyModel, &Pose),
    ) -> Result<(DVec3, DVec3, f64), f64> {
        let pair = self.pair;
        let Some(solid) = &other.solid else { return Err(pair.margin) };
        let place = pose.place(body, point.particle);
        let inward = other_pose.rotation.transpose() * (place - other_pose.position);
        // a glance is often enough
        let gap = solid.at_least(inward) - pair.reach;
        if gap > 0.0 && !self.exact {
            return Err(gap);
        }
        let patch = self.known.of(point);
        // both may have come far, and yet not against each other
        let gap = patch.at_least(inward) - pair.reach;
        if gap > 0.0 && !self.exact {
            return Err(gap);
        }
        let nearest = solid.query_near(inward, patch, pair.reach + pair.margin);
        let Some(nearest) = nearest else { return Err(pair.margin) };
        let depth = pair.reach - nearest.distance;
        if depth <= 0.0 {
            return Err(-depth);
        }
        let out = other_pose.rotation * nearest.gradient;
        Ok((place - out * pair.reach, out, depth))
    }
}
