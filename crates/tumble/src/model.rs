//! What stays the same during a run.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::flight::DragModes;
use crate::shape::Shape;
use crate::wall::WallPlane;
use crate::{BodyState, ContactLaw, Motion, PairMaterial, SignedDistance, Surface};

/// How a step advances time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Fly – push – fly: exact flight for half a step, a kick by the contact forces at that place,
    /// exact flight for the other half. Second order, symplectic where the forces are conservative.
    #[default]
    Splitting,
    /// The basic system, lines 2 to 9 in their order, explicit in rotation.
    Euler,
}

impl Integrator {
    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Splitting => "splitting",
            Self::Euler => "euler",
        }
    }
}

/// Everything that is constant during a run. Built and checked by [`WorldBuilder`](crate::WorldBuilder).
#[derive(Clone, Debug)]
pub struct Model {
    /// Gravity g (m/s²).
    pub gravity: DVec3,
    /// Drag c of the medium on every particle, F = −c v (N·s/m).
    pub velocity_damping_stiffness: f64,
    /// Time step h (s).
    pub dt: f64,
    /// How a step advances time.
    pub integrator: Integrator,
    /// Refine steps in contact until the energy that a part of them leaves unaccounted for is
    /// below this part of the energy in play.
    pub energy_tolerance: Option<f64>,
    /// The walls; none is free space.
    pub walls: Vec<WallPlane>,
    /// The smallest distance between two walls that face each other (m).
    pub wall_gap: Option<f64>,
    /// Whether there is a body that others can meet.
    pub has_body_contact: bool,
    /// One entry a body; bodies that are alike share theirs, so that it is at hand when the next of them is looked at.
    pub bodies: Vec<Arc<BodyModel>>,
    /// The names of the bodies.
    pub names: Vec<String>,
}

/// What is constant about one body, and about all that are like it.
#[derive(Clone, Debug)]
pub struct BodyModel {
    /// Its particles and mass distribution; with weights where any of its contacts is stiff per area.
    pub shape: Arc<Shape>,
    /// Mass M (kg).
    pub mass: f64,
    /// Inertia tensor I₀ about the centre of mass, body axes (kg·m²).
    pub inertia: DMat3,
    /// I₀⁻¹, with zero along axes that carry no inertia (1/(kg·m²)).
    pub inverse_inertia: DMat3,
    /// The principal moments of `inverse_inertia`, in the order of the shape's principal axes.
    pub inverse_moments: DVec3,
    /// How drag slows the body where its mass is not carried by equal particles.
    pub drag_modes: Option<Box<DragModes>>,
    /// The contact law against each wall, in the order of [`Model::walls`].
    pub contacts: Vec<ContactLaw>,
    /// Whether any of these contacts has friction.
    pub has_friction: bool,
    /// Whether the force of any of these contacts depends on velocity.
    pub is_damped: bool,
    /// What it brings into contacts with other bodies.
    pub pair_material: PairMaterial,
    /// Particles, spheres and mesh are within this distance of the centre of mass (m).
    pub extent: f64,
    /// What other bodies meet of it.
    pub surface: Surface,
    /// The distance to its mesh, where that is its surface.
    pub signed_distance: Option<Arc<SignedDistance>>,
    /// What moves it.
    pub motion: Motion,
}

impl BodyModel {
    /// Line 7: ω = R I₀⁻¹ Rᵀ L, with `rotation` = R (rad/s, world axes).
    #[inline]
    pub fn angular_velocity(&self, rotation: DMat3, angular_momentum: DVec3) -> DVec3 {
        let inverse = self.inverse_moments;
        if inverse.x == inverse.y && inverse.y == inverse.z {
            return angular_momentum * inverse.x;
        }
        rotation * (self.inverse_inertia * (rotation.transpose() * angular_momentum))
    }

    /// Line 7: the place xᵢ = x + R rᵢ (m) and velocity vᵢ = v + ω × R rᵢ (m/s) of one particle.
    ///
    /// # Panics
    /// When the body has no particle of that index.
    pub fn particle(&self, state: &BodyState, index: usize) -> (DVec3, DVec3) {
        let rotation = DMat3::from_quat(state.orientation);
        let arm = rotation * self.shape.particles().get(index);
        let omega = self.angular_velocity(rotation, state.angular_momentum);
        (state.position + arm, state.velocity + omega.cross(arm))
    }

    /// Whether forces move it.
    pub fn is_free(&self) -> bool {
        self.motion == Motion::Free
    }

    /// Whether walls meet spheres about its particles instead of the particles themselves.
    pub fn has_spheres(&self) -> bool {
        matches!(self.surface, Surface::Spheres { .. })
    }

    /// No particle is farther from the centre of mass than this (m), whatever rounding does.
    pub fn bounding_radius(&self) -> f64 {
        self.shape.radius() * (1.0 + 1e-9)
    }

    /// The mass of one particle, m = M/N (kg).
    pub fn particle_mass(&self) -> f64 {
        self.mass / self.shape.moments().count
    }
}
