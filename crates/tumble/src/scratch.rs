//! What a step computes and forgets.

use glam::DVec3;

use crate::FrictionSpring;
use crate::batch::Room;
use crate::parallel::CHUNK;
use crate::stage::Meeting;

/// Room for what is derived within a step of one model. Dropping it between steps changes no result.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Which bodies may touch a wall or another body within the step.
    pub near: Vec<bool>,
    /// Forces and torques of the latest evaluation, one entry a body.
    pub forces: Vec<BodyForces>,
    /// The friction springs that go on from this evaluation, one list a body.
    pub springs: Vec<Vec<FrictionSpring>>,
    /// Room for batches of bodies.
    pub(crate) rooms: Vec<Room>,
    /// Contacts between bodies.
    pub(crate) meeting: Meeting,
}

impl Scratch {
    /// Room for `body_count` bodies; allocates only when it was another number before. What is in it is left as it is:
    /// each stage writes what it owns before another reads it.
    pub(crate) fn fit(&mut self, body_count: usize) {
        if self.forces.len() != body_count {
            self.forces.resize(body_count, BodyForces::default());
            self.springs.resize_with(body_count, Vec::new);
            self.near.resize(body_count, true);
            self.rooms.resize_with(body_count.div_ceil(CHUNK), Room::default);
        }
    }
}

/// A force and a torque about the centre of mass, world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force F (N).
    pub force: DVec3,
    /// Torque τ about the centre of mass (N·m).
    pub torque: DVec3,
}

impl std::ops::Add for Wrench {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl std::ops::Sub for Wrench {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { force: self.force - other.force, torque: self.torque - other.torque }
    }
}

impl std::ops::AddAssign for Wrench {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// What acts on one body, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyForces {
    /// Weight.
    pub gravity: Wrench,
    /// Drag of the medium.
    pub drag: Wrench,
    /// The normal springs of contacts, and the tangential ones of those with other bodies; after refined steps, all that contacts did, averaged over the step.
    pub spring: Wrench,
    /// The dashpots of contacts, normal and tangential.
    pub dashpot: Wrench,
    /// The tangential springs of contacts.
    pub friction: Wrench,
    /// Energy that slipping and released friction springs lose in this evaluation (J).
    pub slip: f64,
    /// What surfaces that move along themselves put in through the contacts of this body (W).
    pub belt_power: f64,
    /// What dashpots take of that (W).
    pub belt_loss: f64,
    /// Depth of the deepest particle in contact (m), 0 in flight.
    pub max_depth: f64,
}

impl BodyForces {
    /// Lines 3 and 4: total force F = Σ fᵢ and total torque τ = Σ (xᵢ − x) × fᵢ.
    pub fn total(&self) -> Wrench {
        self.gravity + self.drag + self.contact()
    }

    /// What walls and other bodies do, by spring, dashpot and friction together.
    pub fn contact(&self) -> Wrench {
        self.spring + self.dashpot + self.friction
    }

    /// Forgets the walls.
    pub(crate) fn clear_contact(&mut self) {
        let none = Wrench::default();
        (self.spring, self.dashpot, self.friction) = (none, none, none);
        (self.slip, self.max_depth) = (0.0, 0.0);
        (self.belt_power, self.belt_loss) = (0.0, 0.0);
    }
}
