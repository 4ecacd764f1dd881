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
mod sides;
mod springs;
mod start;

use std::sync::Arc;

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

pub(crate) use self::find::TooFast;
use self::find::{ContactRoom, Found, Moment};
pub(crate) use self::gather::Feelings;
pub use self::gather::feel;
pub(crate) use self::list::can_touch;
use self::list::{Lists, Near, Pair};
pub(crate) use self::pose::Pose;
pub(crate) use self::start::{overlaps, push_apart};
use crate::parallel::{self, CHUNK};
use crate::{
    Batch, BodyForces, BodyModel, BodyState, ContactKind, Integrator, Model, PairSpring, Scratch,
    State, each_batch,
};

/// Room for contacts between bodies. Dropping it between steps changes no result.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meeting {
    poses: Vec<Pose>,
    lists: Lists,
    /// Contacts, one entry a chunk of bodies.
    found: Vec<Found>,
    /// Room for contacts of chunks that are yet to be looked at.
    room: Vec<ContactRoom>,
    /// The tangential springs that go on after the latest push, as far as chunks were pushed in turn; others stay with their chunks.
    springs: Vec<PairSpring>,
}

/// Takes note of where the bodies are, and how far they have come. [`meet`] needs that of all bodies.
pub fn arrive(batch: &mut Batch) {
    let Batch { model, first, bodies, poses, .. } = batch;
    move_all(model, *first, poses, bodies);
}

/// Poses of the bodies from number `first` on, as far as they are known.
fn move_all(model: &Model, first: usize, poses: &mut [Pose], bodies: &[BodyState]) {
    for ((index, pose), state) in (first..).zip(poses).zip(bodies) {
        *pose = pose.moved(model, index, state);
    }
}

/// Contact forces between bodies, and between spheres and walls, where [`arrive`] has found them; [`feel`] hands
/// them out. `h` (s) is the time since the latest kick. Under `splitting` dashpots feel the mean of the velocities before and after the
/// kick, under `euler` the velocities as they are.
pub fn meet(model: &Model, state: &mut State, scratch: &mut Scratch, h: f64) {
    if !model.meets {
        return;
    }
    scratch.meeting.list(model, state);
    // spheres meet walls by another law
    let is_damped = |body: &Arc<BodyModel>| {
        body.pair_material.is_damped() || (body.has_spheres() && body.is_damped)
    };
    if model.integrator == Integrator::Splitting && model.bodies.iter().any(is_damped) {
        if parallel::is_alone() {
            scratch.meeting.in_turn(model, &state.pair_springs, &scratch.forces, h);
            return;
        }
        scratch.meeting.find::<true>(model, &state.pair_springs, h);
        each_batch(model, state, scratch, |batch| {
            let Batch { model, first, poses, forces, feelings, .. } = batch;
            gather::foretell(model, *first, poses, forces, *feelings, h);
        });
        scratch.meeting.push();
    } else {
        scratch.meeting.find::<false>(model, &state.pair_springs, h);
    }
}

/// Writes down the tangential springs that go on after the latest push; to be called once after each [`meet`].
pub fn keep(state: &mut State, scratch: &mut Scratch) {
    let Meeting { found, springs, .. } = &mut scratch.meeting;
    for found in found {
        springs.extend_from_slice(&found.springs);
    }
    std::mem::swap(&mut state.pair_springs, springs);
    springs.clear();
}

impl Meeting {
    /// Puts the bodies where they are, and makes the lists anew where they no longer hold.
    fn place(&mut self, model: &Model, state: &State) {
        if self.poses.len() == model.bodies.len() {
            move_all(model, 0, &mut self.poses, &state.bodies);
        }
        self.list(model, state);
    }

    /// Makes the lists anew where they no longer hold for where the bodies are.
    fn list(&mut self, model: &Model, state: &State) {
        let known = self.poses.len() == model.bodies.len();
        // NaN is not below it
        if known && self.poses.iter().all(|pose| pose.travel <= pose.until) {
            return;
        }
        // after a state that was none nothing is known
        if !known || !self.poses.iter().all(|pose| pose.travel.is_finite()) {
            self.poses.clear();
            let states = state.bodies.iter().enumerate();
            self.poses.extend(states.map(|(index, state)| Pose::new(model, index, state)));
            (self.lists, self.found) = (Lists::default(), Vec::new());
        }
        self.lists.make(model, &mut self.poses);
    }

    /// Where the bodies are, and what they feel of each other.
    pub fn parts(&mut self) -> (&mut [Pose], Feelings<'_>) {
        let Self { poses, found, lists, .. } = self;
        (poses, Feelings { found, lists })
    }

    /// Finds what touches, and its forces. A first look is one at the velocities before the kick.
    fn find<const FIRST: bool>(&mut self, model: &Model, springs: &[PairSpring], since: f64) {
        self.springs.clear();
        let moment = Moment { model, poses: &self.poses, springs, since };
        self.found.resize_with(self.lists.chunks.len(), Found::default);
        parallel::each_of_two(&mut self.found, &mut self.lists.chunks, |chunk, found, near| {
            find_chunk::<FIRST>(&moment, chunk, found, near);
        });
    }

    /// The forces of what touches, with the velocities of the poses as they are.
    fn push(&mut self) {
        let (poses, chunks) = (&self.poses, &self.lists.chunks);
        parallel::each(&mut self.found, |chunk, found| push_chunk(poses, found, &chunks[chunk]));
    }

    /// Finds what touches, foretells velocities and pushes with them, each chunk as soon as it can be: what belongs to its contacts is still
    /// at hand then, and what they took up is at hand for the next. No pair has its second body in an earlier chunk, so that what was foretold of a chunk changes nothing that
    /// is found later.
    fn in_turn(
        &mut self,
        model: &Model,
        springs: &[PairSpring],
        others: &[BodyForces],
        since: f64,
    ) {
        self.found.resize_with(self.lists.chunks.len(), Found::default);
        self.springs.clear();
        let mut pushed = 0;
        for (chunk, others) in others.chunks(CHUNK).enumerate() {
            let moment = Moment { model, poses: &self.poses, springs, since };
            let (near, found) = (&mut self.lists.chunks[chunk], &mut self.found[chunk]);
            found.take_room(&mut self.room);
            find_chunk::<true>(&moment, chunk, found, near);
            let feelings = Feelings { found: &self.found, lists: &self.lists };
            let first = chunk * CHUNK;
            let poses = &mut self.poses[first..first + others.len()];
            gather::foretell(model, first, poses, others, feelings, since);
            while let Some(near) = self.lists.chunks.get(pushed)
                && near.until <= chunk
            {
                let found = &mut self.found[pushed];
                push_chunk(&self.poses, found, near);
                self.springs.extend_from_slice(&found.springs);
                self.room.push(found.give_room());
                pushed += 1;
            }
        }
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
        self.find::<true>(model, &state.pair_springs, since);
        self.found.iter().map(Found::elastic_energy).sum()
    }

    /// For a look at a state: what is known of the bodies, without room for steps.
    pub fn for_a_look(&self) -> Self {
        Self { poses: self.poses.clone(), lists: self.lists.clone(), ..Self::default() }
    }

    /// Calls `visit` with the pair, the normal and the depth (m) of each contact of a state.
    fn each_contact(
        &mut self,
        model: &Model,
        state: &State,
        mut visit: impl FnMut(&Pair, DVec3, f64),
    ) {
        self.place(model, state);
        self.find::<true>(model, &[], 0.0);
        for (found, near) in self.found.iter().zip(&self.lists.chunks) {
            found.each_contact(near, &mut visit);
        }
    }

    /// How deep the deepest contact between two bodies is (m), and that between a sphere and a wall; 0 where none touch.
    pub fn depths(&mut self, model: &Model, state: &State) -> [f64; 2] {
        let mut depths = [0.0f64; 2];
        if model.meets {
            self.each_contact(model, state, |pair, _, depth| {
                let deepest = &mut depths[usize::from(pair.kind == ContactKind::Wall)];
                *deepest = deepest.max(depth);
            });
        }
        depths
    }

    /// The first two bodies that could pass through each other in a step.
    pub fn too_fast(&self) -> Option<TooFast> {
        self.found.iter().find_map(|found| found.too_fast)
    }
}

fn find_chunk<const FIRST: bool>(
    moment: &Moment,
    chunk: usize,
    found: &mut Found,
    near: &mut Near,
) {
    let body = chunk * CHUNK;
    dispatch!(Level::new(), simd => simd.vectorize(#[inline(always)] || found.find::<_, FIRST>(simd, near, moment, body)));
}

fn push_chunk(poses: &[Pose], found: &mut Found, near: &Near) {
    dispatch!(Level::new(), simd => simd.vectorize(#[inline(always)] || found.push(simd, near, poses)));
}
