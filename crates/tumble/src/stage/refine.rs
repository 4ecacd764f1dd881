//! Steps in contact, halved until their energy adds up.
//!
//! Touching and leaving are kinks of the force, and a step across a kink is only as good as it is
//! short. A body in contact therefore advances in parts of h: a part whose energy does not add up is
//! taken back and halved, one that does may be followed by a longer one. Where contacts are springs
//! alone and drag is weak, large parts are composed of nine leaps to order six (W. Kahan & R.-C. Li,
//! Math. Comp. 66 (1997) 1089, s9odr6a), some of which go back in time; dashpots and slip cannot, so
//! there a part is one leap of order two.
//!
//! What an accepted part still leaves unaccounted for is then taken back by a correction of the step's
//! impulse along itself, which is what a discrete gradient does (O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449): small
//! errors of one sign do not add up over thousands of bounces. The tolerance still decides how small
//! they were.

use glam::DMat3;

use super::contact::{Placed, Room, Touching, contact_body};
use super::fly::fly_body;
use super::kick::kick_body;
use crate::{Batch, BodyForces, BodyModel, BodyState, FrictionSpring, Model, Tally, Wrench};

/// The smallest part of a step, as a power of one half.
const FINEST: u32 = 24;
/// Parts of at least this power of one half are composed to order six.
const COMPOSED: u32 = 4;
/// The impulse is corrected by no more than this part of itself.
const MOST_CORRECTION: f64 = 0.5;
/// Weights of the nine leaps.
const WEIGHTS: [f64; 9] = [W1, W2, W3, W4, W5, W4, W3, W2, W1];
const W1: f64 = 0.392_161_444_007_314_1;
const W2: f64 = 0.332_599_136_789_359_43;
const W3: f64 = -0.706_246_172_557_639_3;
const W4: f64 = 0.082_213_596_293_550_8;
const W5: f64 = 0.798_543_990_934_83;

/// Advances every body that may touch a wall by one step, with what a part of it leaves unaccounted for below
/// `tolerance` of the energy in play.
pub fn refine(batch: &mut Batch, tolerance: f64) {
    let Batch { model, first, bodies, springs, near, forces, next, rooms, .. } = batch;
    let room = &mut rooms[0];
    for (index, body) in model.bodies[*first..].iter().take(bodies.len()).enumerate() {
        if !near[index] {
            continue;
        }
        let mut mover = Mover {
            model,
            body,
            state: &mut bodies[index],
            springs: &mut springs[index],
            forces: &mut forces[index],
            next: &mut next[index],
            touching: &mut room.touching,
            impulse: Wrench::default(),
        };
        room.tally += mover.in_parts(&mut room.backup, tolerance);
    }
}

/// One body, and room to move it.
struct Mover<'a> {
    model: &'a Model,
    body: &'a BodyModel,
    state: &'a mut BodyState,
    springs: &'a mut Vec<FrictionSpring>,
    forces: &'a mut BodyForces,
    next: &'a mut Vec<FrictionSpring>,
    touching: &'a mut Touching,
    /// Contact's impulse over the step so far (N·s, N·m·s).
    impulse: Wrench,
}

/// Energy of one body (J).
#[derive(Clone, Copy)]
struct Account {
    kinetic: f64,
    gravitational: f64,
    elastic: f64,
}

impl Account {
    fn total(self) -> f64 {
        self.kinetic + self.gravitational + self.elastic
    }

    /// What doubles of this size cannot tell from zero.
    fn rounding(self) -> f64 {
        16.0 * f64::EPSILON * (self.kinetic + self.gravitational.abs() + self.elastic)
    }
}

impl Mover<'_> {
    fn in_parts(&mut self, backup: &mut Vec<FrictionSpring>, tolerance: f64) -> Tally {
        let mut lost = Tally::default();
        let mut start = self.account();
        let in_play = start.kinetic + start.elastic;
        // places within the step, and sizes of parts, in units of the finest part
        let whole = 1u64 << FINEST;
        let (mut at, mut size) = (0, whole);
        while at < whole {
            let (before, impulse) = (*self.state, self.impulse);
            backup.clone_from(self.springs);
            let part = self.part(size);
            let end = self.account();
            let off = end.total() + part.lost() - start.total();
            let bound = (tolerance * in_play.max(end.kinetic + end.elastic))
                .max(start.rounding() + end.rounding());
            let touched = part.max_depth > 0.0 || start.elastic > 0.0 || end.elastic > 0.0;
            lost.evaluations += part.evaluations;
            if touched && off.abs() > bound && size > 1 {
                (*self.state, self.impulse) = (before, impulse);
                self.springs.clone_from(backup);
                size /= 2;
                continue;
            }
            lost += Tally { evaluations: 0, ..part };
            self.state.energy_owed += off;
            if self.correct(-self.state.energy_owed) {
                self.state.energy_owed = 0.0;
            }
            // the correction moves nothing: only the kinetic energy is another
            start = Account { kinetic: self.kinetic_energy(), ..end };
            at += size;
            // twice as long, where that ends on a multiple of itself
            if at % (2 * size) == 0 && at + 2 * size <= whole {
                size *= 2;
            }
        }
        // what contact did over the whole step, on the average
        let (impulse, h) = (self.impulse, self.model.dt);
        self.forces.clear_contact();
        self.forces.spring = Wrench { force: impulse.force / h, torque: impulse.torque / h };
        self.forces.max_depth = lost.max_depth;
        lost
    }

    /// Adds `energy` to the kinetic energy by more or less of the step's impulse; returns whether
    /// that was possible.
    fn correct(&mut self, energy: f64) -> bool {
        let Wrench { force: push, torque: twist } = self.impulse;
        let rotation = DMat3::from_quat(self.state.orientation);
        let spin = self.body.angular_velocity(rotation, twist);
        // energy = ε (P·v + T·ω) + ε²/2 (P²/M + T·I⁻¹ T)
        let slope = push.dot(self.state.velocity) + spin.dot(self.state.angular_momentum);
        let bend = push.length_squared() / self.body.mass + twist.dot(spin);
        let root = slope * slope + 2.0 * bend * energy;
        if root <= 0.0 {
            return false;
        }
        let epsilon = 2.0 * energy / (slope + root.sqrt().copysign(slope));
        if epsilon.is_nan() || epsilon.abs() > MOST_CORRECTION {
            return false;
        }
        self.state.velocity += push * (epsilon / self.body.mass);
        self.state.angular_momentum += twist * epsilon;
        true
    }

    /// One part of the step.
    fn part(&mut self, size: u64) -> Tally {
        let h = self.model.dt * (size as f64 / (1u64 << FINEST) as f64);
        let slow = self.model.velocity_damping_stiffness / self.body.particle_mass() * h < 0.1;
        let elastic = self.body.contacts.iter().all(|law| law.is_elastic());
        if !(elastic && slow && size >> (FINEST - COMPOSED) > 0) {
            return self.leap(h);
        }
        let mut lost = Tally::default();
        for weight in WEIGHTS {
            lost += self.leap(weight * h);
        }
        lost
    }

    /// Fly – push – fly.
    fn leap(&mut self, h: f64) -> Tally {
        let mut lost = self.fly(0.5 * h);
        let room = Room { forces: self.forces, next: self.next, touching: self.touching };
        contact_body(self.model, self.body, self.state, self.springs, room, h);
        lost += kick_body(self.body, self.state, self.forces, h);
        let kick = self.forces.contact();
        self.impulse += Wrench { force: kick.force * h, torque: kick.torque * h };
        std::mem::swap(self.springs, self.next);
        lost += self.fly(0.5 * h);
        lost
    }

    fn fly(&mut self, h: f64) -> Tally {
        let drag = fly_body(self.model, self.body, self.state, h);
        Tally { drag, ..Tally::default() }
    }

    fn kinetic_energy(&self) -> f64 {
        Placed::new(self.body, self.state).kinetic_energy(self.state.angular_momentum)
    }

    fn account(&self) -> Account {
        let place = Placed::new(self.body, self.state);
        Account {
            kinetic: place.kinetic_energy(self.state.angular_momentum),
            gravitational: -self.body.mass * self.model.gravity.dot(self.state.position),
            elastic: place.elastic_energy(self.model, self.springs),
        }
    }
}
