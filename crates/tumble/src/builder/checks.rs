//! Checks of descriptions and of initial states.

use std::sync::Arc;

use super::body::Body;
use super::description::WorldBuilder;
use crate::contact::wall::{WallDepth, depth_in_wall};
use crate::kinematics::Kinematics;
use crate::{
    BodyModel, BodyState, BuildError, Damping, Integrator, Material, Model, Motion, SolverSettings,
    State, Surface,
};

impl WorldBuilder {
    /// Checks the quantities that belong to no particular body.
    pub(super) fn check_world(&self, errors: &mut Vec<BuildError>) {
        let mut check = |quantity, ok: bool, value: &dyn std::fmt::Display, allowed| {
            if !ok {
                errors.push(BuildError::World { quantity, value: value.to_string(), allowed });
            }
        };
        let c = self.velocity_damping_stiffness;
        check("dt", self.dt > 0.0 && self.dt.is_finite(), &self.dt, "a number of seconds above 0");
        let SolverSettings { tolerance, max_iterations } = self.solver;
        let ok = tolerance > 0.0 && tolerance < 1.0;
        check("solver.tolerance", ok, &tolerance, "above 0 and below 1");
        let ok = max_iterations > 0;
        check("solver.max_iterations", ok, &max_iterations, "a whole number, 1 or more");
        check("gravity", self.gravity.is_finite(), &self.gravity, "three finite numbers (m/s²)");
        let allowed = "a number of N·s/m, 0 or more";
        check("velocity_damping_stiffness", c >= 0.0 && c.is_finite(), &c, allowed);
        let overrides = self.walls.iter().map(|(_, material)| *material);
        let overrides = overrides.chain(self.bodies.iter().map(|body| body.material));
        let materials = overrides.map(|own| own.over(self.material)).chain([self.material]);
        for material in materials {
            check_material(&material, &mut check);
        }
        if let Some(tolerance) = self.energy_tolerance {
            let ok = tolerance > 0.0 && tolerance < 1.0;
            check("energy_tolerance", ok, &tolerance, "above 0 and below 1");
            let refines = self.integrator == Integrator::Splitting;
            let allowed = "left out with the integrators \"euler\" and \"implicit\": only \"splitting\" refines its steps";
            check("energy_tolerance", refines, &tolerance, allowed);
            let allowed = "left out in scenes with joints or loads: it refines the steps of each body separately, so use a smaller `dt` instead";
            check("energy_tolerance", !self.has_joints_or_loads(), &tolerance, allowed);
            let alone = self.bodies.iter().all(|body| body.surface == Surface::None);
            let allowed = "left out where bodies collide with each other: it refines the steps of each body separately, so use a smaller `dt` instead";
            check("energy_tolerance", alone, &tolerance, allowed);
        }
    }
}

/// Checks the surface and the motion of a body; returns quantity, value and what is allowed.
pub(super) fn check_body(body: &Body, dt: f64) -> Option<(&'static str, String, &'static str)> {
    if let Surface::Spheres { radius } = body.surface
        && !(radius > 0.0 && radius.is_finite())
    {
        return Some(("particle_radius", radius.to_string(), "a number of m above 0"));
    }
    let Motion::Prescribed(given) = &body.motion else { return None };
    let three = "three finite numbers";
    if !given.surface_velocity.is_finite() {
        return Some(("surface_velocity", given.surface_velocity.to_string(), three));
    }
    let oscillation = given.oscillation.as_ref()?;
    if !(oscillation.amplitude.is_finite()
        && oscillation.frequency.is_finite()
        && oscillation.phase.is_finite())
    {
        let allowed = "a finite amplitude (m), frequency (Hz) and phase (rad)";
        return Some(("oscillation", format!("{oscillation:?}"), allowed));
    }
    if oscillation.frequency.abs() * dt > 0.1 {
        let allowed = "of a frequency that gives a swing at least ten steps of `dt`";
        return Some(("oscillation", format!("of {} Hz", oscillation.frequency), allowed));
    }
    None
}

/// Checks a material; `check` takes the name, whether it is valid, the value, and what is allowed.
fn check_material(
    material: &Material,
    check: &mut impl FnMut(&'static str, bool, &dyn std::fmt::Display, &'static str),
) {
    let mut number = |name, value: f64, allowed| {
        check(name, value >= 0.0 && value.is_finite(), &value, allowed);
    };
    number("collision_stiffness", material.collision_stiffness, "a number of N/m, 0 or more");
    if let Some(stiffness) = material.collision_stiffness_per_area {
        number("collision_stiffness_per_area", stiffness, "a number of N/m³, 0 or more");
    }
    number("friction_stiffness", material.friction_stiffness, "a number, 0 or more");
    if let Some(spring) = material.friction_spring {
        number("friction_spring", spring, "a number of N/m, 0 or more");
    }
    if let Some(damping) = material.friction_damping {
        number("friction_damping", damping, "a number of N·s/m, 0 or more");
    }
    match material.damping {
        Damping::Dashpot(c) => number("collision_damping", c, "a number of N·s/m, 0 or more"),
        Damping::Restitution(e) => {
            check("restitution", e > 0.0 && e <= 1.0, &e, "above 0, up to 1");
        }
    }
}

/// A free body may start in a wall up to this part of its extent.
const MAX_DEPTH_IN_WALL: f64 = 0.05;
/// It may start deeper if its springs then press with less than its weight times this factor: as it may rest.
const MAX_LOAD_IN_WALL: f64 = 10.0;

/// Bodies that start behind walls: with their centre of mass deeper than ten times the depth at which the springs of their
/// particles carry their weight, or, unless `accept` is set, with particles or spheres far behind a wall.
pub(super) fn behind_walls(model: &Model, state: &State, accept: bool) -> Vec<BuildError> {
    let bodies = model.names.iter().zip(model.bodies.iter().zip(&state.bodies));
    let check = |(name, (body, state)): (&String, (&Arc<BodyModel>, &BodyState))| {
        let in_wall = || if accept { None } else { in_wall(model, body, name, state) };
        outside(model, body, name, state).or_else(in_wall)
    };
    bodies.filter_map(check).collect()
}

fn outside(model: &Model, body: &BodyModel, name: &str, state: &BodyState) -> Option<BuildError> {
    model.walls.iter().zip(&body.contacts).find_map(|(wall, law)| {
        let depth = wall.depth(state.position);
        let sag = body.particle_mass() * model.gravity.length() / law.stiffness;
        let normal = wall.normal.to_array();
        (depth > 10.0 * sag).then(|| BuildError::Outside { body: name.to_owned(), normal, depth })
    })
}

/// A free body that starts too deep in a wall, with the position at which it would touch its walls.
fn in_wall(model: &Model, body: &BodyModel, name: &str, state: &BodyState) -> Option<BuildError> {
    if !body.is_free() || model.walls.is_empty() {
        return None;
    }
    let weight = body.mass * model.gravity.length();
    let kinematics = Kinematics::new(body, state);
    let mut position = state.position;
    let mut deepest: Option<(f64, [f64; 3])> = None;
    for (wall, law) in model.walls.iter().zip(&body.contacts) {
        let WallDepth { depth, sum } = depth_in_wall(&kinematics, wall);
        if depth <= 0.0 {
            continue;
        }
        position += wall.normal * depth;
        let is_refused = depth > MAX_DEPTH_IN_WALL * body.extent
            && law.stiffness * sum > MAX_LOAD_IN_WALL * weight;
        if is_refused && deepest.is_none_or(|(most, _)| depth > most) {
            deepest = Some((depth, wall.normal.to_array()));
        }
    }
    let (depth, normal) = deepest?;
    let position = position.to_array();
    Some(BuildError::InWall { body: name.to_owned(), normal, depth, position })
}

/// Names that are used more than once.
pub(super) fn duplicate_names(model: &Model) -> Vec<BuildError> {
    let mut names: Vec<_> = model.names.iter().collect();
    names.sort_unstable();
    let mut duplicates: Vec<_> =
        names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
    duplicates.dedup();
    duplicates.into_iter().map(|name| BuildError::SameName { body: name.clone() }).collect()
}

/// Bodies that overlap initially, deeper than contact forces could press them.
pub(super) fn overlaps(model: &Model, state: &State) -> Vec<BuildError> {
    let name = |index: u32| model.names[index as usize].clone();
    let pairs = crate::contact::initial_overlap::overlaps(model, state).into_iter();
    pairs
        .map(|overlap| BuildError::Overlap {
            first: name(overlap.first),
            second: name(overlap.second),
            depth: overlap.depth,
        })
        .collect()
}
