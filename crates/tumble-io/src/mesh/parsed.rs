//! What each mesh reader returns.

use std::path::PathBuf;

use glam::DVec3;

/// The vertices and triangles of a file, and its counts.
pub(super) struct Parsed {
    pub(super) vertices: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) face_count: usize,
    pub(super) object_count: usize,
    /// The other files that were read, relative to the folder of the file.
    pub(super) side_files: Vec<PathBuf>,
}
