//! Bodies in each other's way, and spheres at walls.
//!
//! *List* what may touch soon ([`list`]), *find* what touches ([`find`]), *push* with springs, dashpots and friction
//! ([`contact`]), and *gather* what each body feels. All of it runs on chunks of bodies that do not depend on how many threads
//! there are. What is summed is summed in the order of bodies and particles, whatever the lists hold besides: they may be made anew at
//! any moment, and a run that goes on from a checkpoint comes to the same bits.

mod contact;
mod crowd;
mod find;
mod gather;
mod grid;
mod list;
mod mesh;
mod pose;
mod start;

use fearless_simd::{Level, Simd, dispatch};

pub(crate) use self::find::TooFast;
use self::find::{Found, Moment};
use self::gather::BodySum;
use self::list::Lists;
pub(crate) use self::list::can_touch;
use self::pose::Pose;
pub(crate) use self::start::{overlaps, push_apart};
use crate::parallel::{self, CHUNK};
use crate::{BodyModel, Integrator, Model, PairSpring, Scratch, State};

/// Room for contacts between bodies. Dropping it between steps changes no result.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meeting {
    poses: Vec<Pose>,
    lists: Lists,
    /// Contacts, one entry a chunk of bodies.
    found: Vec<Found>,
    /// What each body feels of it.
    sums: Vec<BodySum>,
}

/// Contact forces between bodies, and between spheres and walls, added to those of [`contact`](super::contact()). `h` (s) is the
/// time since the latest kick. Under `splitting` dashpots feel the mean of the velocities before and after the kick, under `euler`
/// the velocities as they are.
pub fn meet(model: &Model, state: &State, scratch: &mut Scratch, h: f64) {
    if !model.meets {
        return;
    }
    let meeting = &mut scratch.meeting;
    meeting.place(model, state);
    meeting.find(model, &state.pair_springs, h);
    // spheres meet walls by another law
    let is_damped =
        |body: &BodyModel| body.pair_material.is_damped() || (body.has_spheres() && body.is_damped);
    if model.integrator == Integrator::Splitting && model.bodies.iter().any(is_damped) {
        meeting.push::<true>();
        meeting.gather::<true>();
        meeting.half_kick(model, &scratch.forces, h);
    }
    meeting.push::<false>();
    meeting.gather::<false>();
    meeting.give(&mut scratch.forces);
}

impl Meeting {
    /// Puts the bodies where they are, and makes the lists anew where they no longer hold.
    fn place(&mut self, model: &Model, state: &State) {
        let bodies = &model.bodies;
        let known = self.poses.len() == bodies.len();
        if known {
            parallel::each_body(&mut self.poses, |first, poses| {
                for (index, pose) in (first..).zip(poses) {
                    *pose = pose.moved(model, index, &state.bodies[index]);
                }
            });
        }
        if !known {
            self.poses.clear();
            let states = state.bodies.iter().enumerate();
            self.poses.extend(states.map(|(index, state)| Pose::new(model, index, state)));
            self.lists = Lists::default();
        }
        if !known || self.poses.iter().any(|pose| pose.travel > pose.until) {
            self.lists.make(model, &mut self.poses);
        }
    }

    fn find(&mut self, model: &Model, springs: &[PairSpring], since: f64) {
        let moment = Moment { model, poses: &self.poses, springs, since };
        self.found.resize_with(self.lists.chunks.len(), Found::default);
        parallel::each_of_two(&mut self.found, &mut self.lists.chunks, |index, found, near| {
            at_full_width(
                #[inline(always)]
                || found.find(near, &moment, index * CHUNK),
            );
        });
    }

    fn push<const FIRST: bool>(&mut self) {
        let (poses, chunks) = (&self.poses, &self.lists.chunks);
        parallel::each(&mut self.found, |index, found| {
            at_full_width(
                #[inline(always)]
                || found.push::<FIRST>(&chunks[index], poses),
            );
        });
    }

    /// Energy in the springs between bodies and between spheres and walls, normal and tangential (J).
    pub fn elastic_energy(&mut self, model: &Model, state: &State) -> f64 {
        if !model.meets {
            return 0.0;
        }
        // since the latest kick the tangential springs have stretched on
        let since = match model.integrator {
            Integrator::Splitting => 0.5 * model.dt,
            Integrator::Euler => model.dt,
        };
        self.place(model, state);
        self.find(model, &state.pair_springs, since);
        let chunks = self.found.iter().zip(&self.lists.chunks);
        chunks.map(|(found, near)| found.elastic_energy(near)).sum()
    }

    /// The first two bodies that could pass through each other in a step.
    pub fn too_fast(&self) -> Option<TooFast> {
        self.found.iter().find_map(|found| found.too_fast)
    }

    /// The springs that go on after the latest push.
    pub fn keep(&mut self, model: &Model, springs: &mut Vec<PairSpring>) {
        let chunks = &self.lists.chunks;
        parallel::each(&mut self.found, |index, found| found.keep(&chunks[index], model));
        springs.clear();
        for found in &self.found {
            springs.extend_from_slice(&found.springs);
        }
    }
}

/// Runs `work` with all that the processor can do. It changes no bit.
fn at_full_width(work: impl FnOnce()) {
    dispatch!(Level::new(), simd => simd.vectorize(work));
}
