//! From contacts to impulses, and from impulses to states, friction springs and losses.

use std::sync::Mutex;

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::super::chunk_contacts::ChunkContacts;
use super::super::neighbour_list::NeighbourLists;
use super::super::pose::BodyPose;
use super::super::since_kick::SinceKick;
use super::bodies::{SolverBody, Velocities};
use super::colouring::Colouring;
use super::groups::{self, ContactPlace, Group};
use super::iterations::{Outcome, iterate};
use super::joints::{IteratedJoints, apply_loads};
use super::law::{Step, prepare};
use super::losses::account as account_contacts;
use super::rows::{Block, Rows, Source};
use crate::joint::JointWork;
use crate::kinematics::Kinematics;
use crate::lanes::vector;
use crate::stage::account;
use crate::{BodyForces, ContactImpulse, Model, PairSpring, RunTotals, State, Wrench};

/// Buffers of the solver. Dropping them between steps changes no result.
#[derive(Debug, Default)]
pub(crate) struct Solver {
    bodies: Vec<SolverBody>,
    velocities: Vec<Velocities>,
    places: Vec<ContactPlace>,
    groups: Vec<Group>,
    colouring: Colouring,
    rows: Rows,
    /// Impulses and torque impulses on the bodies.
    impulses: Vec<Wrench>,
    springs: Vec<PairSpring>,
    contact_impulses: Vec<ContactImpulse>,
}

/// Buffers hold nothing between steps, so that a copy needs none of it.
impl Clone for Solver {
    fn clone(&self) -> Self {
        Self::default()
    }
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
        (forces, joints): (&mut [BodyForces], &mut JointWork),
    ) -> Outcome {
        let SinceKick { step: h, time, .. } = found.since_kick;
        self.bodies.clear();
        let bodies = model.bodies.iter().zip(found.poses);
        self.bodies.extend(bodies.map(|(body, pose)| SolverBody::new(model, body, pose, time)));
        joints.set_accelerations(model, (&state.bodies, h), |body, acceleration| {
            self.bodies[body].acceleration = acceleration;
        });
        self.bodies.push(SolverBody::default());
        self.velocities.clear();
        self.velocities.extend(self.bodies.iter().map(Velocities::new));
        apply_loads(model, (found.poses, forces), &self.velocities, h);
        let count = model.bodies.len() as u32;
        groups::collect(found.chunks, found.lists, count, &mut self.places, &mut self.groups);
        self.colouring.colour(&self.groups, &self.bodies);
        self.rows.assign(&self.groups, &self.colouring);
        let step = Step { length: h, rest_speed: 2.0 * h * model.gravity.length() };
        self.prepare(found, &state.pair_impulses, step);
        let outcome = if model.joints.is_empty() {
            iterate(&self.rows, &self.velocities, model.solver, None)
        } else {
            let start = [joints.start_coordinates.as_slice(), &joints.start_rates];
            joints.kick.begin(model, state, start, h);
            let joints = Mutex::new(IteratedJoints { model, kick: &mut joints.kick });
            iterate(&self.rows, &self.velocities, model.solver, Some(&joints))
        };
        let mut totals = RunTotals {
            iterations: u64::from(outcome.iterations),
            not_converged: u64::from(!outcome.has_converged),
            ..RunTotals::default()
        };
        self.account(step, &mut totals);
        self.move_bodies(model, h, (state, forces), &mut totals);
        move_by_others(model, h, (state, forces, joints), &mut totals);
        self.store(found, state, &mut totals);
        state.totals += totals;
        outcome
    }

    /// The impulses of the latest solution on the first bodies, along and across the normals (N·s), each with chunk, lanes and lane of its
    /// contact.
    pub(in crate::contact) fn impulses(
        &self,
    ) -> impl Iterator<Item = ([usize; 3], f64, DVec3)> + '_ {
        self.places.iter().enumerate().filter_map(|(contact, place)| {
            let (normal, tangential) = self.rows.impulses(contact)?;
            let place = [place.chunk, place.lanes, place.lane].map(|index| index as usize);
            Some((place, normal, tangential))
        })
    }

    /// Fills the rows, and computes their coefficients.
    fn prepare(&mut self, found: &Found, impulses: &[ContactImpulse], step: Step) {
        let Self { bodies, velocities, places, groups, colouring, rows, .. } = self;
        let Found { chunks, poses, .. } = *found;
        let source = Source { chunks, poses, bodies, contacts: places, groups, impulses };
        rows.for_each(|block| {
            block.fill(&source, colouring);
            dispatch!(Level::new(), simd => simd.vectorize(
                #[inline(always)]
                || prepare_block(simd, block, (bodies, velocities), step)
            ));
        });
    }

    /// The energy that the contacts take, and the impulses on the bodies.
    fn account(&mut self, step: Step, totals: &mut RunTotals) {
        let Self { bodies, velocities, rows, .. } = self;
        rows.for_each(|block| {
            dispatch!(Level::new(), simd => simd.vectorize(
                #[inline(always)]
                || account_block(simd, block, (bodies, velocities), step)
            ));
        });
        self.impulses.clear();
        self.impulses.resize(self.bodies.len(), Wrench::default());
        for block in self.rows.iter_mut() {
            *totals += block.losses;
            for (pack, impulses) in block.packs.iter().zip(&block.impulses) {
                let used = pack.lengths.iter().enumerate().filter(|(_, length)| **length > 0);
                for (lane, _) in used {
                    let [force, torque, other_torque] =
                        impulses.each_ref().map(|columns| vector(columns, lane));
                    self.impulses[pack.first[lane] as usize] += Wrench { force, torque };
                    self.impulses[pack.second[lane] as usize] +=
                        Wrench { force: -force, torque: -other_torque };
                }
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
            let BodyForces { load, central_gravity, .. } = *forces;
            *forces = BodyForces { load, central_gravity, ..BodyForces::default() };
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
        for (contact, place) in self.places.iter().enumerate() {
            let Some((row, law, lane)) = self.rows.of_contact(contact) else { continue };
            if law.keeps_spring[lane] == 0.0 {
                continue;
            }
            let contacts = &found.chunks[place.chunk as usize];
            let lanes = &contacts.lanes[place.lanes as usize];
            let old = place.lane as usize;
            let pair = contacts.pairs[lanes.pair[old] as usize].list_index as usize;
            let key = lanes.spring_key(old, &found.lists.chunks[place.chunk as usize].pairs[pair]);
            self.springs.push(PairSpring { stretch: vector(&law.stretch, lane), ..key });
            self.contact_impulses.push(ContactImpulse {
                normal: row.impulse[lane],
                tangential: vector(&row.tangential_impulse, lane),
            });
        }
        totals.slip += found.chunks.iter().flat_map(|chunk| &chunk.released).sum::<f64>();
        std::mem::swap(&mut state.pair_springs, &mut self.springs);
        std::mem::swap(&mut state.pair_impulses, &mut self.contact_impulses);
    }
}

/// Applies loads and the impulses of joints over the time `h` (s). The contacts have been applied.
fn move_by_others(
    model: &Model,
    h: f64,
    (state, forces, joints): (&mut State, &mut [BodyForces], &mut JointWork),
    totals: &mut RunTotals,
) {
    if !model.joints.is_empty() {
        *totals += account(model, joints, forces, h);
    }
    let bodies = model.bodies.iter().zip(&mut state.bodies).zip(&*forces);
    for ((body, state), forces) in bodies.filter(|(_, forces)| forces.has_others()) {
        let all = forces.kick();
        if !body.is_free() {
            totals.work += h * Kinematics::new(body, state).dissipated_power(&forces.joint);
            continue;
        }
        let Wrench { force, torque } = forces.load + forces.joint;
        state.velocity += force * (h / body.mass);
        state.angular_momentum += torque * h;
        // the kick began half of its change before the middle
        let mean = Kinematics::new(body, state).at_mid_kick(&all, -h);
        totals.work -= h * mean.dissipated_power(&forces.given_load());
    }
}

#[inline(always)]
fn prepare_block<S: Simd>(
    simd: S,
    block: &mut Block,
    bodies: (&[SolverBody], &[Velocities]),
    step: Step,
) {
    let Block { packs, rows, laws, .. } = block;
    for pack in packs {
        let range = pack.start as usize..pack.end as usize;
        prepare(simd, pack, (&mut rows[range.clone()], &mut laws[range]), bodies, step);
    }
}

#[inline(always)]
fn account_block<S: Simd>(
    simd: S,
    block: &mut Block,
    bodies: (&[SolverBody], &[Velocities]),
    step: Step,
) {
    let Block { packs, rows, laws, impulses, losses, .. } = block;
    impulses.clear();
    *losses = RunTotals::default();
    for pack in packs {
        let range = pack.start as usize..pack.end as usize;
        let rows = (&rows[range.clone()], &mut laws[range]);
        let (of_pack, of_rows) = account_contacts(simd, pack, rows, bodies, step);
        impulses.push(of_pack);
        *losses += of_rows;
    }
}
