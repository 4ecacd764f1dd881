//! Collects points in lanes of eight; full lanes become contacts with forces.

use fearless_simd::Simd;
use glam::DVec3;

use super::pair_poses::{PairPoses, PointGeometry};
use crate::PairSpring;
use crate::contact::chunk_contacts::{Candidate, ChunkContacts};
use crate::contact::contact_lanes::{ContactLanes, NO_SPRING};
use crate::contact::context::ContactContext;
use crate::contact::friction_history::FrictionHistory;
use crate::contact::pair::{ListedContact, Pair};
use crate::contact::pair_forces::{PairForces, PairLosses, PairWrench};
use crate::contact::patch_damping::{NO_PATCH, PairPatch};
use crate::contact::tunnelling::TunnellingRisk;
use crate::lanes::{LANES, set};

/// Fills lanes with points, and takes full lanes through geometry, friction and forces.
pub(super) struct LaneFiller<'a> {
    pub context: &'a ContactContext<'a>,
    pub contacts: &'a mut ChunkContacts,
    pub history: FrictionHistory<'a>,
    /// Number of lanes in use.
    count: usize,
    /// For each lane, the sum of the path lengths of both bodies (m).
    path: [f64; LANES],
    /// For each lane, how far the bodies may move relative to each other in a step (m).
    step_displacement: [f64; LANES],
    /// For each lane, up to which gap it is a contact (m).
    reach: [f64; LANES],
}

impl<'a> LaneFiller<'a> {
    pub fn new(
        contacts: &'a mut ChunkContacts,
        context: &'a ContactContext<'a>,
        history: FrictionHistory<'a>,
    ) -> Self {
        let zero = [0.0; LANES];
        let (path, step_displacement, reach) = (zero, zero, zero);
        Self { context, contacts, history, count: 0, path, step_displacement, reach }
    }

    /// Starts a pair; returns its index in [`ChunkContacts::pairs`].
    #[inline(always)]
    pub fn begin_pair<const PREDICT: bool>(&mut self, index: usize, pair: &Pair) -> u32 {
        let patch = self.patch(pair);
        self.contacts.pairs.push(PairForces {
            list_index: index as u32,
            first: pair.first,
            patch,
            wrench: PairWrench::default(),
            couple: DVec3::ZERO,
        });
        if !PREDICT {
            self.contacts.losses.push(PairLosses::default());
        }
        self.contacts.pairs.len() as u32 - 1
    }

    /// The index of the patch of a pair; the pairs of one patch follow each other.
    fn patch(&mut self, pair: &Pair) -> u32 {
        if !pair.law.depends_on_patch() {
            return NO_PATCH;
        }
        let patches = &mut self.contacts.patches;
        if !patches.last().is_some_and(|patch| patch.includes(pair)) {
            patches.push(PairPatch::new(pair));
        }
        patches.len() as u32 - 1
    }

    /// Adds a point of a pair; returns whether all lanes are full.
    #[inline(always)]
    pub fn push(
        &mut self,
        poses: &PairPoses,
        pair: &Pair,
        candidate: Candidate,
        geometry: PointGeometry,
        point: &ListedContact,
    ) -> bool {
        let lane = self.count;
        let ChunkContacts { lanes, lanes_used, input, pairs, .. } = &mut *self.contacts;
        if lanes.len() == *lanes_used {
            lanes.push(ContactLanes::default());
        }
        let lanes = &mut lanes[*lanes_used];
        (self.path[lane], self.reach[lane]) = (poses.path, poses.reach);
        // tunnelling through meshes is judged by their relative path, in `point_mesh`
        self.step_displacement[lane] =
            if pair.is_point_mesh() { 0.0 } else { poses.step_displacement };
        lanes.pair[lane] = candidate.pair;
        lanes.point[lane] = candidate.point;
        if lane == 0 {
            (lanes.has_friction, lanes.has_surface_velocity) = (false, false);
            lanes.has_patch = false;
        }
        poses.write_law(pair, point, lane, lanes);
        let mut couple = geometry.couple;
        if !self.context.is_solved && couple != DVec3::ZERO {
            couple *= lanes.stiffness[lane];
            pairs[candidate.pair as usize].add_couple(couple);
        }
        set(&mut lanes.couple, lane, couple);
        lanes.stiffness[lane] *= geometry.weight;
        lanes.damping[lane] *= geometry.weight;
        poses.write_input(geometry, lane, input);
        self.count = lane + 1;
        self.count == LANES
    }

    /// Computes geometry and friction springs of the lanes in use, and the forces of all lanes whose patches are complete.
    #[inline(always)]
    pub fn flush<S: Simd, const PREDICT: bool>(
        &mut self,
        simd: S,
        pairs: &mut [Pair],
        points: &mut [ListedContact],
    ) {
        let count = std::mem::take(&mut self.count);
        if count == 0 {
            return;
        }
        let ContactContext { poses, since_kick, .. } = *self.context;
        let ChunkContacts { lanes, lanes_used, input, .. } = &mut *self.contacts;
        let current = &mut lanes[*lanes_used];
        current.count = count;
        current.compute_geometry(simd, input);
        for lane in 0..count {
            self.finish_lane(lane, pairs, points);
        }
        let ChunkContacts { lanes, lanes_used, input, pairs: forces, patches, .. } =
            &mut *self.contacts;
        let current = &mut lanes[*lanes_used];
        *lanes_used += 1;
        current.depth[count..].fill(0.0);
        current.gap[count..].fill(f64::INFINITY);
        if current.has_friction {
            current.advance_friction(simd, input, poses, &since_kick);
        }
        if self.context.is_solved {
            return;
        }
        if current.has_patch {
            current.add_to_patches(simd, forces, patches);
        }
        self.evaluate::<S, PREDICT>(simd, pairs, false);
    }

    /// Computes the forces of the lanes whose patches are complete: of all but those of the latest patch, or with `is_last` of all.
    #[inline(always)]
    pub fn evaluate<S: Simd, const PREDICT: bool>(
        &mut self,
        simd: S,
        pairs: &[Pair],
        is_last: bool,
    ) {
        let ContactContext { model, poses, .. } = *self.context;
        let open = if is_last { NO_PATCH } else { self.contacts.last_patch() };
        while self.contacts.lanes_evaluated < self.contacts.lanes_used {
            let index = self.contacts.lanes_evaluated;
            let ChunkContacts { lanes, pairs: forces, patches, losses, .. } = &mut *self.contacts;
            let current = &mut lanes[index];
            if current.has_patch {
                let last = forces[current.pair[current.count - 1] as usize].patch;
                if open != NO_PATCH && last == open {
                    break;
                }
                current.add_patch_damping::<PREDICT>(self.context, forces, patches);
            }
            current.add_forces::<S, PREDICT>(simd, poses, forces, losses, model.dt);
            if !PREDICT {
                self.contacts.store_springs(index, pairs);
            }
            self.contacts.lanes_evaluated += 1;
        }
    }

    /// Writes the gap of a lane back to the neighbour list, and finds the spring that its contact had.
    #[inline(always)]
    fn finish_lane(&mut self, lane: usize, pairs: &mut [Pair], points: &mut [ListedContact]) {
        let ChunkContacts { lanes, lanes_used, pairs: forces, losses, pair_index, input, .. } =
            &mut *self.contacts;
        let lanes = &mut lanes[*lanes_used];
        let index = forces[lanes.pair[lane] as usize].list_index as usize;
        let (pair, point) = (&mut pairs[index], &mut points[lanes.point[lane] as usize]);
        let (path, step_displacement) = (self.path[lane], self.step_displacement[lane]);
        input.has_spring[lane] = 0.0;
        if self.context.is_solved {
            let gap = -lanes.depth[lane];
            lanes.gap[lane] = if gap < self.reach[lane] { gap } else { f64::INFINITY };
            lanes.spring[lane] = NO_SPRING;
            if gap < self.reach[lane]
                && let Some(stretch) = self.history.take(&lanes.spring_key(lane, pair))
            {
                lanes.set_old_stretch(lane, stretch);
                lanes.spring[lane] = self.history.last_taken();
                input.has_spring[lane] = 1.0;
            }
        }
        if lanes.depth[lane] > 0.0 {
            point.clear_until = 0.0;
            pair_index[index] = lanes.pair[lane];
            if self.context.is_solved
                && let Some(losses) = losses.get_mut(lanes.pair[lane] as usize)
            {
                losses.max_depth = losses.max_depth.max(lanes.depth[lane]);
            }
            if lanes.friction[lane] > 0.0 && !self.context.is_solved {
                let key: PairSpring = lanes.spring_key(lane, pair);
                if let Some(stretch) = self.history.take(&key) {
                    lanes.set_old_stretch(lane, stretch);
                    input.has_spring[lane] = 1.0;
                }
            }
        } else {
            // that of a point and a mesh is a relative path, and set already
            if !pair.is_point_mesh() {
                point.clear_until = path - lanes.depth[lane];
            }
            lanes.depth[lane] = 0.0;
        }
        // `point_mesh` sets the value of its pairs as a whole
        if !pair.is_point_mesh() {
            pair.clear_until = pair.clear_until.min(point.clear_until);
        }
        if step_displacement > pair.tunnelling_limit && path + step_displacement > point.clear_until
        {
            let model = self.context.model;
            let risk = TunnellingRisk::new(model, index, pair, point, step_displacement);
            self.contacts.record(risk);
        }
    }
}
