//! The contacts of one chunk of bodies, and their forces.

use fearless_simd::Simd;
use glam::DVec3;

use super::contact_lanes::{ContactLanes, LaneInput};
use super::deep_contact::{DeepContact, WARNING_DEPTH};
use super::neighbour_list::ChunkNeighbours;
use super::pair::Pair;
use super::pair_forces::{PairForces, PairLosses};
use super::patch_damping::{NO_PATCH, PairPatch};
use super::pose::BodyPose;
use super::tunnelling::TunnellingRisk;
use crate::PairSpring;
use crate::lanes::vector;

/// The contacts of the bodies of one chunk, as first bodies of pairs.
#[derive(Clone, Debug, Default)]
pub(crate) struct ChunkContacts {
    /// The points that were examined, pair by pair. Entries from `lanes_used` on are spare.
    pub(super) lanes: Vec<ContactLanes>,
    pub(super) lanes_used: usize,
    /// How many of them have been evaluated.
    pub(super) lanes_evaluated: usize,
    /// Sums over the contacts of the pairs whose dashpots depend on them.
    pub(super) patches: Vec<PairPatch>,
    /// The pairs of these points, with their forces.
    pub(super) pairs: Vec<PairForces>,
    /// Losses of the same pairs, after the latest full evaluation.
    pub(super) losses: Vec<PairLosses>,
    /// For each pair of the neighbour list, its index in `pairs`, or [`NO_CONTACT`].
    pub(super) pair_index: Vec<u32>,
    /// Energy (J) of the springs of contacts that have ended, by body of the chunk.
    pub(super) released: Vec<f64>,
    /// The friction springs after the latest evaluation.
    pub(super) springs: Vec<PairSpring>,
    /// Contacts so deep that bodies may soon pass through each other, after the latest full evaluation.
    pub(super) deep_contacts: Vec<DeepContact>,
    /// The first pair whose bodies could pass through each other within a step.
    pub(super) tunnelling_risk: Option<TunnellingRisk>,
    /// Buffer for points that may touch.
    pub(super) candidates: Vec<Candidate>,
    /// Buffer for the input of eight contacts.
    pub(super) input: LaneInput,
}

/// Marks a pair of the neighbour list without contact.
pub(super) const NO_CONTACT: u32 = u32::MAX;

/// Buffers for the contacts of a chunk and their springs.
pub(super) type ContactBuffers = (Vec<ContactLanes>, Vec<PairSpring>);

/// A point that may touch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Candidate {
    /// Index of its pair in [`ChunkContacts::pairs`].
    pub pair: u32,
    /// Index of the point in the neighbour list.
    pub point: u32,
}

impl ChunkContacts {
    /// Forgets all contacts; `pair_count` pairs are in the neighbour list.
    pub(super) fn clear(&mut self, pair_count: usize) {
        (self.lanes_used, self.lanes_evaluated) = (0, 0);
        self.patches.clear();
        self.springs.clear();
        self.pairs.clear();
        self.losses.clear();
        self.pair_index.clear();
        self.pair_index.resize(pair_count, NO_CONTACT);
        self.tunnelling_risk = None;
        self.deep_contacts.clear();
    }

    /// Lists the pairs whose deepest contact exceeds a part of their tunnelling limit; after a full evaluation.
    #[inline(always)]
    pub(super) fn find_deep_contacts(&mut self, pairs: &[Pair]) {
        let is_deep = |forces: &PairForces, losses: &PairLosses| {
            losses.max_depth > WARNING_DEPTH * pairs[forces.list_index as usize].tunnelling_limit
        };
        if self.pairs.iter().zip(&self.losses).any(|(forces, losses)| is_deep(forces, losses)) {
            self.list_deep_contacts(pairs, is_deep);
        }
    }

    #[cold]
    fn list_deep_contacts(
        &mut self,
        pairs: &[Pair],
        is_deep: impl Fn(&PairForces, &PairLosses) -> bool,
    ) {
        let mut latest = None;
        for lanes in &self.lanes[..self.lanes_used] {
            for lane in lanes.in_contact() {
                let index = lanes.pair[lane];
                let forces = &self.pairs[index as usize];
                let losses = &self.losses[index as usize];
                if !is_deep(forces, losses) {
                    continue;
                }
                // the contacts of a pair follow each other
                if latest != Some(index) {
                    latest = Some(index);
                    self.deep_contacts.push(DeepContact::new(&pairs[forces.list_index as usize]));
                }
                if let Some(deep) = self.deep_contacts.last_mut() {
                    deep.add(lanes, lane);
                }
            }
        }
    }

    /// Evaluates the forces of all contacts again, at the velocities of `poses`, and stores the springs.
    #[inline(always)]
    pub(super) fn evaluate_again<S: Simd>(
        &mut self,
        simd: S,
        neighbours: &ChunkNeighbours,
        poses: &[BodyPose],
    ) {
        for pair in &mut self.pairs {
            pair.clear();
        }
        self.losses.clear();
        self.losses.resize(self.pairs.len(), PairLosses::default());
        self.springs.clear();
        for index in 0..self.lanes_used {
            let Self { lanes, pairs, losses, .. } = self;
            lanes[index].add_forces::<S, false>(simd, poses, pairs, losses, 0.0);
            self.store_springs(index, &neighbours.pairs);
        }
        self.find_deep_contacts(&neighbours.pairs);
    }

    /// Stores the springs of eight contacts after their evaluation.
    #[inline(always)]
    pub(super) fn store_springs(&mut self, index: usize, pairs: &[Pair]) {
        let lanes = &self.lanes[index];
        for lane in lanes.in_contact().filter(|&lane| lanes.friction[lane] > 0.0) {
            let pair = self.pairs[lanes.pair[lane] as usize].list_index;
            let mut spring = lanes.spring_key(lane, &pairs[pair as usize]);
            spring.stretch = lanes.kept_stretch(lane);
            self.springs.push(spring);
        }
    }

    /// The patch of the latest contact, which further contacts may belong to, or [`NO_PATCH`].
    pub(super) fn last_patch(&self) -> u32 {
        let last = self.lanes[..self.lanes_used].last();
        last.map_or(NO_PATCH, |lanes| self.pairs[lanes.pair[lanes.count - 1] as usize].patch)
    }

    /// Takes buffers from `spare` where this chunk has none.
    pub(super) fn take_buffers(&mut self, spare: &mut Vec<ContactBuffers>) {
        if self.lanes.is_empty()
            && let Some(buffers) = spare.pop()
        {
            (self.lanes, self.springs) = buffers;
        }
    }

    /// Gives up the contacts and springs, which are no longer needed, as buffers for another chunk.
    pub(super) fn release_buffers(&mut self) -> ContactBuffers {
        self.lanes_used = 0;
        (std::mem::take(&mut self.lanes), std::mem::take(&mut self.springs))
    }

    /// Energy in the springs (J); `is_solved` as in [`ContactContext`](super::context::ContactContext).
    pub(super) fn elastic_energy(&self, is_solved: bool) -> f64 {
        if is_solved {
            let contacts = self.lanes[..self.lanes_used].iter().flat_map(|lanes| {
                lanes.within_reach().map(|lane| lanes.elastic_energy_within_reach(lane))
            });
            return contacts.sum::<f64>() + self.released.iter().sum::<f64>();
        }
        // the sum runs contact by contact: which lane a contact is in depends on the lists
        let contacts = self.lanes[..self.lanes_used]
            .iter()
            .flat_map(|lanes| lanes.in_contact().map(move |lane| (lanes, lane)));
        let stored: f64 = contacts.map(|(lanes, lane)| lanes.elastic_energy(lane)).sum();
        // the springs of contacts that have ended are released at the next kick
        stored + self.released.iter().sum::<f64>()
    }

    /// Calls `visit` with the pair, the normal and the depth (m) of each contact.
    pub(super) fn for_each_contact(
        &self,
        neighbours: &ChunkNeighbours,
        mut visit: impl FnMut(&Pair, DVec3, f64),
    ) {
        for lanes in &self.lanes[..self.lanes_used] {
            for lane in lanes.in_contact() {
                let pair = self.pairs[lanes.pair[lane] as usize].list_index;
                let normal = vector(&lanes.normal, lane);
                visit(&neighbours.pairs[pair as usize], normal, lanes.depth[lane]);
            }
        }
    }

    /// Records a risk of tunnelling, if its pair comes before that of the one on record.
    pub(super) fn record(&mut self, risk: TunnellingRisk) {
        if self.tunnelling_risk.is_none_or(|recorded| risk.pair < recorded.pair) {
            self.tunnelling_risk = Some(risk);
        }
    }
}
