//! The model: everything that is constant during a run.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::flight::DragModes;
use crate::shape::Shape;
use crate::wall::WallPlane;
use crate::{
    BodyState, ContactLaw, ContactPoints, Joints, Loads, Motion, PairMaterial, Particles,
    SignedDistance, Surface,
};

/// The time integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Drift – kick – drift: exact free flight for half a step, a kick by the contact forces at the midpoint,
    /// and exact free flight for the other half. Second order; symplectic for conservative forces.
    #[default]
    Splitting,
    /// The basic system, lines 2 to 9 in order: semi-implicit Euler, explicit in rotation.
    Euler,
    /// As [`Integrator::Splitting`], but the kick satisfies the contact law at the end of the step: stable at any step.
    Implicit,
}

impl Integrator {
    /// The longest step (s) for which [`Integrator::Implicit`] is meant.
    pub const LONGEST_IMPLICIT_DT: f64 = 1.0 / 60.0;

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Splitting => "splitting",
            Self::Euler => "euler",
            Self::Implicit => "implicit",
        }
    }

    /// Whether a step is flight, kick and flight.
    pub fn kicks(self) -> bool {
        self != Self::Euler
    }
}

/// When the iterations of [`Integrator::Implicit`] end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverSettings {
    /// The relative change of the impulses in the last iteration.
    pub tolerance: f64,
    /// The largest number of iterations in a step. Steps that end so are counted in
    /// [`RunTotals::not_converged`](crate::RunTotals::not_converged).
    pub max_iterations: u32,
}

impl Default for SolverSettings {
    fn default() -> Self {
        Self { tolerance: 1e-4, max_iterations: 100 }
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
    /// The time integrator.
    pub integrator: Integrator,
    /// When the iterations of the integrator `Implicit` end.
    pub solver: SolverSettings,
    /// Steps in contact are refined until the energy error of each substep is below this fraction of the energy in
    /// the contact; `None` disables refinement.
    pub energy_tolerance: Option<f64>,
    /// Whether `dt` is at most the critical step of the explicit integrators.
    pub resolves_contacts: bool,
    /// The walls.
    pub walls: Vec<WallPlane>,
    /// The smallest distance between two opposite walls (m).
    pub wall_gap: Option<f64>,
    /// Whether bodies act on each other within a step: any has a surface for contact with other bodies, all contacts are solved together,
    /// or there are joints or loads.
    pub has_body_contact: bool,
    /// One entry per body. Identical bodies share an entry, which improves the use of caches.
    pub bodies: Vec<Arc<BodyModel>>,
    /// The names of the bodies.
    pub names: Vec<String>,
    /// The joints.
    pub joints: Joints,
    /// The loads.
    pub loads: Loads,
}

/// The constant data of a body, shared by identical bodies.
#[derive(Clone, Debug)]
pub struct BodyModel {
    /// Particles and mass distribution; with area weights if any of its contacts has a stiffness per area.
    pub shape: Arc<Shape>,
    /// Mass M (kg).
    pub mass: f64,
    /// Inertia tensor I₀ about the centre of mass, body axes (kg·m²).
    pub inertia: DMat3,
    /// I₀⁻¹, with zero along axes without inertia (1/(kg·m²)).
    pub inverse_inertia: DMat3,
    /// The eigenvalues of `inverse_inertia`, in the order of the shape's principal axes.
    pub inverse_moments: DVec3,
    /// The modes of drag, if the mass is not carried by equal particles.
    pub drag_modes: Option<Box<DragModes>>,
    /// The contact law with each wall, in the order of [`Model::walls`].
    pub contacts: Vec<ContactLaw>,
    /// Whether any of these contacts has friction.
    pub has_friction: bool,
    /// Whether any of these contacts has forces that depend on velocity.
    pub is_damped: bool,
    /// The parameters of contacts with other bodies.
    pub pair_material: PairMaterial,
    /// The bounding radius of particles, spheres and mesh about the centre of mass (m).
    pub extent: f64,
    /// The surface for contact with other bodies.
    pub surface: Surface,
    /// The signed distance to its mesh, if that is its surface.
    pub signed_distance: Option<Arc<SignedDistance>>,
    /// The points at which it touches other bodies, if its surface is its mesh; else its particles touch.
    pub contact_points: Option<Arc<ContactPoints>>,
    /// How the body moves.
    pub motion: Motion,
}

impl Model {
    /// Whether there are joints or loads.
    pub(crate) fn has_joints_or_loads(&self) -> bool {
        !self.joints.is_empty() || !self.loads.is_empty()
    }
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

    /// Line 7: the position xᵢ = x + R rᵢ (m) and velocity vᵢ = v + ω × R rᵢ (m/s) of one particle.
    ///
    /// # Panics
    /// If the index is out of range.
    pub fn particle(&self, state: &BodyState, index: usize) -> (DVec3, DVec3) {
        let rotation = DMat3::from_quat(state.orientation);
        let arm = rotation * self.shape.particles().get(index);
        let omega = self.angular_velocity(rotation, state.angular_momentum);
        (state.position + arm, state.velocity + omega.cross(arm))
    }

    /// The points at which the body touches the meshes of other bodies, in the body frame.
    pub(crate) fn points(&self) -> &Particles {
        let particles = self.shape.particles();
        self.contact_points.as_ref().map_or(particles, |points| points.points(&self.shape))
    }

    /// Whether the body moves by forces.
    pub fn is_free(&self) -> bool {
        self.motion == Motion::Free
    }

    /// Whether the body is a clump of spheres.
    pub fn has_spheres(&self) -> bool {
        matches!(self.surface, Surface::Spheres { .. })
    }

    /// The bounding radius of the particles about the centre of mass (m), with a margin for rounding.
    pub fn bounding_radius(&self) -> f64 {
        self.shape.radius() * (1.0 + 1e-9)
    }

    /// The mass of one particle, m = M/N (kg).
    pub fn particle_mass(&self) -> f64 {
        self.mass / self.shape.moments().count
    }
}
