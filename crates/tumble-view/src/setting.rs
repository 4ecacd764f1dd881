//! Changing one key of a scene, and moving a state into the model that comes of it.

use std::path::Path;
use std::sync::Arc;

use toml::{Table, Value};
use tumble::{State, World};
use tumble_io::scene::{LoadOptions, Loaded, Scene, Source, load_text};

use crate::command::Setting;

/// The keys of a material: what a body may change at once.
const MATERIAL_KEYS: [&str; 7] = [
    "collision_stiffness",
    "collision_stiffness_per_area",
    "collision_damping",
    "restitution",
    "friction_stiffness",
    "friction_spring",
    "friction_damping",
];

/// More steps than this cannot be told apart in a double.
const MOST_STEPS: f64 = 9e15;

/// Whether a key changes the motion as it goes on; what says how bodies look and start waits for a
/// reset.
pub fn applies_at_once(key: &str) -> bool {
    let (first, last) = (key.split('.').next(), key.rsplit('.').next());
    first != Some("body") || MATERIAL_KEYS.contains(&last.unwrap_or_default())
}

/// The scene with one key changed, read and checked as any scene.
///
/// # Errors
/// What is wrong with it, in the words of the scene's reader.
pub fn load_with(scene: &Scene, setting: &Setting) -> Result<Loaded, String> {
    let Setting { key, value } = setting;
    let mut root: Value = toml::from_str::<Table>(&scene.to_toml())
        .map(Value::Table)
        .map_err(|error| format!("the scene cannot be read again: {error}"))?;
    let path: Vec<&str> = key.split('.').collect();
    let mut removed = false;
    if value.is_none() {
        visit(&mut root, &path, &mut |table, last| removed |= table.remove(last).is_some());
    }
    if value.is_none() && !removed {
        return Err(format!("`{key}` is not set"));
    }
    let sets = value.iter().map(|value| format!("{key}={value}")).collect();
    let text = toml::to_string(&root).map_err(|error| format!("`{key}`: {error}"))?;
    load(scene, text, sets)
}

/// Reads a scene that came of `scene`, under its name.
///
/// # Errors
/// What is wrong with it, in the words of the scene's reader.
pub fn load(scene: &Scene, text: String, sets: Vec<String>) -> Result<Loaded, String> {
    let source = Source { name: scene.name.clone(), text };
    let options = LoadOptions { sets, force: scene.force };
    // meshes have full paths by now
    load_text(&scene.name, source, Path::new("."), &options)
        // a page has no flags: the one to insist with belongs to the command that serves it
        .map_err(|error| {
            error
                .messages()
                .join("\n")
                .replace("insist with --force", "restart tumble view with --force")
        })
}

/// Calls `change` with every table that a key reaches, and the last part of the key. As for `--set`,
/// a name that meets an array reaches all its items, and a number one of them.
fn visit(value: &mut Value, path: &[&str], change: &mut dyn FnMut(&mut Table, &str)) {
    let Some((&part, rest)) = path.split_first() else { return };
    match value {
        Value::Table(table) if rest.is_empty() => change(table, part),
        Value::Table(table) => {
            if let Some(inner) = table.get_mut(part) {
                visit(inner, rest, change);
            }
        }
        Value::Array(items) => match part.parse::<usize>() {
            Ok(index) => {
                if let Some(item) = items.get_mut(index) {
                    visit(item, rest, change);
                }
            }
            Err(_) => items.iter_mut().for_each(|item| visit(item, path, change)),
        },
        _ => {}
    }
}

/// Puts the state of `old` into `new`, a world of the same bodies whose model may be another.
///
/// Time is counted in steps: with another dt it moves on to the next whole number of them. Friction
/// springs hold to places on walls: when a wall or a coefficient of friction has changed, all let go.
///
/// # Errors
/// Why the motion cannot go on in `new`.
pub fn transplant(old: &World, new: &mut World) -> Result<(), String> {
    let mut state: State = old.state().clone();
    let (before, after) = (old.model(), new.model());
    if before.dt != after.dt {
        let near = (state.time / after.dt).round();
        let steps = if near * after.dt < state.time { near + 1.0 } else { near };
        if steps > MOST_STEPS {
            return Err(format!("`dt` is too short for t = {} s: reset first", state.time));
        }
        state.step = steps as u64;
        state.time = state.step as f64 * after.dt;
    }
    let friction = |world: &World| -> Vec<f64> {
        let of_body = |body: &Arc<tumble::BodyModel>| {
            body.contacts.iter().map(|law| law.friction).collect::<Vec<_>>()
        };
        world.model().bodies.iter().flat_map(of_body).collect()
    };
    if before.walls != after.walls || friction(old) != friction(new) {
        state.springs.iter_mut().for_each(Vec::clear);
        state.pair_springs.clear();
    }
    let meets = |world: &World| -> Vec<_> {
        let bodies = world.model().bodies.iter();
        bodies
            .map(|body| (body.surface, body.is_free(), body.pair_material.friction > 0.0))
            .collect()
    };
    if meets(old) != meets(new) {
        state.pair_springs.clear();
    }
    // what refined steps owe is only ever given back by refined steps
    if after.energy_tolerance.is_none() {
        state.bodies.iter_mut().for_each(|body| body.energy_owed = 0.0);
    }
    for (name, place) in after.names.iter().zip(&state.bodies) {
        if after.walls.iter().any(|wall| wall.depth(place.position) > 0.0)
            && before.walls != after.walls
        {
            return Err(format!("the centre of body \"{name}\" would lie behind a wall"));
        }
    }
    new.restore(state).map_err(|error| format!("the motion cannot go on: {error}; reset first"))
}
