//! Moves the state of a running simulation into a world with another model.

use std::sync::Arc;

use tumble::{BodyModel, Integrator, State, World};

/// Larger step numbers are not exact as doubles.
const MAX_STEPS: f64 = 9e15;

/// Copies the state of `old` into `new`, a world of the same bodies whose model may differ.
///
/// - Time is a whole number of steps: with another dt it moves on to the next multiple of the new one.
/// - Friction springs at walls are anchored to the walls: they are released when a wall or a coefficient of
///   friction changes. Friction springs between bodies are released also when a surface or a motion changes.
/// - The integrators hold friction springs in different ways: all are released when the integrator changes.
///
/// # Errors
/// Why the simulation cannot continue in `new`.
pub fn transfer_state(old: &World, new: &mut World) -> Result<(), String> {
    let mut state: State = old.state().clone();
    let (before, after) = (old.model(), new.model());
    if before.dt != after.dt {
        let nearest = (state.time / after.dt).round();
        let steps = if nearest * after.dt < state.time { nearest + 1.0 } else { nearest };
        if steps > MAX_STEPS {
            return Err(format!("`dt` is too short for t = {} s: reset first", state.time));
        }
        state.step = steps as u64;
        state.time = state.step as f64 * after.dt;
    }
    // the time since the latest kick is half a step of flight
    let is_implicit = after.integrator == Integrator::Implicit;
    let was_implicit = before.integrator == Integrator::Implicit;
    let since_kick = if was_implicit { state.since_kick } else { 0.5 * before.dt };
    state.since_kick = if is_implicit { since_kick.min(0.5 * after.dt) } else { 0.0 };
    if before.integrator != after.integrator {
        state.step_divisions = new.state().step_divisions;
    }
    if before.integrator != after.integrator
        || before.walls != after.walls
        || wall_friction(old) != wall_friction(new)
    {
        state.springs.iter_mut().for_each(Vec::clear);
        release_pairs(&mut state);
    }
    let pair_contact = |world: &World| -> Vec<_> {
        let bodies = world.model().bodies.iter();
        bodies
            .map(|body| (body.surface, body.is_free(), body.pair_material.friction > 0.0))
            .collect()
    };
    if pair_contact(old) != pair_contact(new) {
        release_pairs(&mut state);
    }
    // the energy error carried by refined steps is only compensated by refined steps
    if after.energy_tolerance.is_none() {
        state.bodies.iter_mut().for_each(|body| body.energy_excess = 0.0);
    }
    for (name, body) in after.names.iter().zip(&state.bodies) {
        if after.walls.iter().any(|wall| wall.depth(body.position) > 0.0)
            && before.walls != after.walls
        {
            return Err(format!("the centre of body \"{name}\" would lie behind a wall"));
        }
    }
    new.restore(state)
        .map_err(|error| format!("the simulation cannot continue: {error}; reset first"))
}

/// Releases the friction springs between bodies; the impulses of `implicit` belong to them.
fn release_pairs(state: &mut State) {
    state.pair_springs.clear();
    state.pair_impulses.clear();
}

/// The coefficients of friction of all bodies at all walls.
fn wall_friction(world: &World) -> Vec<f64> {
    let of_body =
        |body: &Arc<BodyModel>| body.contacts.iter().map(|law| law.friction).collect::<Vec<_>>();
    world.model().bodies.iter().flat_map(of_body).collect()
}
