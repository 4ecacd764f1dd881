//! The pipeline for contact between bodies, chunk by chunk.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::chunk_contacts::{ChunkContacts, ContactBuffers};
use super::context::ContactContext;
use super::deep_contact::{DeepContact, WARNING_DEPTH};
use super::gather::{self, ContactResults};
use super::narrow_phase;
use super::neighbour_list::{ChunkNeighbours, NeighbourLists};
use super::pair::Pair;
use super::pose::BodyPose;
use super::since_kick::SinceKick;
use super::solver::{Found, Outcome, Solver};
use super::tunnelling::TunnellingRisk;
use crate::joint::JointWork;
use crate::parallel::{self, CHUNK};
use crate::{BodyForces, BodyState, ContactKind, Integrator, Model, PairSpring, State};

/// Contacts between bodies, and of spheres with walls. Dropping it between steps changes no result.
#[derive(Clone, Debug, Default)]
pub(crate) struct BodyContacts {
    poses: Vec<BodyPose>,
    lists: NeighbourLists,
    /// Contacts, one entry per chunk of bodies.
    contacts: Vec<ChunkContacts>,
    /// Buffers that no chunk uses at present.
    spare: Vec<ContactBuffers>,
    /// Friction springs after this step, of the chunks that [`Self::predict_and_evaluate`] has finished; those of other chunks
    /// are still in `contacts`.
    springs: Vec<PairSpring>,
    /// The contact that was deepest so far, relative to what the bodies would have to pass through, if it was deep.
    deepest: Option<DeepContact>,
}

/// Contacts that are examined in a step only to keep the deepest one for a warning.
const MAX_RECORDED: usize = 4;

impl BodyContacts {
    /// Rebuilds the neighbour lists if a body has moved by its skin. The poses are those of `state` already.
    pub fn update_neighbour_lists(&mut self, model: &Model, state: &State, since_kick: &SinceKick) {
        let has_poses = self.poses.len() == model.bodies.len();
        // false for NaN
        let is_valid = |pose: &BodyPose| pose.path + pose.reach <= pose.list_valid_until;
        if has_poses && self.poses.iter().all(is_valid) {
            return;
        }
        // start afresh without poses, and after a state with numbers that were not finite
        if !has_poses || !self.poses.iter().all(|pose| pose.path.is_finite()) {
            self.poses.clear();
            let states = state.bodies.iter().enumerate();
            let pose = |(index, state)| BodyPose::new(model, index, state, since_kick);
            self.poses.extend(states.map(pose));
            (self.lists, self.contacts) = (NeighbourLists::default(), Vec::new());
        }
        self.lists.build(model, &mut self.poses);
    }

    /// Gives bodies with joints the velocities between two kicks; see [`gather::use_start_velocities`].
    pub fn use_start_velocities(&mut self, model: &Model, start: &[BodyState]) {
        if !model.joints.is_empty() {
            gather::use_start_velocities(model, 0, &mut self.poses, start);
        }
    }

    /// Lets the joints act on the velocities in the middle of the kick that the contact forces predict.
    pub fn predict_joined(&mut self, model: &Model, state: &State, joints: &mut JointWork) {
        let JointWork { kick, start_coordinates, start_rates, .. } = joints;
        kick.begin(model, state, [start_coordinates, start_rates], model.dt);
        kick.set_mean_twists(model, |body| {
            (self.poses[body].velocity, self.poses[body].angular_velocity)
        });
        kick.solve(model);
        for &body in &model.joints.bodies {
            if model.bodies[body as usize].is_free() {
                let pose = &mut self.poses[body as usize];
                (pose.velocity, pose.angular_velocity) = kick.mean_twist(body as usize);
            }
        }
    }

    /// Poses for [`gather::update_poses`], and results for [`gather::gather_forces`].
    pub fn poses_and_results(&mut self) -> (&mut [BodyPose], ContactResults<'_>) {
        let Self { poses, contacts, lists, .. } = self;
        (poses, ContactResults { contacts, lists })
    }

    /// The poses at the latest kick or query.
    pub fn poses(&self) -> &[BodyPose] {
        &self.poses
    }

    /// The contacts of the latest evaluation, chunk by chunk.
    pub(super) fn chunks(&self) -> &[ChunkContacts] {
        &self.contacts
    }

    /// The neighbour list of a chunk.
    pub(super) fn neighbours(&self, chunk: usize) -> &ChunkNeighbours {
        &self.lists.chunks[chunk]
    }

    /// Finds all contacts and computes their forces at the velocities of the poses, on all threads. With `PREDICT` the forces serve
    /// only to predict velocities; [`Self::evaluate_again`] must follow.
    pub fn evaluate<const PREDICT: bool>(
        &mut self,
        model: &Model,
        springs: &[PairSpring],
        since_kick: SinceKick,
    ) {
        self.springs.clear();
        let is_solved = model.integrator == Integrator::Implicit;
        let context = ContactContext { model, poses: &self.poses, springs, since_kick, is_solved };
        self.contacts.resize_with(self.lists.chunks.len(), ChunkContacts::default);
        let chunks = &mut self.lists.chunks;
        parallel::for_each_zipped(&mut self.contacts, chunks, |chunk, contacts, neighbours| {
            detect::<PREDICT>(&context, chunk, contacts, neighbours);
        });
    }

    /// Computes the forces of the same contacts at the velocities that the poses have now.
    pub fn evaluate_again(&mut self) {
        let (poses, chunks) = (&self.poses, &self.lists.chunks);
        parallel::for_each(&mut self.contacts, |chunk, contacts| {
            evaluate_again(poses, contacts, &chunks[chunk]);
        });
    }

    /// Both evaluations and the prediction between them, on one thread: each chunk is evaluated again as soon as the velocities
    /// of all its bodies are predicted, while its contacts are in the cache, and its buffers go on to the next chunk. `forces` are those of
    /// contact with walls.
    ///
    /// The second body of a pair is never in an earlier chunk than the first, so prediction in a chunk does not change what later
    /// chunks read.
    pub fn predict_and_evaluate(
        &mut self,
        model: &Model,
        springs: &[PairSpring],
        forces: &[BodyForces],
        since_kick: SinceKick,
    ) {
        let h = model.dt;
        self.contacts.resize_with(self.lists.chunks.len(), ChunkContacts::default);
        self.springs.clear();
        let mut finished = 0;
        for (chunk, forces) in forces.chunks(CHUNK).enumerate() {
            let poses = &self.poses;
            let context = ContactContext { model, poses, springs, since_kick, is_solved: false };
            let (neighbours, contacts) = (&mut self.lists.chunks[chunk], &mut self.contacts[chunk]);
            contacts.take_buffers(&mut self.spare);
            detect::<true>(&context, chunk, contacts, neighbours);
            let results = ContactResults { contacts: &self.contacts, lists: &self.lists };
            let first = chunk * CHUNK;
            let poses = &mut self.poses[first..first + forces.len()];
            gather::predict_velocities(model, first, poses, forces, results, h);
            while let Some(neighbours) = self.lists.chunks.get(finished)
                && neighbours.last_chunk <= chunk
            {
                let contacts = &mut self.contacts[finished];
                evaluate_again(&self.poses, contacts, neighbours);
                self.springs.extend_from_slice(&contacts.springs);
                self.spare.push(contacts.release_buffers());
                finished += 1;
            }
        }
    }

    /// Finds the contacts within reach, and applies the impulses of the implicit solution of their law to `state`.
    pub fn solve(
        &mut self,
        model: &Model,
        state: &mut State,
        (solver, joints): (&mut Solver, &mut JointWork),
        forces: &mut [BodyForces],
        since_kick: SinceKick,
    ) -> Outcome {
        self.update_neighbour_lists(model, state, &since_kick);
        self.use_start_velocities(model, &joints.start);
        self.evaluate::<false>(model, &state.pair_springs, since_kick);
        let Self { poses, contacts, lists, .. } = self;
        let found = Found { chunks: contacts, lists, poses, since_kick };
        solver.solve(model, &found, state, (forces, joints))
    }

    /// Moves the friction springs after the latest evaluation into the state; to be called once per step.
    pub fn store_friction_springs(&mut self, pair_springs: &mut Vec<PairSpring>) {
        for contacts in &mut self.contacts {
            self.springs.extend_from_slice(&contacts.springs);
        }
        std::mem::swap(pair_springs, &mut self.springs);
        self.springs.clear();
    }

    /// The first two bodies that could pass through each other within a step.
    pub fn tunnelling_risk(&self) -> Option<TunnellingRisk> {
        self.contacts.iter().find_map(|contacts| contacts.tunnelling_risk)
    }

    /// The first contact so deep that the bodies may pass through each other; keeps the deepest of the others. `time` is that of
    /// the state (s).
    pub fn check_depths(&mut self, model: &Model, time: f64) -> Option<DeepContact> {
        let Self { poses, contacts, deepest, .. } = self;
        let mut deep = contacts.iter().flat_map(|contacts| &contacts.deep_contacts);
        let mut unrecorded_left = MAX_RECORDED;
        deep.find_map(|contact| {
            let is_deeper = |than: &Option<DeepContact>, contact: &DeepContact| {
                contact.share() > than.map_or(WARNING_DEPTH, |deepest| deepest.share())
            };
            if contact.share() <= 0.5 {
                // only for the record, which is not worth much time: the limit is at least half of the passage
                if unrecorded_left == 0 || !is_deeper(deepest, contact) {
                    return None;
                }
                unrecorded_left -= 1;
            }
            // the limit of the pair is that of the thin parts of a mesh
            let contact = DeepContact { time, ..contact.with_local_limit(model, poses) };
            if is_deeper(deepest, &contact) {
                *deepest = Some(contact);
            }
            contact.is_too_deep().then_some(contact)
        })
    }

    /// The contact that was deepest so far, relative to what the bodies would have to pass through, if it was deep.
    pub fn deepest_contact(&self) -> Option<&DeepContact> {
        self.deepest.as_ref()
    }

    /// A copy of poses and neighbour lists, for queries about a state.
    pub fn for_query(&self) -> Self {
        Self { poses: self.poses.clone(), lists: self.lists.clone(), ..Self::default() }
    }

    /// Energy in the springs between bodies and between spheres and walls, normal and tangential (J).
    pub fn elastic_energy(&mut self, model: &Model, state: &State) -> f64 {
        if !model.has_body_contact {
            return 0.0;
        }
        // the tangential springs have stretched since the latest kick
        let since_kick = SinceKick::at_end_of_step(model, state);
        self.move_to(model, state, &since_kick);
        self.evaluate::<true>(model, &state.pair_springs, since_kick);
        let is_solved = model.integrator == Integrator::Implicit;
        self.contacts.iter().map(|contacts| contacts.elastic_energy(is_solved)).sum()
    }

    /// Calls `visit` with the pair, the normal and the depth (m) of each contact of a state.
    pub(super) fn for_each_contact(
        &mut self,
        model: &Model,
        state: &State,
        mut visit: impl FnMut(&Pair, DVec3, f64),
    ) {
        let since_kick = SinceKick::none(state.time);
        self.move_to(model, state, &since_kick);
        self.evaluate::<true>(model, &[], since_kick);
        for (contacts, neighbours) in self.contacts.iter().zip(&self.lists.chunks) {
            contacts.for_each_contact(neighbours, &mut visit);
        }
    }

    /// Penetration depths of the deepest contact between two bodies and of the deepest one between a sphere and a wall (m); 0 without contact.
    pub fn max_depths(&mut self, model: &Model, state: &State) -> [f64; 2] {
        let mut depths = [0.0f64; 2];
        if model.has_body_contact {
            self.for_each_contact(model, state, |pair, _, depth| {
                let deepest = &mut depths[usize::from(pair.kind == ContactKind::SphereWall)];
                *deepest = deepest.max(depth);
            });
        }
        depths
    }

    /// Moves the poses to a state, and rebuilds the lists if necessary.
    fn move_to(&mut self, model: &Model, state: &State, since_kick: &SinceKick) {
        if self.poses.len() == model.bodies.len() {
            gather::update_poses(model, 0, &mut self.poses, &state.bodies, since_kick);
        }
        self.update_neighbour_lists(model, state, since_kick);
    }
}

fn detect<const PREDICT: bool>(
    context: &ContactContext,
    chunk: usize,
    contacts: &mut ChunkContacts,
    neighbours: &mut ChunkNeighbours,
) {
    let first_body = chunk * CHUNK;
    dispatch!(Level::new(), simd => simd.vectorize(
        #[inline(always)]
        || narrow_phase::detect::<_, PREDICT>(simd, contacts, neighbours, context, first_body)
    ));
}

fn evaluate_again(poses: &[BodyPose], contacts: &mut ChunkContacts, neighbours: &ChunkNeighbours) {
    dispatch!(Level::new(), simd => simd.vectorize(
        #[inline(always)]
        || contacts.evaluate_again(simd, neighbours, poses)
    ));
}
