//! `tumble scenes`: lists the built-in scenes, or prints one.

use clap::Args;
use tumble_io::scene::{BUILTIN, builtin, nearest};

use crate::{Failure, print};

#[derive(Args)]
pub struct ScenesArgs {
    /// The scene to print
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
        None => Err(Failure::Call(unknown_scene(name))),
    }
}

/// What to say of a scene that is neither a file nor built in.
pub fn unknown_scene(name: &str) -> String {
    let names = BUILTIN.map(|scene| scene.name);
    let help = match nearest(name, &names) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the built-in scenes are {}", names.join(", ")),
    };
    format!("error: there is no file and no built-in scene `{name}`; {help}")
}
