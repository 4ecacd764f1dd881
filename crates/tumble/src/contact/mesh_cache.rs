//! The cache of point–mesh pairs: what stays valid from one narrow phase, or neighbour list, to the next.
//!
//! Each pair has a relative path: an upper bound on how far any particle of the one body has moved in the frame of the mesh of the
//! other. A particle found at a distance cannot touch before the relative path has grown by that distance; motion that both
//! bodies share does not count.

use glam::{DMat3, DVec3};

use super::pair::ListedContact;
use super::pose::BodyPose;
use crate::BodyModel;
use crate::distance::Patch;
use crate::state::PairOrder;

/// Index of a point without a cached patch.
pub(super) const NO_PATCH: u32 = u32::MAX;
/// Particles are listed up to this factor times the margin that is needed, so that the list holds for longer.
const MARGIN_FACTOR: f64 = 2.0;
/// Number of points that are skipped together.
pub(super) const BLOCK: usize = 16;

/// The caches of the point–mesh pairs of one chunk.
#[derive(Clone, Debug, Default)]
pub(super) struct MeshCache {
    /// The part of a mesh near a point, for points that were queried.
    patches: Vec<Patch>,
    /// One entry per pair, in the order of pairs.
    pairs: Vec<PairCache>,
    /// For blocks of points, pair by pair: no contact until the relative path of the pair is this long (m).
    block_clear_until: Vec<f64>,
}

/// What is known about the particles of one body near the mesh of another.
#[derive(Clone, Copy, Debug)]
struct PairCache {
    order: PairOrder,
    /// Relative pose when the particles were listed.
    listed_pose: RelativePose,
    /// All particles within this margin beyond the contact distance are listed (m).
    margin: f64,
    /// Relative pose at the latest narrow phase.
    latest_pose: RelativePose,
    /// Sum of the path lengths of both bodies at that time (m).
    latest_path: f64,
    /// Relative path: no particle has moved farther in the frame of the mesh (m).
    relative_path: f64,
    /// No contact until the relative path is this long (m).
    clear_until: f64,
    /// Its blocks of points, as a range.
    blocks: [u32; 2],
}

/// Pose of a body in the frame of another.
#[derive(Clone, Copy, Debug)]
pub(super) struct RelativePose {
    pub rotation: DMat3,
    pub translation: DVec3,
    /// Distance of the farthest particle from the centre of mass (m).
    extent: f64,
    /// Bound on the rounding error of positions (m).
    rounding: f64,
}

impl RelativePose {
    pub fn new(body: &BodyModel, pose: &BodyPose, frame: &BodyPose) -> Self {
        let inverse = frame.rotation.transpose();
        let size = pose.position.length() + frame.position.length() + body.extent;
        Self {
            rotation: inverse * pose.rotation,
            translation: inverse * (pose.position - frame.position),
            extent: body.extent,
            rounding: 16.0 * f64::EPSILON * size,
        }
    }

    /// An upper bound on how far any particle has moved since an earlier relative pose (m).
    fn max_displacement(&self, before: &Self) -> f64 {
        let turn = self.rotation - before.rotation;
        let [x, y, z] = [turn.x_axis, turn.y_axis, turn.z_axis].map(DVec3::length_squared);
        let translation = (self.translation - before.translation).length();
        let displacement = translation + (x + y + z).sqrt() * self.extent;
        displacement * (1.0 + 1e-9) + self.rounding + before.rounding
    }
}

impl MeshCache {
    pub fn clear(&mut self) {
        self.patches.clear();
        self.pairs.clear();
        self.block_clear_until.clear();
    }

    /// Adds a pair. Returns the margin beyond the contact distance (m) up to which its particles must be listed, or `None` where
    /// the list in `before` still holds all particles up to `margin`.
    pub fn add_pair(
        &mut self,
        before: &Self,
        order: PairOrder,
        pose: &RelativePose,
        margin: f64,
    ) -> Option<f64> {
        let start = self.block_clear_until.len() as u32;
        let found = before.pairs.binary_search_by_key(&order, |pair| pair.order);
        let Some(old) = found.ok().map(|found| before.pairs[found]) else {
            let (pose, margin) = (*pose, MARGIN_FACTOR * margin);
            self.pairs.push(PairCache {
                order,
                listed_pose: pose,
                margin,
                latest_pose: pose,
                latest_path: f64::NEG_INFINITY,
                relative_path: 0.0,
                clear_until: 0.0,
                blocks: [start, start],
            });
            return Some(margin);
        };
        if pose.max_displacement(&old.listed_pose) + margin <= old.margin {
            let [from, to] = old.blocks.map(|block| block as usize);
            self.block_clear_until.extend_from_slice(&before.block_clear_until[from..to]);
            let blocks = [start, self.block_clear_until.len() as u32];
            self.pairs.push(PairCache { blocks, ..old });
            return None;
        }
        let margin = MARGIN_FACTOR * margin;
        let (listed_pose, blocks) = (*pose, [start, start]);
        self.pairs.push(PairCache { listed_pose, margin, clear_until: 0.0, blocks, ..old });
        Some(margin)
    }

    /// Adds blocks for `point_count` points to the latest pair; returns the index of the pair.
    pub fn finish_pair(&mut self, point_count: usize) -> u32 {
        let Some(pair) = self.pairs.last_mut() else { return 0 };
        pair.blocks[1] += point_count.div_ceil(BLOCK) as u32;
        self.block_clear_until.resize(pair.blocks[1] as usize, 0.0);
        self.pairs.len() as u32 - 1
    }

    /// Advances the relative path of a pair to a relative pose at which the path lengths of both bodies add up to `path`. Returns
    /// the relative path, and up to which relative path there is no contact (m).
    pub fn advance(&mut self, pair: u32, pose: &RelativePose, path: f64) -> (f64, f64) {
        let pair = &mut self.pairs[pair as usize];
        let displacement = pose.max_displacement(&pair.latest_pose).min(path - pair.latest_path);
        pair.relative_path = (pair.relative_path + displacement) * (1.0 + 4.0 * f64::EPSILON);
        (pair.latest_pose, pair.latest_path) = (*pose, path);
        (pair.relative_path, pair.clear_until)
    }

    /// Relative path up to which a block of points of a pair has no contact (m).
    pub fn block_clear_until(&mut self, pair: u32, block: usize) -> &mut f64 {
        &mut self.block_clear_until[self.pairs[pair as usize].blocks[0] as usize + block]
    }

    /// Relative path up to which a pair has no contact (m).
    pub fn pair_clear_until(&mut self, pair: u32) -> &mut f64 {
        &mut self.pairs[pair as usize].clear_until
    }

    /// Copies a point of the list before, with its patch.
    pub fn copy_point(&mut self, before: &Self, point: &ListedContact) -> ListedContact {
        let patch = before.patch(point);
        ListedContact { other: patch.map_or(NO_PATCH, |&patch| self.add_patch(patch)), ..*point }
    }

    /// The patch of a point, if it has one.
    #[inline(always)]
    pub fn patch(&self, point: &ListedContact) -> Option<&Patch> {
        self.patches.get(point.other as usize)
    }

    /// The patch of a point; an empty one where it has none yet.
    pub fn patch_mut(&mut self, point: &mut ListedContact) -> &mut Patch {
        if point.other == NO_PATCH {
            point.other = self.add_patch(Patch::NONE);
        }
        &mut self.patches[point.other as usize]
    }

    fn add_patch(&mut self, patch: Patch) -> u32 {
        self.patches.push(patch);
        self.patches.len() as u32 - 1
    }
}

#[cfg(test)]
mod tests;
