//! Forces and torques on bodies.

use glam::DVec3;

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

/// The forces on one body, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyForces {
    /// Weight.
    pub gravity: Wrench,
    /// Drag of the medium.
    pub drag: Wrench,
    /// Normal springs of all contacts, and tangential springs of contacts with other bodies. After adaptive sub-steps: the
    /// whole contact wrench, averaged over the step.
    pub spring: Wrench,
    /// Dashpots of all contacts, normal and tangential.
    pub dashpot: Wrench,
    /// Tangential springs of contacts with walls.
    pub friction: Wrench,
    /// Loads and central gravity.
    pub load: Wrench,
    /// The part of `load` that is central gravity: its work is the loss of gravitational energy.
    pub central_gravity: Wrench,
    /// Joints in the kick.
    pub joint: Wrench,
    /// Energy that slipping and released friction springs lose in this evaluation (J).
    pub slip_loss: f64,
    /// Power that moving surfaces (conveyor belts) put in through the contacts of this body (W).
    pub surface_power: f64,
    /// The part of `surface_power` that dashpots dissipate (W).
    pub surface_dashpot_power: f64,
    /// Penetration depth of the deepest contact (m); 0 without contact.
    pub max_depth: f64,
}

impl BodyForces {
    /// Lines 3 and 4 of the basic system: total force F = Σ fᵢ and torque τ = Σ (xᵢ − x) × fᵢ, as the sum over causes. The stages have
    /// summed over the particles.
    pub fn total(&self) -> Wrench {
        self.gravity + self.drag + self.kick()
    }

    /// The wrench of the kick: contact, loads and joints.
    pub fn kick(&self) -> Wrench {
        if self.has_others() { self.contact() + (self.load + self.joint) } else { self.contact() }
    }

    /// The wrench of contact and joints.
    pub(crate) fn of_others(&self) -> Wrench {
        if self.has_others() { self.contact() + self.joint } else { self.contact() }
    }

    /// The wrench of loads without central gravity.
    pub(crate) fn given_load(&self) -> Wrench {
        self.load - self.central_gravity
    }

    /// Whether loads or joints act.
    pub(crate) fn has_others(&self) -> bool {
        self.load != Wrench::default() || self.joint != Wrench::default()
    }

    /// The contact wrench: springs, dashpots and friction of all contacts with walls and bodies.
    pub fn contact(&self) -> Wrench {
        self.spring + self.dashpot + self.friction
    }

    /// Sets everything that contacts contribute to zero.
    pub(crate) fn clear_contact(&mut self) {
        let none = Wrench::default();
        (self.spring, self.dashpot, self.friction) = (none, none, none);
        (self.slip_loss, self.max_depth) = (0.0, 0.0);
        (self.surface_power, self.surface_dashpot_power) = (0.0, 0.0);
    }
}
