//! `tumble info`: what a mesh will work as, or which integrator and time step suit a scene.

use std::path::{Path, PathBuf};

use clap::Args;
use tumble_io::mesh::{Format, Repair, Weld};
use tumble_io::scene::{BUILTIN, builtin, nearest};

use crate::failure::Failure;
use crate::mesh_info::{MeshOptions, mesh_info};
use crate::scene_info::scene_info;

#[derive(Args)]
#[command(
    after_help = "Of a mesh: size, mass, moments, and what it will work as. Mass, centre and moments are those of equal \
    particles at the vertices.\n\
    Of a scene: bodies, the critical time step of its contacts, and for each integrator a time step and what a \
    simulated second costs with it. This is measured, in a few seconds."
)]
pub struct InfoArgs {
    /// Mesh file (.obj, .stl, .ply, .gltf or .glb), scene file (.toml), or name of a built-in scene
    #[arg(value_name = "MESH or SCENE")]
    what: PathBuf,
    /// Mesh: factor for all coordinates [default: 1]
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true)]
    scale: Option<f64>,
    /// Mesh: mass of one particle (kg) [default: 1]
    #[arg(long, value_name = "KG", allow_negative_numbers = true)]
    particle_mass: Option<f64>,
    /// Mesh: whether to merge equal vertices, and those at open edges within a tolerance: true, false, or that
    /// length in the unit of the file [default: true for .stl, .gltf and .glb]
    #[arg(long, value_name = "true|false|LENGTH", value_parser = parse_weld, allow_negative_numbers = true)]
    weld: Option<Weld>,
    /// Mesh: what to do to the triangles: none, or close (closes holes) [default: none]
    #[arg(long, value_name = "none|close", value_parser = parse_repair)]
    repair: Option<Repair>,
    /// Scene: set a key, e.g. collision.collision_stiffness=1e5; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

pub fn info(args: &InfoArgs) -> Result<(), Failure> {
    match scene_of(&args.what) {
        Some(scene) => {
            if let Some(option) = args.mesh_option() {
                return Err(Failure::call(&format!(
                    "{option} is for meshes, but {scene} is a scene"
                )));
            }
            scene_info(scene, &args.set)
        }
        None if has_other_extension(&args.what) => Err(neither(&args.what)),
        None if !args.set.is_empty() => {
            let mesh = args.what.display();
            Err(Failure::call(&format!("--set is for scenes, but {mesh} is a mesh")))
        }
        None => mesh_info(&args.what, args.mesh_options()),
    }
}

impl InfoArgs {
    fn mesh_options(&self) -> MeshOptions {
        MeshOptions {
            scale: self.scale.unwrap_or(1.0),
            particle_mass: self.particle_mass.unwrap_or(1.0),
            weld: self.weld,
            repair: self.repair.unwrap_or_default(),
        }
    }

    /// An option that is given and has a meaning for meshes only.
    fn mesh_option(&self) -> Option<&'static str> {
        let options = [
            ("--scale", self.scale.is_some()),
            ("--particle-mass", self.particle_mass.is_some()),
            ("--weld", self.weld.is_some()),
            ("--repair", self.repair.is_some()),
        ];
        options.into_iter().find_map(|(option, is_given)| is_given.then_some(option))
    }
}

/// The argument if it is a scene: the name of a built-in one, or a file that ends in .toml.
fn scene_of(what: &Path) -> Option<&str> {
    let text = what.to_str()?;
    let is_file = what.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    (is_file || builtin(text).is_some()).then_some(text)
}

/// Whether the name does not end as that of a mesh.
fn has_other_extension(what: &Path) -> bool {
    let format = what.extension().and_then(|e| Format::from_extension(&e.to_string_lossy()));
    format.is_none()
}

/// The failure for a name that is neither that of a mesh nor that of a scene.
fn neither(what: &Path) -> Failure {
    let text = what.to_string_lossy();
    let names = BUILTIN.map(|scene| scene.name);
    let help = if what.is_dir() {
        let scene = what.join("scene.toml");
        let in_run = format!("; the scene of this run is {}", scene.display());
        if scene.exists() { in_run } else { "; this is a folder".to_owned() }
    } else {
        nearest(&text, &names).map_or(String::new(), |near| format!("; did you mean `{near}`?"))
    };
    Failure::call(&format!(
        "`{text}` is neither a mesh nor a scene: give a mesh file ({}), a scene file (.toml), or the name of a \
         built-in scene (see `tumble scenes`){help}",
        Format::SUPPORTED
    ))
}

fn parse_weld(text: &str) -> Result<Weld, String> {
    match text {
        "true" => Ok(Weld::Auto),
        "false" => Ok(Weld::Never),
        _ => match text.parse::<f64>() {
            Ok(length) if length >= 0.0 && length.is_finite() => Ok(Weld::Within(length)),
            _ => Err("it must be true, false, or a length of 0 or more".to_owned()),
        },
    }
}

fn parse_repair(text: &str) -> Result<Repair, String> {
    Repair::from_name(text).ok_or_else(|| "it must be none or close".to_owned())
}
