//! Scene files, meshes, runs, plots, pictures and exports for [`tumble`].

mod appearance;
pub mod checkpoint;
mod counted;
pub mod export;
pub mod mesh;
mod new_file;
pub mod page;
pub mod picture;
pub mod plot;
mod printable;
pub mod replay;
pub mod run;
pub mod scene;

pub use printable::{on_one_line, printable};
