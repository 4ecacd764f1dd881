//! Which time step suits a scene with each integrator.

use std::path::Path;

use tumble::{CriticalStep, Integrator, Model, Surface, World, contact_time, critical_dt};

use super::description::{MotionScene, Scene};
use super::load::{LoadOptions, Loaded, load_text};
use super::place::Source;
use super::problem::SceneError;

/// The step of `splitting`, as a part of the critical one, if dashpots end a contact before errors grow.
const DAMPED: f64 = 0.8;
/// The same without dashpots: about eight steps in the shortest contact, half an oscillation.
const UNDAMPED: f64 = 0.2;
/// How many of these steps one of `implicit` takes. Up to the critical step it conserves the energy of undamped contacts. Longer
/// steps than four times the critical one are stable, but need as many more iterations as there are fewer of them.
const IMPLICIT_STEPS: f64 = 5.0;
/// The orientation of a body is of first order in `euler`, however slow its contacts are.
const LONGEST_EULER: f64 = 1e-3;
/// The longest step (s) with joints, whose motion is of second order in it.
const LONGEST_WITH_JOINTS: f64 = 1e-3;
/// Part of a swing of an oscillating body that a step may take, somewhat below the limit of the builder.
const PART_OF_SWING: f64 = 0.09;

/// What limits the time step of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct StepLimits {
    /// The critical step of the explicit integrators; `None` if nothing can touch anything.
    pub critical: Option<CriticalStep>,
    /// The longest step (s) with which `splitting` rebounds with the given restitution; `None` without dashpots.
    pub dt_for_restitution: Option<f64>,
    /// No step is longer than this (s): the interval of the output, a part of the fastest prescribed oscillation, and 1 ms with joints.
    pub longest: f64,
}

impl StepLimits {
    /// The limits of a scene and its world, whatever its integrator is.
    pub fn new(scene: &Scene, world: &World) -> Self {
        let model = of_explicit_steps(world.model());
        let oscillations = scene.bodies.iter().filter_map(|body| match body.motion {
            MotionScene::Prescribed(given) => given.oscillation,
            _ => None,
        });
        let of_joints = (!scene.joints.is_empty()).then_some(LONGEST_WITH_JOINTS);
        let longest = oscillations
            .map(|oscillation| PART_OF_SWING / oscillation.frequency.abs())
            .chain(of_joints)
            .fold(scene.output.interval, f64::min);
        Self {
            critical: critical_dt(&model),
            dt_for_restitution: contact_time(&model).map(|time| time.dt_for_restitution()),
            longest,
        }
    }

    /// A step (s) with which the integrator is accurate and not slower than it need be, rounded down to one digit.
    pub fn suggested_dt(&self, integrator: Integrator) -> f64 {
        let part = if self.dt_for_restitution.is_some() { DAMPED } else { UNDAMPED };
        let critical = self.critical.as_ref().map(|critical| part * critical.dt);
        let resolved = [critical, self.dt_for_restitution].into_iter().flatten();
        let splitting = rounded_down(resolved.fold(self.longest, f64::min));
        match integrator {
            Integrator::Splitting => splitting,
            Integrator::Euler => splitting.min(LONGEST_EULER),
            Integrator::Implicit => {
                (IMPLICIT_STEPS * splitting).min(Integrator::LONGEST_IMPLICIT_DT).min(self.longest)
            }
        }
    }
}

/// The model as the explicit integrators have it: with `implicit`, walls count as contact between bodies.
fn of_explicit_steps(model: &Model) -> Model {
    let mut model = model.clone();
    model.has_body_contact = model.bodies.iter().any(|body| body.surface != Surface::None);
    model
}

/// The scene with another integrator and step. Steps above the critical one are accepted, and `energy_tolerance` is left out where the
/// integrator has none.
///
/// # Errors
/// [`SceneError`] holds all problems.
pub fn load_with_integrator(
    scene: &Scene,
    integrator: Integrator,
    dt: f64,
) -> Result<Loaded, SceneError> {
    let mut scene = Scene { integrator, dt, ..scene.clone() };
    if integrator != Integrator::Splitting {
        scene.energy_tolerance = None;
    }
    let source = Source { name: scene.name.clone(), text: scene.to_toml() };
    let options = LoadOptions { sets: Vec::new(), force: true };
    // the paths of meshes are absolute in a loaded scene, so the folder does not matter
    load_text(&scene.name, source, Path::new("."), &options)
}

/// The number, rounded down to one digit.
fn rounded_down(x: f64) -> f64 {
    let text = format!("{x:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let first = digits.split('.').next().unwrap_or(digits);
    format!("{first}e{exponent}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::scene::{BUILTIN, load_builtin};

    #[test]
    fn numbers_are_rounded_down_to_one_digit() {
        for (x, rounded) in [(1.96e-4, 1e-4), (9.99e-7, 9e-7), (3e-3, 3e-3), (0.5, 0.5), (2.0, 2.0)]
        {
            assert_eq!(rounded_down(x), rounded);
        }
    }

    #[test]
    fn every_built_in_scene_takes_the_suggested_steps() {
        for builtin in BUILTIN {
            let Loaded { scene, world } =
                load_builtin(builtin.name, &LoadOptions::default()).unwrap().unwrap();
            let limits = StepLimits::new(&scene, &world);
            let dt = |integrator| limits.suggested_dt(integrator);
            let [splitting, implicit] = [Integrator::Splitting, Integrator::Implicit].map(dt);
            let is_longer = splitting <= implicit || limits.critical.is_none();
            assert!(is_longer && implicit <= 1.0 / 60.0, "{}", builtin.name);
            let has_joints = !scene.joints.is_empty();
            for integrator in [Integrator::Splitting, Integrator::Implicit, Integrator::Euler] {
                if has_joints && !integrator.kicks() {
                    continue;
                }
                let mut with = load_with_integrator(&scene, integrator, dt(integrator)).unwrap();
                assert_eq!(with.scene.integrator, integrator);
                with.world.step().unwrap();
                // the integrator of the scene does not change its limits
                assert_eq!(StepLimits::new(&with.scene, &with.world), limits, "{}", builtin.name);
            }
        }
    }
}
