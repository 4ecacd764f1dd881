//! `tumble scenes`: lists the built-in scenes, or prints one.

use clap::Args;
use tumble_io::scene::{BUILTIN, builtin};

use crate::failure::{Failure, print};
use crate::scene_argument::unknown_scene;

#[derive(Args)]
pub struct ScenesArgs {
    /// Built-in scene to print as a scene file (TOML)
    name: Option<String>,
}

pub fn scenes(args: &ScenesArgs) -> Result<(), Failure> {
    let Some(name) = &args.name else {
        let width = BUILTIN.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
        let lines = BUILTIN.map(|scene| {
            format!("{:width$}  {}\n", scene.name, scene.description().unwrap_or_default())
        });
        return print(&lines.concat());
    };
    match builtin(name) {
        Some(scene) => print(scene.text),
        None => Err(unknown_scene(name)),
    }
}
