//! The tangential springs after the latest kick, matched with the contacts of this step.

use std::cmp::Ordering;

use glam::DVec3;

use super::context::ContactContext;
use super::pair::{contact_law, contact_particles, wall_weight};
use crate::parallel::CHUNK;
use crate::state::pair_order;
use crate::{BodyModel, ContactKind, Model, PairSpring};

/// The springs of one chunk, taken in their order.
pub(super) struct FrictionHistory<'a> {
    model: &'a Model,
    /// The springs that are not yet matched.
    old: &'a [PairSpring],
    /// Energy (J) of the springs of contacts that have ended, by body of the chunk.
    pub released: Vec<f64>,
    first_body: usize,
    /// The number of all springs up to the end of the chunk.
    end: usize,
}

impl<'a> FrictionHistory<'a> {
    /// The springs of the chunk whose first body is `first_body`; `released` is a buffer.
    pub fn new(context: &ContactContext<'a>, first_body: usize, mut released: Vec<f64>) -> Self {
        let before = |end: usize| context.springs.partition_point(|s| (s.first as usize) < end);
        released.clear();
        released.resize(CHUNK, 0.0);
        let end = before(first_body + CHUNK);
        let old = &context.springs[before(first_body)..end];
        Self { model: context.model, old, released, first_body, end }
    }

    /// The index of the spring that was taken last, among all springs.
    #[inline(always)]
    pub fn last_taken(&self) -> u32 {
        (self.end - self.old.len()) as u32 - 1
    }

    /// The stretch that the spring of a contact had; springs that sort before it are released.
    #[inline(always)]
    pub fn take(&mut self, contact: &PairSpring) -> Option<DVec3> {
        // the common case: the contact lasts and its spring is the next one
        if let Some((spring, rest)) = self.old.split_first()
            && (spring.first, spring.second) == (contact.first, contact.second)
            && (spring.particle, spring.other) == (contact.particle, contact.other)
            && spring.kind == contact.kind
        {
            self.old = rest;
            return Some(spring.stretch);
        }
        self.search(contact)
    }

    #[inline(never)]
    fn search(&mut self, contact: &PairSpring) -> Option<DVec3> {
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

    /// Releases all springs that no contact has taken.
    pub fn release_all(&mut self) {
        for spring in std::mem::take(&mut self.old) {
            self.release(spring);
        }
    }

    /// Counts the energy of a spring whose contact has ended as lost to slip.
    fn release(&mut self, spring: &PairSpring) {
        let stiffness = friction_spring(self.model, spring);
        let lost = 0.5 * stiffness * spring.stretch.length_squared();
        self.released[spring.first as usize - self.first_body] += lost;
    }
}

/// The order of two springs in the state.
fn compare(model: &Model, a: &PairSpring, b: &PairSpring) -> Ordering {
    let order = |spring: &PairSpring| pair_order(spring.first, spring.second, spring.kind);
    order(a).cmp(&order(b)).then_with(|| slots(model, a).cmp(&slots(model, b)))
}

/// Slots of the particles of a spring.
fn slots(model: &Model, spring: &PairSpring) -> (u32, u32) {
    let slot = |body: u32, index| {
        contact_particles(&model.bodies[body as usize], spring.kind).slot_of_index(index)
    };
    match spring.kind {
        ContactKind::SphereSphere => {
            (slot(spring.first, spring.particle), slot(spring.second, spring.other))
        }
        ContactKind::MeshPoint => (slot(spring.second, spring.particle), 0),
        ContactKind::SphereWall | ContactKind::PointMesh => {
            (slot(spring.first, spring.particle), 0)
        }
    }
}

/// Stiffness k_t of a spring (N/m), with the weight of its particle.
fn friction_spring(model: &Model, spring: &PairSpring) -> f64 {
    let first = &model.bodies[spring.first as usize];
    if spring.kind == ContactKind::SphereWall {
        let weight = wall_weight(first, spring.particle);
        return weight * first.contacts[spring.second as usize].friction_spring;
    }
    let second = &model.bodies[spring.second as usize];
    let weight = |body: &BodyModel| body.points().weight(spring.particle as usize);
    let weight = match spring.kind {
        ContactKind::PointMesh => weight(first),
        ContactKind::MeshPoint => weight(second),
        ContactKind::SphereWall | ContactKind::SphereSphere => 1.0,
    };
    weight * contact_law(first, second, spring.kind).friction_spring
}
