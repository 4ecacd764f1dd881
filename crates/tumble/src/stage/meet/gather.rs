//! What each body feels of all its contacts with others.

use super::Meeting;
use super::contact::PairForces;
use super::find::{Found, NONE};
use super::list::Lists;
use crate::parallel::{self, CHUNK};
use crate::{BodyForces, Model, Wrench};

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
    fn add_first<const FIRST: bool>(&mut self, forces: &PairForces) {
        self.all += forces.all.on_first();
        if FIRST {
            return;
        }
        self.dashpot += forces.dashpot.on_first();
        self.slip += forces.slip;
        self.belt_power += forces.belt_power;
        self.belt_loss += forces.belt_loss;
        self.max_depth = self.max_depth.max(forces.max_depth);
    }

    /// As second body of a pair.
    fn add_second<const FIRST: bool>(&mut self, forces: &PairForces) {
        self.all += forces.all.on_second();
        if FIRST {
            return;
        }
        self.dashpot += forces.dashpot.on_second();
        self.max_depth = self.max_depth.max(forces.max_depth);
    }
}

impl Meeting {
    /// Sums up what the latest push does to each body: first the pairs that it is the first of, then those
    /// that it is the second of, in the order of the other. After a first look there are totals alone.
    pub(super) fn gather<const FIRST: bool>(&mut self) {
        let (found, lists) = (&self.found, &self.lists);
        self.sums.resize(self.poses.len(), BodySum::default());
        parallel::each_body(&mut self.sums, |body, sums| {
            gather_chunk::<FIRST>(found, lists, body, sums);
        });
    }

    /// Sets the velocities to those in the middle of the kick that the latest sums give over the time `h` (s).
    pub(super) fn half_kick(&mut self, model: &Model, others: &[BodyForces], h: f64) {
        let sums = &self.sums;
        parallel::each_body(&mut self.poses, |first, poses| {
            for (index, pose) in (first..).zip(poses) {
                let body = &model.bodies[index];
                if body.is_free() && sums[index].all != Wrench::default() {
                    let wrench = sums[index].all + others[index].contact();
                    pose.velocity += wrench.force * (0.5 * h / body.mass);
                    let spin = body.angular_velocity(pose.rotation, wrench.torque);
                    pose.angular_velocity += spin * (0.5 * h);
                }
            }
        });
    }

    /// Adds the latest sums to the forces of the bodies.
    pub(super) fn give(&self, forces: &mut [BodyForces]) {
        let sums = &self.sums;
        parallel::each_body(forces, |first, forces| {
            for (sum, forces) in sums[first..].iter().zip(forces) {
                forces.spring += sum.all - sum.dashpot;
                forces.dashpot += sum.dashpot;
                forces.slip += sum.slip;
                (forces.belt_power, forces.belt_loss) = (sum.belt_power, sum.belt_loss);
                forces.max_depth = forces.max_depth.max(sum.max_depth);
            }
        });
    }
}

/// The sums of the bodies of one chunk, the first of which is number `body`.
fn gather_chunk<const FIRST: bool>(
    found: &[Found],
    lists: &Lists,
    body: usize,
    sums: &mut [BodySum],
) {
    let own = &found[body / CHUNK];
    for (sum, released) in sums.iter_mut().zip(&own.released) {
        *sum = BodySum { slip: *released, ..BodySum::default() };
    }
    for touching in &own.touching {
        sums[touching.first as usize - body].add_first::<FIRST>(&touching.forces);
    }
    for (index, sum) in (body..).zip(sums) {
        let range = lists.starts[index] as usize..lists.starts[index + 1] as usize;
        for &(chunk, pair) in &lists.seconds[range] {
            let found = &found[chunk as usize];
            let number = found.number[pair as usize];
            if number != NONE {
                sum.add_second::<FIRST>(&found.touching[number as usize].forces);
            }
        }
    }
}
