//! Scenes: TOML files that describe a simulation.
//!
//! [`load_file`] and [`load_builtin`] read a scene, apply the `--set` overrides, check every key and build
//! the world. They report all problems together, each with file, line and column.
//!
//! Data flows one way:
//!
//! 1. `load`: reads the text (`scene_text`) and runs the steps below.
//! 2. `tree`: parses the text into a tree whose nodes know their `place`, and applies `--set`.
//! 3. `reader`: reads keys of a table by name, type and range, and collects each `problem`.
//! 4. `read`, `body`, `shape`, `surface`, `motion`, `joint`, `loads`, `common`: read each table into the `description`.
//! 5. `geometry` (with `mesh_file`, which finds meshes), `copies`: build shapes, masses and poses; `load` builds the world from them.
//! 6. `write`: turns the description back into TOML.
//!
//! `integrator_choice` knows which time step suits a scene with each integrator.
//!
//! To add a key: add a field to its struct in `description`, read it in the file of its table (step 4),
//! write it in `write`, and pass it to the builder in `load`. Then document it in `docs/formats.md` and
//! add it to `fuzz/dictionaries/scene`.

mod body;
mod builtin;
mod common;
mod copies;
mod default_dt;
mod description;
mod geometry;
mod geometry_error;
mod integrator_choice;
mod joint;
mod load;
mod loads;
mod mesh_file;
mod motion;
mod place;
mod problem;
mod read;
mod reader;
mod scene_text;
mod shape;
mod surface;
mod tree;
mod write;
mod write_joints;

pub use builtin::{BUILTIN, Builtin, builtin};
pub use description::{
    BodyScene, BoxScene, Copies, Geometry, JointScene, MassScene, MeshNotes, MeshScene,
    MotionScene, OutputScene, Scene, WallScene,
};
pub use integrator_choice::{StepLimits, load_with_integrator};
pub use load::{LoadOptions, Loaded, load_builtin, load_file, load_text};
pub(crate) use load::{load_recorded, load_recorded_file};
pub(crate) use mesh_file::{copy_name, is_copy};
pub use place::Source;
pub use problem::SceneError;
pub use reader::nearest;
pub(crate) use scene_text::read_scene_text;
pub(crate) use write::HEADER;
