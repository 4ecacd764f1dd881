//! Scenes: TOML files that say what to simulate.
//!
//! [`load_file`] and [`load_builtin`] read a scene, lay `--set` overrides over it, check every key
//! and build the world. Whatever is wrong is reported at once, with file, line and column.

mod body;
mod builtin;
mod copies;
mod description;
mod geometry;
mod load;
mod motion;
mod problem;
mod read;
mod reader;
mod surface;
mod tree;
mod write;

pub use builtin::{BUILTIN, Builtin, builtin};
pub use description::{
    BodyScene, BoxScene, Copies, Geometry, MassScene, MotionScene, OutputScene, Scene, WallScene,
};
pub use load::{LoadOptions, Loaded, load_builtin, load_file, load_text};
pub use problem::{SceneError, Source};
pub use reader::nearest;
pub(crate) use write::HEADER;
