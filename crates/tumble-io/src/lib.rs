//! Scenes, meshes, recordings, plots and pictures for [`tumble`].

pub mod picture;
pub mod plot;
