//! What each body feels of all its contacts with others.

use super::contact::Losses;
use super::find::{Found, NONE, Touching};
use super::list::Lists;
use super::pose::Pose;
use crate::parallel::CHUNK;
use crate::{Batch, BodyForces, Model, Wrench};

/// Sums over the contacts of one body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BodySum {
    /// Springs and dashpots.
    all: Wrench,
    /// The dashpots alone.
    dashpot: Wrench,
    /// Energy lost to slip (J), counted with the first body of a pair.
    slip: f64,
    /// What moving surfaces put in (W), counted with the first body of a pair.
    belt_power: f64,
    /// What dashpots take of that (W).
    belt_loss: f64,
    /// The deepest contact (m).
    max_depth: f64,
}

impl BodySum {
    /// As first body of a pair.
    fn account_first(&mut self, losses: &Losses) {
        self.dashpot += losses.dashpot.on_first();
        self.slip += losses.slip;
        self.belt_power += losses.belt_power;
        self.belt_loss += losses.belt_loss;
        self.max_depth = self.max_depth.max(losses.max_depth);
    }

    /// As second body of a pair.
    fn account_second(&mut self, losses: &Losses) {
        self.dashpot += losses.dashpot.on_second();
        self.max_depth = self.max_depth.max(losses.max_depth);
    }
}

/// What bodies feel of each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feelings<'a> {
    pub(super) found: &'a [Found],
    pub(super) lists: &'a Lists,
}

/// Sets the velocities that contacts feel to those in the middle of the kick that a first look gives over the time `h` (s), for the bodies
/// from number `first` on that have these poses. `others` are forces from elsewhere.
pub(super) fn foretell(
    model: &Model,
    first: usize,
    poses: &mut [Pose],
    others: &[BodyForces],
    feelings: Feelings,
    h: f64,
) {
    let mut sums = Sums::of_chunk(feelings, first);
    for ((index, pose), others) in (first..).zip(poses).zip(others) {
        let sum = sums.next::<true>(index);
        let body = &model.bodies[index];
        if body.is_free() && sum.all != Wrench::default() {
            let wrench = sum.all + others.contact();
            pose.velocity += wrench.force * (0.5 * h / body.mass);
            let spin = body.angular_velocity(pose.rotation, wrench.torque);
            pose.angular_velocity += spin * (0.5 * h);
        }
    }
}

/// Adds what [`meet`](super::meet()) has found to the forces of [`contact`](crate::stage::contact()).
///
/// # Panics
/// Where bodies can meet and `meet` has not been called before.
pub fn feel(batch: &mut Batch) {
    if !batch.model.meets {
        return;
    }
    let mut sums = Sums::of_chunk(batch.feelings, batch.first);
    for (index, forces) in (batch.first..).zip(&mut *batch.forces) {
        let sum = sums.next::<false>(index);
        forces.spring += sum.all - sum.dashpot;
        forces.dashpot += sum.dashpot;
        forces.slip += sum.slip;
        (forces.belt_power, forces.belt_loss) = (sum.belt_power, sum.belt_loss);
        forces.max_depth = forces.max_depth.max(sum.max_depth);
    }
}

/// What the latest push does to the bodies of a chunk, one after the other.
struct Sums<'a> {
    feelings: Feelings<'a>,
    /// Of the bodies that are left.
    released: &'a [f64],
    touching: &'a [Touching],
    losses: &'a [Losses],
}

impl<'a> Sums<'a> {
    /// Those of the chunk whose first body is number `body`.
    fn of_chunk(feelings: Feelings<'a>, body: usize) -> Self {
        let Found { released, touching, losses, .. } = &feelings.found[body / CHUNK];
        debug_assert!(losses.is_empty() || losses.len() == touching.len());
        Self { feelings, released, touching, losses }
    }

    /// What the next body feels, number `index`: first the pairs that it is the first of, then those that it is the second of, in
    /// the order of the other. After a first look there are totals alone.
    fn next<const FIRST: bool>(&mut self, index: usize) -> BodySum {
        let mut sum = BodySum::default();
        if let Some((&slip, rest)) = self.released.split_first() {
            sum.slip = slip;
            self.released = rest;
        }
        while let Some((touching, rest)) = self.touching.split_first()
            && touching.first as usize == index
        {
            sum.all += touching.forces.on_first();
            self.touching = rest;
            if !FIRST && let Some((losses, rest)) = self.losses.split_first() {
                sum.account_first(losses);
                self.losses = rest;
            }
        }
        let Feelings { found, lists } = self.feelings;
        let range = lists.starts[index] as usize..lists.starts[index + 1] as usize;
        for &(chunk, pair) in &lists.seconds[range] {
            let found = &found[chunk as usize];
            let number = found.number[pair as usize];
            if number == NONE {
                continue;
            }
            sum.all += found.touching[number as usize].forces.on_second();
            if !FIRST {
                sum.account_second(&found.losses[number as usize]);
            }
        }
        sum
    }
}
