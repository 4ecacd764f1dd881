//! The argument SCENE: a scene file or the name of a built-in scene.

use std::path::Path;

use tumble_io::scene::{BUILTIN, LoadOptions, Loaded, load_builtin, load_file, nearest};

use crate::failure::Failure;

/// Loads the built-in scene of that name, or else the scene file. A file whose name is that of a built-in scene
/// can be given as `./NAME`.
pub fn load_scene(scene: &str, options: &LoadOptions) -> Result<Loaded, Failure> {
    let path = Path::new(scene);
    let loaded = match load_builtin(scene, options) {
        Some(loaded) => loaded,
        None if path.exists() => load_file(path, options),
        None => return Err(unknown_scene(scene)),
    };
    loaded.map_err(|error| Failure::from(&error))
}

/// The failure for a name that is neither a file nor a built-in scene.
pub fn unknown_scene(name: &str) -> Failure {
    let names = BUILTIN.map(|scene| scene.name);
    let help = match nearest(name, &names) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the built-in scenes are {}", names.join(", ")),
    };
    Failure::call(&format!("there is no file and no built-in scene `{name}`; {help}"))
}
