//! The integrators that a scene can have in the viewer, each with the step that suits it.

use tumble::{Integrator, World};
use tumble_io::page::IntegratorChoice;
use tumble_io::scene::{Scene, StepLimits};

use crate::command::SceneEdit;

/// The key of the scene.
const KEY: &str = "integrator";

/// The choices for a scene, in the order in which the page shows them.
pub fn integrators(scene: &Scene, world: &World) -> Vec<IntegratorChoice> {
    let limits = StepLimits::new(scene, world);
    let all = [Integrator::Splitting, Integrator::Implicit, Integrator::Euler];
    // only `splitting` has this key
    let possible = all.into_iter().filter(|&integrator| {
        scene.energy_tolerance.is_none() || integrator == Integrator::Splitting
    });
    // nor has `euler` joints and loads
    let needs_kicks =
        !scene.joints.is_empty() || scene.has_loads() || scene.central_gravity.is_some();
    let possible = possible.filter(|integrator| !needs_kicks || integrator.kicks());
    possible
        .map(|integrator| {
            let dt = limits.suggested_dt(integrator);
            IntegratorChoice { name: integrator.name(), dt }
        })
        .collect()
}

/// The edit, and for another integrator that of the step that suits it in all of these scenes: steps differ so much that hardly any
/// would do for both.
pub fn with_dt(edit: &SceneEdit, scenes: &[(&Scene, &World)]) -> Vec<SceneEdit> {
    let name = edit.value.as_ref().and_then(|value| value.as_str()).filter(|_| edit.key == KEY);
    let steps = scenes.iter().filter_map(|(scene, world)| {
        integrators(scene, world).into_iter().find(|choice| Some(choice.name) == name)
    });
    let dt = steps.map(|choice| choice.dt).reduce(f64::min);
    let of_dt = dt.map(|dt| SceneEdit { key: "dt".to_owned(), value: Some(dt.into()) });
    [edit.clone()].into_iter().chain(of_dt).collect()
}
