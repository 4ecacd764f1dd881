//! From the description of a world to its model and initial state. All values are checked here.

mod body;
mod body_model;
mod checks;
mod description;
mod initial_state;
mod joints;
mod model_cache;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod wall_start_tests;
mod weighted_shapes;

use self::body_model::Shared;
use self::checks::{behind_walls, duplicate_names, overlaps};
use crate::stage::DIVISIONS_AT_START;
use crate::{
    BuildError, BuildErrors, Integrator, Joints, Loads, MaterialOverride, Model, Overlaps, State,
    Surface, WallPlane, World, critical_dt,
};

pub use self::body::Body;
pub use self::description::WorldBuilder;

impl World {
    /// Starts the description of a world.
    pub fn builder() -> WorldBuilder {
        WorldBuilder::default()
    }
}

impl WorldBuilder {
    /// Checks the description and makes the world at t = 0.
    ///
    /// # Errors
    /// [`BuildErrors`] lists every invalid quantity and what is allowed.
    pub fn build(self) -> Result<World, BuildErrors> {
        let mut errors = Vec::new();
        self.check_world(&mut errors);
        let mut model = Model {
            gravity: self.gravity,
            velocity_damping_stiffness: self.velocity_damping_stiffness,
            dt: self.dt,
            integrator: self.integrator,
            solver: self.solver,
            energy_tolerance: self.energy_tolerance,
            resolves_contacts: true,
            walls: self.walls.iter().map(|(wall, _)| *wall).collect(),
            wall_gap: smallest_gap(&self.walls),
            has_body_contact: self.bodies.iter().any(|body| body.surface != Surface::None)
                || (self.integrator == Integrator::Implicit && !self.walls.is_empty())
                || self.has_joints_or_loads(),
            bodies: Vec::with_capacity(self.bodies.len()),
            names: Vec::with_capacity(self.bodies.len()),
            joints: Joints::default(),
            loads: Loads::default(),
        };
        let (mut state, mut shared) = (State::default(), Shared::default());
        if self.integrator == Integrator::Implicit {
            state.step_divisions = DIVISIONS_AT_START;
        }
        for (index, body) in self.bodies.iter().enumerate() {
            let name = body.name.clone().unwrap_or_else(|| format!("body {index}"));
            match self.model_and_state(&name, body, &mut shared) {
                Ok((body_model, body_state)) => {
                    model.bodies.push(body_model);
                    model.names.push(name);
                    state.bodies.push(body_state);
                    state.springs.push(Vec::new());
                }
                Err(error) => errors.push(error),
            }
        }
        errors.extend(duplicate_names(&model));
        self.add_loads(&mut model, &mut errors);
        let has_contact = model.has_body_contact || !model.walls.is_empty();
        if errors.is_empty() && has_contact && self.overlaps == Overlaps::Push {
            crate::contact::initial_overlap::separate(&model, &mut state);
        }
        self.add_joints(&mut model, &mut state, &mut errors);
        errors.extend(behind_walls(&model, &state, self.accept_start_in_walls));
        errors.extend(overlaps(&model, &state));
        // implicit steps are stable at any length
        let is_bounded = self.integrator != Integrator::Implicit && !self.force;
        let critical = critical_dt(&model);
        model.resolves_contacts = critical.as_ref().is_none_or(|critical| self.dt <= critical.dt);
        errors.extend(critical.filter(|c| self.dt > c.dt && is_bounded).map(|critical| {
            BuildError::Unstable { dt: self.dt, critical: critical.dt, body: critical.body }
        }));
        if errors.is_empty() { Ok(World::new(model, state)) } else { Err(BuildErrors(errors)) }
    }
}

/// The smallest distance between two walls that face each other with free space between them (m).
fn smallest_gap(walls: &[(WallPlane, MaterialOverride)]) -> Option<f64> {
    let pairs = walls.iter().flat_map(|(a, _)| walls.iter().map(move |(b, _)| (a, b)));
    let facing = pairs.filter(|(a, b)| a.normal.dot(b.normal) < -1.0 + 1e-9);
    facing.map(|(a, b)| -(a.offset + b.offset)).filter(|&gap| gap > 0.0).min_by(f64::total_cmp)
}
