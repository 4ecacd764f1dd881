//! Contacts with friction: each particle has a spring of its own, with an anchor that it remembers.
//!
//! *Find* lists the particles behind a wall and the springs they had; *push* computes their forces, eight
//! at a time, as often as the velocities change; *keep* writes down the springs that go on.

use std::cmp::Ordering;

use fearless_simd::{Simd, dispatch, f64x8, prelude::*};
use glam::DVec3;

use super::placed::{NearWall, Placed};
use crate::lanes::{Columns, LANES, Vec3x8, largest, positive, set, sum, vector};
use crate::{BodyForces, ContactLaw, FrictionSpring, Model, Particles, Wrench};

/// The particles of one body that touch walls with friction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Touching {
    /// Room for the slots behind one wall.
    slots: Vec<u32>,
    /// The contacts, wall by wall, each wall's in the order of the slots.
    contacts: Vec<Eight>,
    /// Energy (J) of springs whose particles have left.
    released: f64,
    /// Energy (J) that the latest push loses to slip.
    slipped: f64,
}

/// Up to eight contacts with one wall, one a lane. A lane without a contact has depth zero.
#[derive(Clone, Debug, Default)]
struct Eight {
    wall: u32,
    count: u32,
    particle: [u32; LANES],
    /// Depth δ (m).
    depth: [f64; LANES],
    /// From the centre of mass to the particle, R r (m).
    arm: Columns,
    /// Where the spring was anchored before this push (m).
    anchor: Columns,
    /// Its stretch at the latest kick (m).
    before: Columns,
    /// The stretch that the limit lets it keep (m).
    held: Columns,
    /// Whether that is less than it had, a bit a lane.
    slips: u64,
}

impl Touching {
    /// Lists the contacts of a body with walls that have friction. `old` are its springs so far.
    pub fn find(&mut self, model: &Model, place: &Placed, old: &[FrictionSpring]) {
        self.contacts.clear();
        self.released = 0.0;
        if !place.body.has_friction && old.is_empty() {
            return;
        }
        let mut springs = OldSprings { place, model, old, released: 0.0 };
        let particles = place.body.shape.particles();
        for (index, (wall, law)) in model.walls.iter().zip(&place.body.contacts).enumerate() {
            let near = NearWall::of(wall, place).filter(|_| law.friction > 0.0);
            let Some(near) = near else { continue };
            self.slots.clear();
            particles.list_positive(place.level, &near.depth, &mut self.slots);
            let (slots, contacts) = (&self.slots, &mut self.contacts);
            dispatch!(place.level, simd => springs.load(simd, index as u32, &near, slots, contacts));
        }
        springs.release_all();
        self.released = springs.released;
    }

    /// Adds the forces of all contacts with the velocities of `place`.
    pub fn push(&mut self, model: &Model, place: &Placed, forces: &mut BodyForces) {
        self.slipped = 0.0;
        for eights in self.contacts.chunk_by_mut(|a, b| a.wall == b.wall) {
            let wall = eights[0].wall as usize;
            let push =
                Push { place, normal: model.walls[wall].normal, law: place.body.contacts[wall] };
            dispatch!(place.level, simd => push.all(simd, eights, forces, &mut self.slipped));
        }
        forces.slip = self.released + self.slipped;
    }

    /// The springs that go on after the latest push.
    pub fn keep(&self, place: &Placed, next: &mut Vec<FrictionSpring>) {
        for eight in &self.contacts {
            for lane in 0..eight.count as usize {
                let stretch = vector(&eight.held, lane);
                // an anchor that holds stays as it is, to the last bit
                let anchor = if eight.slips >> lane & 1 == 1 {
                    place.position + vector(&eight.arm, lane) - stretch
                } else {
                    vector(&eight.anchor, lane)
                };
                let particle = eight.particle[lane];
                next.push(FrictionSpring { wall: eight.wall, particle, anchor, stretch });
            }
        }
    }
}

impl Eight {
    /// What its particles weigh; lanes without a contact have no force to weigh.
    fn weights(&self, particles: &Particles) -> [f64; LANES] {
        let mut weights = [0.0; LANES];
        for (weight, &particle) in weights.iter_mut().zip(&self.particle[..self.count as usize]) {
            *weight = particles.weight(particle as usize);
        }
        weights
    }
}

/// The springs of before, sorted by wall and slot, those already met taken off the front.
struct OldSprings<'a> {
    place: &'a Placed<'a>,
    model: &'a Model,
    old: &'a [FrictionSpring],
    released: f64,
}

impl OldSprings<'_> {
    /// Contacts with one wall, with the springs that they had.
    #[inline(always)]
    fn load<S: Simd>(
        &mut self,
        simd: S,
        wall: u32,
        near: &NearWall,
        slots: &[u32],
        contacts: &mut Vec<Eight>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                for slots in slots.chunks(LANES) {
                    let mut eight = Eight { wall, count: slots.len() as u32, ..Eight::default() };
                    self.place_eight(simd, near, slots, &mut eight);
                    for (lane, &slot) in slots.iter().enumerate() {
                        if let Some(old) = self.take(wall, slot, eight.particle[lane]) {
                            set(&mut eight.anchor, lane, old.anchor);
                            set(&mut eight.before, lane, old.stretch);
                        }
                    }
                    contacts.push(eight);
                }
            },
        );
    }

    /// Where the particles are, each with an anchor right there.
    #[inline(always)]
    fn place_eight<S: Simd>(&self, simd: S, near: &NearWall, slots: &[u32], eight: &mut Eight) {
        let (place, particles) = (self.place, self.place.body.shape.particles());
        for (lane, &slot) in slots.iter().enumerate() {
            set(&mut eight.arm, lane, particles.at(slot));
            eight.particle[lane] = particles.index_in(slot);
        }
        let r = Vec3x8::load(simd, &eight.arm);
        let slope = Vec3x8::splat(simd, near.depth.slope);
        eight.depth = (f64x8::splat(simd, near.depth.offset) - slope.dot(r)).into();
        eight.depth[slots.len()..].fill(0.0);
        let arm = r.turned(simd, place.rotation);
        eight.arm = arm.store();
        eight.anchor = (Vec3x8::splat(simd, place.position) + arm).store();
    }

    /// The spring that this contact had before; those passed over on the way have come free.
    fn take(&mut self, wall: u32, slot: u32, particle: u32) -> Option<FrictionSpring> {
        while let Some((first, rest)) = self.old.split_first() {
            if (first.wall, first.particle) == (wall, particle) {
                self.old = rest;
                return Some(*first);
            }
            let its_slot = self.place.body.shape.particles().slot_of(first.particle);
            if (first.wall, its_slot).cmp(&(wall, slot)) == Ordering::Greater {
                return None;
            }
            self.release(first);
            self.old = rest;
        }
        None
    }

    /// The springs that no contact has asked for have come free.
    fn release_all(&mut self) {
        for spring in std::mem::take(&mut self.old) {
            self.release(spring);
        }
    }

    /// A spring whose particle has left is gone, and what it held is lost to slip.
    fn release(&mut self, spring: &FrictionSpring) {
        let law = &self.place.body.contacts[spring.wall as usize];
        let stretch = self.place.stretch(self.model, spring);
        let weight = self.place.body.shape.particles().weight(spring.particle as usize);
        self.released += 0.5 * law.friction_spring * spring.stretch.dot(stretch) * weight;
    }
}

/// Contacts of a body with one wall.
struct Push<'a> {
    place: &'a Placed<'a>,
    normal: DVec3,
    law: ContactLaw,
}

/// What the particles of eight contacts weigh; where none does, nothing is multiplied.
struct Weights<S: Simd, const WEIGHTED: bool>(f64x8<S>);

impl<S: Simd, const WEIGHTED: bool> Weights<S, WEIGHTED> {
    #[inline(always)]
    fn of(&self, lanes: f64x8<S>) -> f64x8<S> {
        if WEIGHTED { lanes * self.0 } else { lanes }
    }

    #[inline(always)]
    fn of_vector(&self, lanes: Vec3x8<S>) -> Vec3x8<S> {
        if WEIGHTED { lanes * self.0 } else { lanes }
    }
}

/// Sums over the contacts, eight side by side.
struct Sums<S: Simd> {
    spring: f64x8<S>,
    spring_arm: Vec3x8<S>,
    push: f64x8<S>,
    push_arm: Vec3x8<S>,
    hold: Vec3x8<S>,
    hold_torque: Vec3x8<S>,
    brake: Vec3x8<S>,
    brake_torque: Vec3x8<S>,
    slip: f64x8<S>,
    deepest: f64x8<S>,
}

impl Push<'_> {
    #[inline(always)]
    fn all<S: Simd>(
        &self,
        simd: S,
        eights: &mut [Eight],
        forces: &mut BodyForces,
        slipped: &mut f64,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut sums = Sums::zero(simd);
                let particles = self.place.body.shape.particles();
                if particles.is_weighted() {
                    for eight in eights {
                        let weights = eight.weights(particles);
                        self.eight::<S, true>(simd, eight, weights, &mut sums);
                    }
                } else {
                    for eight in eights {
                        self.eight::<S, false>(simd, eight, [1.0; LANES], &mut sums);
                    }
                }
                *slipped += sum(sums.slip);
                sums.give(self.normal, forces);
            },
        );
    }

    /// Every force of a particle that weighs w is w times that of the mean particle, the limit of friction
    /// too, so that what slips and what holds does not depend on it.
    #[inline(always)]
    fn eight<S: Simd, const WEIGHTED: bool>(
        &self,
        simd: S,
        eight: &mut Eight,
        weights: [f64; LANES],
        sums: &mut Sums<S>,
    ) {
        let (place, law) = (self.place, &self.law);
        let weights = Weights::<S, WEIGHTED>(f64x8::simd_from(simd, weights));
        let n = Vec3x8::splat(simd, self.normal);
        let arm = Vec3x8::load(simd, &eight.arm);
        let depth = f64x8::simd_from(simd, eight.depth);
        let u = Vec3x8::splat(simd, place.velocity)
            + Vec3x8::splat(simd, place.angular_velocity).cross(arm);

        // along the normal: spring and dashpot, whose sum never pulls
        let spring = depth * law.stiffness;
        let push = positive(simd, spring - u.dot(n) * law.damping);
        let push = depth.simd_gt(f64x8::splat(simd, 0.0)).select(push, spring);
        let (its_spring, its_push) = (weights.of(spring), weights.of(push));
        sums.spring += its_spring;
        sums.spring_arm += arm * its_spring;
        sums.push += its_push;
        sums.push_arm += arm * its_push;
        sums.deepest = sums.deepest.simd_gt(depth).select(sums.deepest, depth);

        // along the wall: a spring to the anchor, as much of it as the limit lets hold
        let limit = push * law.friction;
        let here = Vec3x8::splat(simd, place.position) + arm;
        let stretch = (here - Vec3x8::load(simd, &eight.anchor)).across(n);
        let pull = stretch.dot(stretch).sqrt() * law.friction_spring;
        let beyond = pull.simd_gt(limit);
        let kept = beyond.select(limit / pull, f64x8::splat(simd, 1.0));
        let held = stretch * kept;
        let lost = (Vec3x8::load(simd, &eight.before) + held).dot(stretch - held);
        sums.slip += weights.of(lost * (0.5 * law.friction_spring));
        let hold = held * f64x8::splat(simd, -law.friction_spring);
        let its_hold = weights.of_vector(hold);
        sums.hold += its_hold;
        sums.hold_torque += arm.cross(its_hold);
        eight.held = held.store();
        eight.slips = beyond.to_bitmask();

        // and a dashpot within what the spring leaves of the limit
        let brake = u.across(n) * f64x8::splat(simd, -law.friction_damping);
        let brake = weights.of_vector(brake * within(simd, hold, brake, limit));
        sums.brake += brake;
        sums.brake_torque += arm.cross(brake);
    }
}

/// The largest part, up to one, of `brake` that can be added to `hold` without the sum being longer than `limit`.
#[inline(always)]
pub(in crate::stage) fn within<S: Simd>(
    simd: S,
    hold: Vec3x8<S>,
    brake: Vec3x8<S>,
    limit: f64x8<S>,
) -> f64x8<S> {
    // the larger root of |hold + β brake|² = limit²
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let a = brake.dot(brake);
    let b = hold.dot(brake);
    let room = positive(simd, limit * limit - hold.dot(hold));
    let root = positive(simd, b * b + a * room).sqrt();
    let beta = positive(simd, (root - b) / a);
    let beta = beta.simd_lt(one).select(beta, one);
    a.simd_gt(zero).select(beta, zero)
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let none = Vec3x8::splat(simd, DVec3::ZERO);
        Self {
            spring: zero,
            spring_arm: none,
            push: zero,
            push_arm: none,
            hold: none,
            hold_torque: none,
            brake: none,
            brake_torque: none,
            slip: zero,
            deepest: zero,
        }
    }

    /// Adds the sums of forces along `normal` and along the wall.
    #[inline(always)]
    fn give(&self, normal: DVec3, forces: &mut BodyForces) {
        let spring = along(normal, sum(self.spring), self.spring_arm.sum());
        let push = along(normal, sum(self.push), self.push_arm.sum());
        forces.spring += spring;
        forces.dashpot += push - spring;
        forces.dashpot += Wrench { force: self.brake.sum(), torque: self.brake_torque.sum() };
        forces.friction += Wrench { force: self.hold.sum(), torque: self.hold_torque.sum() };
        forces.max_depth = forces.max_depth.max(largest(self.deepest));
    }
}

/// Forces f n at arms a, from Σ f and Σ f a.
fn along(normal: DVec3, sum: f64, arm: DVec3) -> Wrench {
    Wrench { force: normal * sum, torque: arm.cross(normal) }
}
