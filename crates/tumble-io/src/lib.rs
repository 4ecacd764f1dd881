//! Scenes, meshes, recordings, plots and pictures for [`tumble`].

pub mod checkpoint;
pub mod export;
mod looks;
pub mod mesh;
pub mod page;
pub mod picture;
pub mod plot;
pub mod replay;
pub mod run;
pub mod scene;
