//! The description of a world.

use std::sync::Arc;

use glam::DVec3;

use super::body::Body;
use crate::{
    BodyView, CentralGravity, ForceFunction, Integrator, Joint, Load, Material, MaterialOverride,
    Overlaps, SolverSettings, WallBox, WallPlane, Wrench,
};

/// The description of a world; [`WorldBuilder::build`] checks it and makes the world.
#[derive(Clone, Debug)]
pub struct WorldBuilder {
    pub(super) gravity: DVec3,
    pub(super) velocity_damping_stiffness: f64,
    pub(super) dt: f64,
    pub(super) integrator: Integrator,
    pub(super) solver: SolverSettings,
    pub(super) energy_tolerance: Option<f64>,
    pub(super) force: bool,
    pub(super) material: Material,
    pub(super) overlaps: Overlaps,
    pub(super) accept_start_in_walls: bool,
    pub(super) walls: Vec<(WallPlane, MaterialOverride)>,
    pub(super) bodies: Vec<Body>,
    pub(super) joints: Vec<Joint>,
    pub(super) loads: Vec<Load>,
    pub(super) force_functions: Vec<ForceFunction>,
    pub(super) central_gravity: Option<CentralGravity>,
}

impl Default for WorldBuilder {
    /// Gravity and time step of the basic system, without walls.
    fn default() -> Self {
        Self {
            gravity: DVec3::new(0.0, -9.8, 0.0),
            velocity_damping_stiffness: 0.0,
            dt: 1e-3,
            integrator: Integrator::default(),
            solver: SolverSettings::default(),
            energy_tolerance: None,
            force: false,
            material: Material::default(),
            overlaps: Overlaps::default(),
            accept_start_in_walls: false,
            walls: Vec::new(),
            bodies: Vec::new(),
            joints: Vec::new(),
            loads: Vec::new(),
            force_functions: Vec::new(),
            central_gravity: None,
        }
    }
}

impl WorldBuilder {
    /// Gravity g (m/s²); (0, −9.8, 0) by default.
    pub fn gravity(mut self, gravity: DVec3) -> Self {
        self.gravity = gravity;
        self
    }

    /// Drag c of the medium on every particle, F = −c v (N·s/m); 0 by default.
    pub fn velocity_damping_stiffness(mut self, c: f64) -> Self {
        self.velocity_damping_stiffness = c;
        self
    }

    /// Time step h (s); 1e-3 by default.
    pub fn dt(mut self, dt: f64) -> Self {
        self.dt = dt;
        self
    }

    /// The time integrator.
    pub fn integrator(mut self, integrator: Integrator) -> Self {
        self.integrator = integrator;
        self
    }

    /// When the iterations of [`Integrator::Implicit`] end.
    pub fn solver(mut self, settings: SolverSettings) -> Self {
        self.solver = settings;
        self
    }

    /// Refines steps in contact until the energy error of each substep is below this fraction of the
    /// energy in the contact. Smaller values cost more; `None`, the default, disables refinement.
    pub fn energy_tolerance(mut self, tolerance: impl Into<Option<f64>>) -> Self {
        self.energy_tolerance = tolerance.into();
        self
    }

    /// Allows a time step above the critical one.
    pub fn force(mut self, force: bool) -> Self {
        self.force = force;
        self
    }

    /// The material of contacts, where neither wall nor body has its own.
    pub fn material(mut self, material: Material) -> Self {
        self.material = material;
        self
    }

    /// The treatment of bodies that overlap each other or walls initially; they are refused by default.
    pub fn overlaps(mut self, overlaps: Overlaps) -> Self {
        self.overlaps = overlaps;
        self
    }

    /// Accepts bodies that start deep in walls, with their centre in front of them: for the scene of a run that has begun.
    pub fn accept_start_in_walls(mut self, accept: bool) -> Self {
        self.accept_start_in_walls = accept;
        self
    }

    /// Adds a wall.
    pub fn wall(self, wall: WallPlane) -> Self {
        self.wall_with_material(wall, MaterialOverride::default())
    }

    /// Adds a wall with its own material.
    pub fn wall_with_material(mut self, wall: WallPlane, material: MaterialOverride) -> Self {
        self.walls.push((wall, material));
        self
    }

    /// Adds the walls of a box.
    pub fn box_walls(self, walls: &WallBox) -> Self {
        walls.planes().into_iter().fold(self, Self::wall)
    }

    /// Adds a body.
    pub fn body(mut self, body: Body) -> Self {
        self.bodies.push(body);
        self
    }

    /// Adds a joint between bodies, or of a body with the world.
    pub fn joint(mut self, joint: Joint) -> Self {
        self.joints.push(joint);
        self
    }

    /// Adds a load on a body.
    pub fn load(mut self, load: Load) -> Self {
        self.loads.push(load);
        self
    }

    /// Adds a force on a body that a program computes; see [`ForceFunction`].
    pub fn force_function(
        mut self,
        body: impl Into<String>,
        function: impl Fn(f64, &BodyView) -> Wrench + Send + Sync + 'static,
    ) -> Self {
        let function = ForceFunction { body: body.into(), function: Arc::new(function) };
        self.force_functions.push(function);
        self
    }

    /// Sets gravity of a mass at a fixed place, in addition to uniform gravity.
    pub fn central_gravity(mut self, gravity: CentralGravity) -> Self {
        self.central_gravity = Some(gravity);
        self
    }

    /// Whether bodies are joined or loaded.
    pub(super) fn has_joints_or_loads(&self) -> bool {
        let has_loads = !self.loads.is_empty() || !self.force_functions.is_empty();
        !self.joints.is_empty() || has_loads || self.central_gravity.is_some()
    }
}
