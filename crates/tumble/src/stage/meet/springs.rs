//! The tangential springs between bodies, from one kick to the next.

use std::cmp::Ordering;

use glam::DVec3;

use super::find::Moment;
use super::list;
use crate::parallel::CHUNK;
use crate::state::pair_order;
use crate::{BodyModel, ContactKind, Model, PairSpring};

/// The springs of the latest kick, taken in their order.
pub(super) struct OldSprings<'a> {
    model: &'a Model,
    old: &'a [PairSpring],
    /// Energy (J) of those that have come loose, by body of the chunk.
    pub released: Vec<f64>,
    body: usize,
}

impl<'a> OldSprings<'a> {
    /// Those of the chunk whose first body is number `body`, none released; `released` is room.
    pub fn of_chunk(moment: &Moment<'a>, body: usize, mut released: Vec<f64>) -> Self {
        let before = |end: usize| moment.springs.partition_point(|s| (s.first as usize) < end);
        released.clear();
        released.resize(CHUNK, 0.0);
        let old = &moment.springs[before(body)..before(body + CHUNK)];
        Self { model: moment.model, old, released, body }
    }

    /// The stretch that the spring of a contact had; springs that come before it are released.
    #[inline(always)]
    pub fn take(&mut self, contact: &PairSpring) -> Option<DVec3> {
        // most springs go on
        if let Some((spring, rest)) = self.old.split_first()
            && (spring.first, spring.second) == (contact.first, contact.second)
            && (spring.particle, spring.other) == (contact.particle, contact.other)
            && spring.kind == contact.kind
        {
            self.old = rest;
            return Some(spring.stretch);
        }
        self.look_for(contact)
    }

    #[inline(never)]
    fn look_for(&mut self, contact: &PairSpring) -> Option<DVec3> {
        while let Some((spring, rest)) = self.old.split_first() {
            let order = compare(self.model, spring, contact);
            if order == Ordering::Greater {
                break;
            }
            self.old = rest;
            if order == Ordering::Equal {
                return Some(spring.stretch);
            }
            self.release(spring);
        }
        None
    }

    /// Releases all that no contact has asked for.
    pub fn release_all(&mut self) {
        for spring in std::mem::take(&mut self.old) {
            self.release(spring);
        }
    }

    /// What is left in a spring is lost.
    fn release(&mut self, spring: &PairSpring) {
        let stiffness = friction_spring(self.model, spring);
        let lost = 0.5 * stiffness * spring.stretch.length_squared();
        self.released[spring.first as usize - self.body] += lost;
    }
}

/// Which of two springs comes first.
fn compare(model: &Model, a: &PairSpring, b: &PairSpring) -> Ordering {
    let pair = |spring: &PairSpring| pair_order(spring.first, spring.second, spring.kind);
    pair(a).cmp(&pair(b)).then_with(|| slots(model, a).cmp(&slots(model, b)))
}

/// Where the shapes keep the particles of a spring.
fn slots(model: &Model, spring: &PairSpring) -> (u32, u32) {
    let slot = |body: u32, index| model.bodies[body as usize].shape.particles().slot_of(index);
    match spring.kind {
        ContactKind::Spheres => {
            (slot(spring.first, spring.particle), slot(spring.second, spring.other))
        }
        ContactKind::SecondInFirst => (slot(spring.second, spring.particle), 0),
        ContactKind::Wall | ContactKind::FirstInSecond => (slot(spring.first, spring.particle), 0),
    }
}

/// k_t of a spring (N/m), with the weight of its particle.
fn friction_spring(model: &Model, spring: &PairSpring) -> f64 {
    let first = &model.bodies[spring.first as usize];
    if spring.kind == ContactKind::Wall {
        return first.contacts[spring.second as usize].friction_spring;
    }
    let second = &model.bodies[spring.second as usize];
    let weight = |body: &BodyModel| body.shape.particles().weight(spring.particle as usize);
    let weight = match spring.kind {
        ContactKind::FirstInSecond => weight(first),
        ContactKind::SecondInFirst => weight(second),
        ContactKind::Wall | ContactKind::Spheres => 1.0,
    };
    weight * list::law(first, second, spring.kind).friction_spring
}
