//! Bodies next to each other, with all that belongs to them: what stages work on.
//!
//! A step goes through several stages with one batch before it takes the next: what belongs to these bodies stays at hand, and
//! threads have to wait for each other only where bodies meet.

use crate::parallel::{self, CHUNK};
use crate::stage::{Feelings, Pose, Problem, Touching};
use crate::{BodyForces, BodyState, FrictionSpring, Model, Scratch, State, Tally};

/// A run of bodies, and what is derived of them within a step.
#[derive(Debug)]
pub struct Batch<'a> {
    /// What is constant.
    pub model: &'a Model,
    /// Time at the beginning of the step (s).
    pub time: f64,
    /// Which body is its first.
    pub first: usize,
    /// The bodies.
    pub bodies: &'a mut [BodyState],
    /// Their friction springs.
    pub springs: &'a mut [Vec<FrictionSpring>],
    /// Which of them may touch a wall or another body within the step.
    pub near: &'a mut [bool],
    /// Their forces.
    pub forces: &'a mut [BodyForces],
    /// Their friction springs that go on from the latest evaluation.
    pub next: &'a mut [Vec<FrictionSpring>],
    /// Where they are, as others meet them; empty where that is not known.
    pub(crate) poses: &'a mut [Pose],
    /// One for each [`CHUNK`] of them.
    pub(crate) rooms: &'a mut [Room],
    /// What others do to them.
    pub(crate) feelings: Feelings<'a>,
}

/// Room for one batch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Room {
    /// Particles of one body in contact, while they are looked at.
    pub touching: Touching,
    /// Friction springs of one body to go back to.
    pub backup: Vec<FrictionSpring>,
    /// What the batch adds to the tally.
    pub tally: Tally,
    /// The first body whose state cannot be trusted.
    pub problem: Option<(usize, Problem)>,
}

impl Batch<'_> {
    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The tally that stages add to: of few bodies that of the run so far, of many one for this batch.
    pub fn tally(&mut self) -> &mut Tally {
        &mut self.rooms[0].tally
    }

    /// The bodies before `count`, and the others.
    fn split(self, count: usize) -> (Self, Self) {
        let (bodies, other_bodies) = self.bodies.split_at_mut(count);
        let (springs, other_springs) = self.springs.split_at_mut(count);
        let (near, other_near) = self.near.split_at_mut(count);
        let (forces, other_forces) = self.forces.split_at_mut(count);
        let (next, other_next) = self.next.split_at_mut(count);
        let (poses, other_poses) = self.poses.split_at_mut(count.min(self.poses.len()));
        let (rooms, other_rooms) = self.rooms.split_at_mut(count / CHUNK);
        let here = Self { bodies, springs, near, forces, next, poses, rooms, ..self };
        let there = Self {
            first: here.first + count,
            bodies: other_bodies,
            springs: other_springs,
            near: other_near,
            forces: other_forces,
            next: other_next,
            poses: other_poses,
            rooms: other_rooms,
            ..here
        };
        (here, there)
    }

    /// Hands batches of [`CHUNK`] bodies round.
    fn in_parallel(self, stages: &(impl Fn(&mut Batch) + Sync)) {
        let chunks = self.len().div_ceil(CHUNK);
        if chunks < 2 {
            return self.alone(stages);
        }
        let (here, there) = self.split(chunks / 2 * CHUNK);
        rayon::join(|| here.in_parallel(stages), || there.in_parallel(stages));
    }

    /// Takes batches of [`CHUNK`] bodies one after the other.
    fn alone(self, stages: &impl Fn(&mut Batch)) {
        let mut rest = self;
        while rest.len() > CHUNK {
            let (mut here, there) = rest.split(CHUNK);
            stages(&mut here);
            rest = there;
        }
        stages(&mut rest);
    }
}

/// Takes every batch of bodies through `stages`, on as many threads as there are, and adds up what they tally.
pub fn each_batch(
    model: &Model,
    state: &mut State,
    scratch: &mut Scratch,
    stages: impl Fn(&mut Batch) + Sync,
) {
    if state.bodies.is_empty() {
        return;
    }
    scratch.fit(state.bodies.len());
    let Scratch { near, forces, springs: next, rooms, meeting } = scratch;
    // few bodies add to the tally itself
    let is_small = rooms.len() < 2;
    for room in &mut *rooms {
        room.tally = if is_small { state.tally } else { Tally::default() };
    }
    let (poses, feelings) = meeting.parts();
    let mut all = Batch {
        model,
        time: state.time,
        first: 0,
        bodies: &mut state.bodies,
        springs: &mut state.springs,
        near,
        forces,
        next,
        poses,
        rooms,
        feelings,
    };
    if is_small {
        stages(&mut all);
        state.tally = rooms[0].tally;
        return;
    }
    if parallel::is_alone() {
        all.alone(&stages)
    } else {
        all.in_parallel(&stages)
    }
    rooms.iter().for_each(|room| state.tally += room.tally);
}
