//! From contacts to impulses, and from impulses to states, friction springs and losses.

use fearless_simd::{Level, Simd, dispatch};

use super::super::chunk_contacts::ChunkContacts;
use super::super::neighbour_list::NeighbourLists;
use super::super::pose::BodyPose;
use super::super::since_kick::SinceKick;
use super::bodies::SolverBody;
use super::colouring::Colouring;
use super::groups::{self, ContactPlace, Group};
use super::iterations::{Outcome, apply, iterate};
use super::law::{Step, prepare};
use super::losses::{Account, account};
use super::rows::{Rows, Source};
use crate::lanes::vector;
use crate::{BodyForces, ContactImpulse, Model, PairSpring, RunTotals, State, Wrench};

/// Buffers of the solver. Dropping them between steps changes no result.
#[derive(Clone, Debug, Default)]
pub(crate) struct Solver {
    bodies: Vec<SolverBody>,
    places: Vec<ContactPlace>,
    groups: Vec<Group>,
    colouring: Colouring,
    rows: Rows,
    /// Impulses and torque impulses on the bodies.
    impulses: Vec<Wrench>,
    springs: Vec<PairSpring>,
    contact_impulses: Vec<ContactImpulse>,
}

/// The contacts within reach.
pub(in crate::contact) struct Found<'a> {
    pub chunks: &'a [ChunkContacts],
    pub lists: &'a NeighbourLists,
    pub poses: &'a [BodyPose],
    /// The flight before the kick.
    pub since_kick: SinceKick,
}

impl Solver {
    /// Finds the impulses of all contacts, and applies them to `state`.
    pub(in crate::contact) fn solve(
        &mut self,
        model: &Model,
        found: &Found,
        state: &mut State,
        forces: &mut [BodyForces],
    ) -> Outcome {
        let SinceKick { step: h, time, .. } = found.since_kick;
        self.bodies.clear();
        let bodies = model.bodies.iter().zip(found.poses);
        self.bodies.extend(bodies.map(|(body, pose)| SolverBody::new(model, body, pose, time)));
        self.bodies.push(SolverBody::default());
        let count = model.bodies.len() as u32;
        groups::collect(found.chunks, found.lists, count, &mut self.places, &mut self.groups);
        self.colouring.colour(&self.groups, &self.bodies);
        let source = Source {
            chunks: found.chunks,
            poses: found.poses,
            bodies: &self.bodies,
            contacts: &self.places,
            groups: &self.groups,
            impulses: &state.pair_impulses,
        };
        self.rows.fill(&source, &self.colouring);
        let step = Step { length: h, rest_speed: 2.0 * h * model.gravity.length() };
        self.prepare(step);
        apply(&self.rows, &mut self.bodies);
        let outcome = iterate(&mut self.rows, &mut self.bodies, model.solver);
        let mut totals = RunTotals {
            iterations: u64::from(outcome.iterations),
            not_converged: u64::from(!outcome.has_converged),
            ..RunTotals::default()
        };
        self.account(step, &mut totals);
        self.move_bodies(model, h, (state, forces), &mut totals);
        self.store(found, state, &mut totals);
        state.totals += totals;
        outcome
    }

    fn prepare(&mut self, step: Step) {
        let Self { rows, bodies, .. } = self;
        dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || prepare_all(simd, rows, bodies, step)
        ));
    }

    /// The energy that the contacts take, and the impulses on the bodies.
    fn account(&mut self, step: Step, totals: &mut RunTotals) {
        self.impulses.clear();
        self.impulses.resize(self.bodies.len(), Wrench::default());
        let Rows { packs, rows, laws, .. } = &mut self.rows;
        for pack in packs {
            let range = pack.start as usize..pack.end as usize;
            let rows = (&rows[range.clone()], &mut laws[range]);
            let Account { impulses, losses } = dispatch!(Level::new(), simd => simd.vectorize(
                #[inline(always)]
                || account(simd, pack, rows, &self.bodies, step)
            ));
            *totals += losses;
            for (lane, _) in pack.lengths.iter().enumerate().filter(|(_, length)| **length > 0) {
                let [force, torque, other_torque] =
                    impulses.each_ref().map(|columns| vector(columns, lane));
                self.impulses[pack.first[lane] as usize] += Wrench { force, torque };
                self.impulses[pack.second[lane] as usize] +=
                    Wrench { force: -force, torque: -other_torque };
            }
        }
    }

    fn move_bodies(
        &self,
        model: &Model,
        h: f64,
        (state, forces): (&mut State, &mut [BodyForces]),
        totals: &mut RunTotals,
    ) {
        let bodies = model.bodies.iter().zip(&mut state.bodies).zip(forces);
        for (((body, state), forces), &impulse) in bodies.zip(&self.impulses) {
            *forces = BodyForces::default();
            if impulse == Wrench::default() {
                continue;
            }
            let Wrench { force, torque } = impulse;
            let per_time = 1.0 / h;
            forces.spring = Wrench { force: force * per_time, torque: torque * per_time };
            if body.is_free() {
                state.velocity += force / body.mass;
                state.angular_momentum += torque;
                totals.evaluations += 1;
            }
        }
    }

    /// Stores springs and impulses of the contacts that last, in their order, and counts the springs of contacts that are no longer found
    /// as lost to slip.
    fn store(&mut self, found: &Found, state: &mut State, totals: &mut RunTotals) {
        self.springs.clear();
        self.contact_impulses.clear();
        for (place, &(row, lane)) in self.places.iter().zip(&self.rows.places) {
            let (row, lane) = (row as usize, lane as usize);
            let normal = self.rows.rows[row].impulse[lane];
            if self.rows.laws[row].keeps_spring[lane] == 0.0 {
                continue;
            }
            let contacts = &found.chunks[place.chunk as usize];
            let lanes = &contacts.lanes[place.lanes as usize];
            let old = place.lane as usize;
            let pair = contacts.pairs[lanes.pair[old] as usize].list_index as usize;
            let key = lanes.spring_key(old, &found.lists.chunks[place.chunk as usize].pairs[pair]);
            let stretch = vector(&self.rows.laws[row].stretch, lane);
            self.springs.push(PairSpring { stretch, ..key });
            let tangential = vector(&self.rows.rows[row].tangential_impulse, lane);
            self.contact_impulses.push(ContactImpulse { normal, tangential });
        }
        totals.slip += found.chunks.iter().flat_map(|chunk| &chunk.released).sum::<f64>();
        std::mem::swap(&mut state.pair_springs, &mut self.springs);
        std::mem::swap(&mut state.pair_impulses, &mut self.contact_impulses);
    }
}

#[inline(always)]
fn prepare_all<S: Simd>(simd: S, rows: &mut Rows, bodies: &[SolverBody], step: Step) {
    let Rows { packs, rows, laws, .. } = rows;
    for pack in packs {
        let range = pack.start as usize..pack.end as usize;
        prepare(simd, pack, (&mut rows[range.clone()], &mut laws[range]), bodies, step);
    }
}
