//! The interface between batches of bodies and the contact pipeline: poses, predicted velocities, forces per body.

use super::chunk_contacts::{ChunkContacts, NO_CONTACT};
use super::neighbour_list::NeighbourLists;
use super::pair_forces::{PairForces, PairLosses};
use super::pose::BodyPose;
use super::since_kick::SinceKick;
use crate::kinematics::Kinematics;
use crate::parallel::CHUNK;
use crate::{BodyForces, BodyState, Model, Wrench};

/// The results of contact between bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactResults<'a> {
    pub(super) contacts: &'a [ChunkContacts],
    pub(super) lists: &'a NeighbourLists,
}

/// Moves the poses of the bodies from index `first` on to their states.
pub(crate) fn update_poses(
    model: &Model,
    first: usize,
    poses: &mut [BodyPose],
    bodies: &[BodyState],
    since_kick: &SinceKick,
) {
    for ((index, pose), state) in (first..).zip(poses).zip(bodies) {
        *pose = pose.moved(model, index, state, since_kick);
    }
}

/// Gives the bodies with joints from index `first` on the velocities between two kicks that they had at the beginning of the step, where
/// all bodies were as in `start`: a second order mean of those in the flight.
pub(crate) fn use_start_velocities(
    model: &Model,
    first: usize,
    poses: &mut [BodyPose],
    start: &[BodyState],
) {
    for (index, pose) in (first..).zip(poses) {
        if model.joints.acts_on(index) && model.bodies[index].is_free() {
            let kinematics = Kinematics::new(&model.bodies[index], &start[index]);
            pose.drift_velocity = kinematics.velocity;
            pose.drift_angular_velocity = kinematics.angular_velocity;
        }
    }
}

/// Sets the velocities in `poses`, of the bodies from index `first` on, to those in the middle of a kick by the predicted forces
/// over the time `h` (s). `forces` are those of contact with walls, predicted too.
pub(crate) fn predict_velocities(
    model: &Model,
    first: usize,
    poses: &mut [BodyPose],
    forces: &[BodyForces],
    results: ContactResults,
    h: f64,
) {
    let mut sums = BodySums::new(results, first);
    for ((index, pose), forces) in (first..).zip(poses).zip(forces) {
        let wrench = sums.next::<true>(index).total + forces.contact();
        let wrench = if forces.load == Wrench::default() { wrench } else { wrench + forces.load };
        let body = &model.bodies[index];
        if body.is_free() && wrench != Wrench::default() {
            pose.velocity += wrench.force * (0.5 * h / body.mass);
            let angular_acceleration = body.angular_velocity(pose.rotation, wrench.torque);
            pose.angular_velocity += angular_acceleration * (0.5 * h);
        }
    }
}

/// Adds the contact forces between bodies to `forces`, of the bodies from index `first` on.
pub(crate) fn gather_forces(results: ContactResults, first: usize, forces: &mut [BodyForces]) {
    let mut sums = BodySums::new(results, first);
    for (index, forces) in (first..).zip(forces) {
        let sum = sums.next::<false>(index);
        forces.spring += sum.total - sum.dashpot;
        forces.dashpot += sum.dashpot;
        forces.slip_loss += sum.slip;
        forces.surface_power = sum.surface_power;
        forces.surface_dashpot_power = sum.surface_dashpot_power;
        forces.max_depth = forces.max_depth.max(sum.max_depth);
    }
}

/// Sums over the contacts of one body. Slip and surface power are counted with the first body of a pair.
#[derive(Clone, Copy, Debug, Default)]
struct BodySum {
    /// Springs and dashpots.
    total: Wrench,
    /// Dashpots alone.
    dashpot: Wrench,
    /// Energy lost to slip (J).
    slip: f64,
    /// Power that surface velocities put in (W).
    surface_power: f64,
    /// The part of it that dashpots dissipate (W).
    surface_dashpot_power: f64,
    /// Depth of the deepest contact (m).
    max_depth: f64,
}

impl BodySum {
    fn add_as_first(&mut self, losses: &PairLosses) {
        self.dashpot += losses.dashpot.on_first();
        self.slip += losses.slip;
        self.surface_power += losses.surface_power;
        self.surface_dashpot_power += losses.surface_dashpot_power;
        self.max_depth = self.max_depth.max(losses.max_depth);
    }

    fn add_as_second(&mut self, losses: &PairLosses) {
        self.dashpot += losses.dashpot.on_second();
        self.max_depth = self.max_depth.max(losses.max_depth);
    }
}

/// Sums the forces of the bodies of a chunk, one body after the other.
struct BodySums<'a> {
    results: ContactResults<'a>,
    /// What is left of the chunk.
    released: &'a [f64],
    pairs: &'a [PairForces],
    losses: &'a [PairLosses],
}

impl<'a> BodySums<'a> {
    /// For the chunk whose first body is `first`.
    fn new(results: ContactResults<'a>, first: usize) -> Self {
        let ChunkContacts { released, pairs, losses, .. } = &results.contacts[first / CHUNK];
        debug_assert!(losses.is_empty() || losses.len() == pairs.len());
        Self { results, released, pairs, losses }
    }

    /// The sum of the next body, of index `index`: first its pairs as first body, then those as second body in the order of their
    /// first bodies. This order fixes the bits of the result. With `PREDICT` only the total is summed.
    fn next<const PREDICT: bool>(&mut self, index: usize) -> BodySum {
        let mut sum = BodySum::default();
        if let Some((&slip, rest)) = self.released.split_first() {
            sum.slip = slip;
            self.released = rest;
        }
        while let Some((pair, rest)) = self.pairs.split_first()
            && pair.first as usize == index
        {
            sum.total += pair.wrench.on_first();
            self.pairs = rest;
            if !PREDICT && let Some((losses, rest)) = self.losses.split_first() {
                sum.add_as_first(losses);
                self.losses = rest;
            }
        }
        let ContactResults { contacts, lists } = self.results;
        let starts = &lists.second_starts;
        let range = starts[index] as usize..starts[index + 1] as usize;
        for &(chunk, pair) in &lists.second_pairs[range] {
            let contacts = &contacts[chunk as usize];
            let pair = contacts.pair_index[pair as usize];
            if pair == NO_CONTACT {
                continue;
            }
            sum.total += contacts.pairs[pair as usize].wrench.on_second();
            if !PREDICT {
                sum.add_as_second(&contacts.losses[pair as usize]);
            }
        }
        sum
    }
}
