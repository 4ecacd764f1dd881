//! A scene with keys changed.

use std::path::Path;

use toml::{Table, Value};
use tumble_io::scene::{LoadOptions, Loaded, Scene, Source, load_text};

use crate::command::SceneEdit;

/// The keys of a body's contact material. They are the only keys of a body that change while it moves.
const MATERIAL_KEYS: [&str; 7] = [
    "collision_stiffness",
    "collision_stiffness_per_area",
    "collision_damping",
    "restitution",
    "friction_stiffness",
    "friction_spring",
    "friction_damping",
];

/// Whether a change of the key takes effect at once. Shape, mass and initial state of a body wait for a reset.
pub fn applies_at_once(key: &str) -> bool {
    let (first, last) = (key.split('.').next(), key.rsplit('.').next());
    first != Some("body") || MATERIAL_KEYS.contains(&last.unwrap_or_default())
}

/// Applies edits to a scene and loads the result, with all checks of a scene file.
///
/// # Errors
/// The problems that the scene reader found.
pub fn load_edited(scene: &Scene, edits: &[SceneEdit]) -> Result<Loaded, String> {
    let mut root: Value = toml::from_str::<Table>(&scene.to_toml())
        .map(Value::Table)
        .map_err(|error| format!("the scene cannot be read again: {error}"))?;
    for SceneEdit { key, .. } in edits.iter().filter(|edit| edit.value.is_none()) {
        let path: Vec<&str> = key.split('.').collect();
        let mut removed = false;
        visit(&mut root, &path, &mut |table, last| removed |= table.remove(last).is_some());
        if !removed {
            return Err(format!("`{key}` is not set"));
        }
    }
    let set = |SceneEdit { key, value }: &SceneEdit| Some(format!("{key}={}", value.as_ref()?));
    let sets = edits.iter().filter_map(set).collect();
    let text = toml::to_string(&root)
        .map_err(|error| format!("the scene cannot be written again: {error}"))?;
    load(scene, text, sets)
}

/// Loads the text of a scene derived from `scene`, under the same name and options.
///
/// # Errors
/// The problems that the scene reader found.
pub fn load(scene: &Scene, text: String, sets: Vec<String>) -> Result<Loaded, String> {
    let source = Source { name: scene.name.clone(), text };
    let options = LoadOptions { sets, force: scene.force };
    // the paths of meshes are absolute in a loaded scene, so the folder does not matter
    load_text(&scene.name, source, Path::new("."), &options).map_err(|error| {
        error
            .messages()
            .join("\n")
            // a page has no options; --force belongs to the command that started the server
            .replace("insist with --force", "restart tumble view with --force")
    })
}

/// Calls `change` with every table that a key refers to, and the last part of the key. As for `--set`, a name
/// applied to an array refers to all its items, and a number to one of them.
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
