//! The description of a body.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use crate::{MaterialOverride, Motion, Shape, Surface};

/// The description of a body.
#[derive(Clone, Debug)]
pub struct Body {
    pub(super) name: Option<String>,
    pub(super) shape: Arc<Shape>,
    pub(super) mass: Mass,
    pub(super) position: Option<DVec3>,
    pub(super) orientation: DQuat,
    pub(super) velocity: Option<DVec3>,
    pub(super) angular_velocity: Option<DVec3>,
    pub(super) material: MaterialOverride,
    pub(super) surface: Surface,
    pub(super) motion: Motion,
}

/// The mass of a body, as given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mass {
    /// The total mass (kg).
    Total(f64),
    /// The mass of each particle (kg).
    Particle(f64),
}

impl Body {
    /// A body of this shape, at rest at the position of the input, with 1 kg per particle.
    pub fn new(shape: impl Into<Arc<Shape>>) -> Self {
        Self {
            name: None,
            shape: shape.into(),
            mass: Mass::Particle(1.0),
            position: None,
            orientation: DQuat::IDENTITY,
            velocity: None,
            angular_velocity: None,
            material: MaterialOverride::default(),
            surface: Surface::None,
            motion: Motion::Free,
        }
    }

    /// The name; the default is `body` and the index of the body.
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// Mass m of each particle (kg); M = N m.
    pub fn particle_mass(mut self, mass: f64) -> Self {
        self.mass = Mass::Particle(mass);
        self
    }

    /// Total mass M (kg).
    pub fn mass(mut self, mass: f64) -> Self {
        self.mass = Mass::Total(mass);
        self
    }

    /// Initial position of the centre of mass (m).
    pub fn position(mut self, position: DVec3) -> Self {
        self.position = Some(position);
        self
    }

    /// Initial orientation, about the centre of mass. It need not be normalised.
    pub fn orientation(mut self, orientation: DQuat) -> Self {
        self.orientation = orientation;
        self
    }

    /// Initial velocity v of the centre of mass (m/s). By default that of its joints, or 0.
    pub fn velocity(mut self, velocity: DVec3) -> Self {
        self.velocity = Some(velocity);
        self
    }

    /// Initial angular velocity ω, world axes (rad/s).
    pub fn angular_velocity(mut self, angular_velocity: DVec3) -> Self {
        self.angular_velocity = Some(angular_velocity);
        self
    }

    /// The material of its contacts, where it differs from the world's.
    pub fn material(mut self, material: MaterialOverride) -> Self {
        self.material = material;
        self
    }

    /// The surface for contact with other bodies; none by default.
    pub fn surface(mut self, surface: Surface) -> Self {
        self.surface = surface;
        self
    }

    /// How the body moves; by forces by default.
    pub fn motion(mut self, motion: Motion) -> Self {
        self.motion = motion;
        self
    }
}
