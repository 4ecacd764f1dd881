//! Meshes from files: OBJ, STL, PLY and glTF.
//!
//! The vertices of a mesh are the particles of a body, so each format states which vertices it keeps:
//!
//! - **OBJ and PLY keep all vertices of the file** in its order, including those that no face uses.
//! - **STL and glTF weld**, because these formats repeat a vertex for each triangle or seam: equal vertices
//!   are one, and so are vertices at open edges that differ by rounding; see [`Weld`].
//!
//! The argument `weld` overrides that. [`prepare`] then puts the triangles right.
//!
//! ```no_run
//! let file = tumble_io::mesh::read_mesh("cat.obj".as_ref(), None)?;
//! println!("{} particles", file.mesh.vertices.len());
//! # Ok::<(), tumble_io::mesh::ReadError>(())
//! ```
//!
//! Data flows one way: `file` (checks the path, reads the bytes) → `format` → one reader per format (`obj`,
//! `stl`, `ply`, `gltf`; with `text` and `polygon`) → `parsed` → [`parse_mesh`], which checks and welds (`weld`, `unit`).
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
mod prepare;
mod stl;
mod text;
mod unit;
mod weld;

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use tumble::{Mesh, Welded};

pub use error::{Place, ReadError};
pub use format::Format;
pub use prepare::{Prepared, Repair, prepare};
pub use unit::LengthUnit;
pub use weld::{Weld, WeldReport};

/// The most bytes of a file in which the name of a text STL is looked for.
const HEADER: usize = 500;

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
    /// What was merged; `None` if each vertex of the file stayed one.
    pub weld: Option<WeldReport>,
    /// The unit of length that the header of an STL names. The numbers are not converted.
    pub header_unit: Option<LengthUnit>,
}

/// Reads a mesh file; the extension determines the format. `weld` overrides the format's default (see the
/// [module](self)).
///
/// # Errors
/// [`ReadError`] if the path is not a regular file of a known extension of at most 4 GiB, or if its content is not a
/// mesh.
pub fn read_mesh(path: &Path, weld: Option<Weld>) -> Result<MeshFile, ReadError> {
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
    weld: Option<Weld>,
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
    let (mesh, weld) = match weld.unwrap_or(format.welds().into()) {
        Weld::Never => (mesh, None),
        Weld::Auto => merged(mesh.welded(None)),
        Weld::Within(tolerance) => merged(mesh.welded(Some(tolerance))),
    };
    Ok(MeshFile {
        mesh,
        format,
        sha256: Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect(),
        object_count: parsed.object_count,
        file_vertex_count,
        face_count: parsed.face_count,
        side_files: parsed.side_files,
        weld,
        header_unit: header_unit(format, bytes),
    })
}

fn merged(found: Welded) -> (Mesh, Option<WeldReport>) {
    let report = WeldReport::from(&found);
    (found.mesh, Some(report))
}

/// The unit that the header of an STL names: the first line of a text, the first bytes of a binary file.
fn header_unit(format: Format, bytes: &[u8]) -> Option<LengthUnit> {
    let header = &bytes[..bytes.len().min(HEADER)];
    let line = header.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let is_text = format == Format::Stl && line.len() < header.len() && line.is_ascii();
    match format {
        Format::Stl if is_text => unit::in_header(line),
        Format::Stl => unit::in_header(&bytes[..bytes.len().min(80)]),
        _ => None,
    }
}
