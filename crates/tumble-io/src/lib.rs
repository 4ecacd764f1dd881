//! Scenes, meshes, recordings, plots and pictures for [`tumble`].

mod appearance;
pub mod checkpoint;
pub mod export;
pub mod mesh;
pub mod page;
pub mod picture;
pub mod plot;
pub mod replay;
pub mod run;
pub mod scene;
