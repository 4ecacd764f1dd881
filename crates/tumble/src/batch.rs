//! Batches of bodies: what the stages of a step work on.
//!
//! A step takes one batch through several stages before it takes the next. The data of these bodies then stays in the
//! cache, and threads synchronise only where bodies touch each other.

use crate::contact::gather::ContactResults;
use crate::contact::pose::BodyPose;
use crate::parallel::{self, CHUNK};
use crate::workspace::Workspace;
use crate::{BodyForces, BodyState, FrictionSpring, Model, RunTotals, Scratch, State};

/// A range of consecutive bodies, with all data that belongs to them.
#[derive(Debug)]
pub struct Batch<'a> {
    /// Everything that is constant during the run.
    pub model: &'a Model,
    /// Time at the beginning of the step (s).
    pub time: f64,
    /// Index of the first body.
    pub first: usize,
    /// States of the bodies.
    pub bodies: &'a mut [BodyState],
    /// Friction springs at walls, one list per body.
    pub springs: &'a mut [Vec<FrictionSpring>],
    /// Whether each body may touch a wall or another body within the step.
    pub may_touch: &'a mut [bool],
    /// Forces on the bodies.
    pub forces: &'a mut [BodyForces],
    /// Friction springs at walls after the latest evaluation, one list per body.
    pub next_springs: &'a mut [Vec<FrictionSpring>],
    /// Poses of the bodies for contact between bodies; empty before the first neighbour lists are built.
    pub(crate) poses: &'a mut [BodyPose],
    /// All bodies at the beginning of the step, where there are joints; else empty or out of date.
    pub(crate) start: &'a [BodyState],
    /// Buffers, one for each [`CHUNK`] of bodies.
    pub(crate) workspaces: &'a mut [Workspace],
    /// Results of contact between bodies.
    pub(crate) contact_results: ContactResults<'a>,
}

impl Batch<'_> {
    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there are no bodies.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The totals that stages add to: those of the run where there is one batch, else those of this batch.
    pub fn totals(&mut self) -> &mut RunTotals {
        &mut self.workspaces[0].totals
    }

    /// Splits off the bodies from the `count`-th on; `count` is a multiple of [`CHUNK`].
    fn split_at(self, count: usize) -> (Self, Self) {
        let (bodies, other_bodies) = self.bodies.split_at_mut(count);
        let (springs, other_springs) = self.springs.split_at_mut(count);
        let (may_touch, other_may_touch) = self.may_touch.split_at_mut(count);
        let (forces, other_forces) = self.forces.split_at_mut(count);
        let (next_springs, other_next_springs) = self.next_springs.split_at_mut(count);
        let (poses, other_poses) = self.poses.split_at_mut(count.min(self.poses.len()));
        let (workspaces, other_workspaces) = self.workspaces.split_at_mut(count / CHUNK);
        let head =
            Self { bodies, springs, may_touch, forces, next_springs, poses, workspaces, ..self };
        let tail = Self {
            first: head.first + count,
            bodies: other_bodies,
            springs: other_springs,
            may_touch: other_may_touch,
            forces: other_forces,
            next_springs: other_next_springs,
            poses: other_poses,
            workspaces: other_workspaces,
            ..head
        };
        (head, tail)
    }

    /// Runs `stages` on each [`CHUNK`] of bodies, on all threads.
    fn for_each_parallel(self, stages: &(impl Fn(&mut Batch) + Sync)) {
        let chunks = self.len().div_ceil(CHUNK);
        if chunks < 2 {
            return self.for_each_sequential(stages);
        }
        let (head, tail) = self.split_at(chunks / 2 * CHUNK);
        rayon::join(|| head.for_each_parallel(stages), || tail.for_each_parallel(stages));
    }

    /// Runs `stages` on each [`CHUNK`] of bodies, one after the other.
    fn for_each_sequential(self, stages: &impl Fn(&mut Batch)) {
        let mut rest = self;
        while rest.len() > CHUNK {
            let (mut head, tail) = rest.split_at(CHUNK);
            stages(&mut head);
            rest = tail;
        }
        stages(&mut rest);
    }
}

/// Runs `stages` on every batch of bodies, on all threads, and adds up the totals of the batches in their order.
pub fn for_each_batch(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    stages: impl Fn(&mut Batch) + Sync,
) {
    if state.bodies.is_empty() {
        return;
    }
    scratch.resize(state.bodies.len());
    let Scratch {
        may_touch, forces, springs: next_springs, workspaces, body_contacts, before, ..
    } = scratch;
    // a single batch adds to the totals of the run directly
    let is_single = workspaces.len() < 2;
    for workspace in &mut *workspaces {
        workspace.totals = if is_single { state.totals } else { RunTotals::default() };
    }
    let (poses, contact_results) = body_contacts.poses_and_results();
    let mut all = Batch {
        model,
        time: state.time,
        first: 0,
        bodies: &mut state.bodies,
        springs: &mut state.springs,
        may_touch,
        forces,
        next_springs,
        poses,
        start: &before.bodies,
        workspaces,
        contact_results,
    };
    if is_single {
        stages(&mut all);
        state.totals = workspaces[0].totals;
        return;
    }
    if parallel::is_single_threaded() {
        all.for_each_sequential(&stages)
    } else {
        all.for_each_parallel(&stages)
    }
    workspaces.iter().for_each(|workspace| state.totals += workspace.totals);
}
