//! Meshes from files: OBJ, STL, PLY and glTF.
//!
//! The vertices of a mesh are the particles of a body, so each format states which vertices it keeps:
//!
//! - **OBJ and PLY keep all vertices of the file** in its order, including those that no face uses.
//! - **STL and glTF weld exact duplicates**, because these formats repeat a vertex for each triangle or seam;
//!   see [`weld`].
//!
//! `weld: Some(true)` or `Some(false)` overrides that.
//!
//! ```no_run
//! let file = tumble_io::mesh::read_mesh("cat.obj".as_ref(), None)?;
//! println!("{} particles", file.mesh.vertices.len());
//! # Ok::<(), tumble_io::mesh::ReadError>(())
//! ```
//!
//! Data flows one way: `file` (checks the path, reads the bytes) → `format` → one reader per format (`obj`,
//! `stl`, `ply`, `gltf`; with `text` and `polygon`) → `parsed` → [`parse_mesh`], which checks and welds.
//! Every reader reports problems as [`ReadError`] (`error`).
//!
//! To add a format: add a variant to [`Format`] with its extensions, write a reader file with a function
//! `parse` that returns `Parsed`, and call it in [`parse_mesh`]. Then add samples to `tests/mesh_formats`
//! and a target to `fuzz/targets`.
//!
//! A reader reads the whole mesh of a file or refuses it: a part that it does not understand may belong to the surface.
//! Every reader accepts arbitrary bytes and returns a mesh or a [`ReadError`], in memory and time proportional to the size of the
//! file. Lengths are in metres: the numbers of a file are used as they are.

mod error;
mod file;
mod format;
mod gltf;
mod obj;
mod parsed;
mod ply;
mod polygon;
mod stl;
mod text;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use tumble::Mesh;

pub use error::{Place, ReadError};
pub use format::Format;

/// A mesh, with information about its file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The mesh: at least one vertex, all finite, all triangles in range.
    pub mesh: Mesh,
    /// The format it was read as.
    pub format: Format,
    /// SHA-256 of the file's bytes, lower-case hexadecimal. Side files of a glTF are not part of it.
    pub sha256: String,
    /// Number of objects in the file, at least 1: `o` statements (or else `g`) of an OBJ, solids of an STL, nodes with
    /// a mesh of a glTF.
    pub object_count: usize,
    /// Number of vertices in the file, before welding.
    pub file_vertex_count: usize,
    /// Number of faces in the file, with any number of corners.
    pub face_count: usize,
    /// The side files of a glTF, relative to its folder.
    pub side_files: Vec<PathBuf>,
    /// Whether exact duplicates were welded.
    pub welded: bool,
}

/// Reads a mesh file; the extension determines the format. `weld` overrides the format's default (see the
/// [module](self)).
///
/// # Errors
/// [`ReadError`] if the path is not a regular file of a known extension of at most 4 GiB, or if its content is not a
/// mesh.
pub fn read_mesh(path: &Path, weld: Option<bool>) -> Result<MeshFile, ReadError> {
    let read = || {
        file::check_exists(path)?;
        let format = file::format_of(path)?;
        let bytes = file::read(path)?;
        parse_mesh(format, &bytes, path.parent(), weld)
    };
    read().map_err(|error: ReadError| error.with_path(path))
}

/// Reads a mesh from bytes. `folder` holds the side files of a glTF; without it, side files are an error.
///
/// # Errors
/// [`ReadError`], without a path, if the bytes are not a mesh.
pub fn parse_mesh(
    format: Format,
    bytes: &[u8],
    folder: Option<&Path>,
    weld: Option<bool>,
) -> Result<MeshFile, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::new(None, format!("the file is empty; {format} is expected")));
    }
    let parsed = match format {
        Format::Obj => obj::parse(bytes),
        Format::Stl => stl::parse(bytes),
        Format::Ply => ply::parse(bytes),
        Format::Gltf => gltf::parse(bytes, folder),
    };
    let parsed = parsed.map_err(|mut error| {
        // a file with the wrong extension
        if let Some(other) = Format::sniff(bytes).filter(|&other| other != format) {
            error.message += &format!(" (the content looks like {other}: is the extension right?)");
        }
        error
    })?;
    let file_vertex_count = parsed.vertices.len();
    let mesh = Mesh::new(parsed.vertices, parsed.triangles)
        .map_err(|error| ReadError::new(None, error.to_string()))?;
    let welded = weld.unwrap_or(format.welds());
    Ok(MeshFile {
        mesh: if welded { self::weld(mesh) } else { mesh },
        format,
        sha256: Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect(),
        object_count: parsed.object_count,
        file_vertex_count,
        face_count: parsed.face_count,
        side_files: parsed.side_files,
        welded,
    })
}

/// Merges vertices that are exactly equal (0 and -0 are), in the order of their first occurrence.
///
/// Triangles are renumbered. A triangle with the same vertex twice has no area and is dropped. There is no tolerance: vertices that
/// differ in the last bit stay separate.
pub fn weld(mesh: Mesh) -> Mesh {
    let mut first_of: HashMap<[u64; 3], u32> = HashMap::new();
    let mut vertices = Vec::new();
    // the new index of each vertex
    let renumbered: Vec<u32> = mesh
        .vertices
        .iter()
        .map(|&vertex| {
            // adding 0 turns -0 into 0
            let key = (vertex + 0.0).to_array().map(f64::to_bits);
            match first_of.entry(key) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => {
                    vertices.push(vertex);
                    *new.insert(vertices.len() as u32 - 1)
                }
            }
        })
        .collect();
    // drop triangles without area
    let triangles = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.map(|i| renumbered[i as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    Mesh { vertices, triangles }
}
