//! Meshes from files: OBJ, STL, PLY and glTF.
//!
//! The vertices of a mesh are the particles of a body, so it matters which ones a file gives:
//!
//! - **OBJ and PLY keep the file's vertices as they are**, all of them and in the file's order, also those that
//!   no face uses.
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
//! Every reader takes any bytes at all: it gives a mesh or a [`ReadError`], in memory and time that are in
//! proportion to the size of the file. Lengths are taken as they stand: a file has no unit, tumble's is the metre.

mod file;
mod gltf;
mod obj;
mod ply;
mod polygon;
mod stl;
mod text;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};

use glam::DVec3;
use sha2::{Digest, Sha256};
use tumble::Mesh;

/// The formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ, text (`.obj`).
    Obj,
    /// STL, text or binary (`.stl`).
    Stl,
    /// Polygon file format, text or binary of either byte order (`.ply`).
    Ply,
    /// glTF 2, text or binary (`.gltf`, `.glb`; the content tells which).
    Gltf,
}

impl Format {
    /// What can be read, for messages.
    pub const SUPPORTED: &'static str = ".obj, .stl, .ply, .gltf, .glb";

    /// The format of a file extension without its dot, in upper or lower case.
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }

    /// Whether exact duplicates are welded unless the caller says otherwise.
    pub fn welds(self) -> bool {
        matches!(self, Self::Stl | Self::Gltf)
    }

    /// The format that the first bytes belong to, where they are telling.
    fn sniff(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [b'g', b'l', b'T', b'F', ..] => Some(Self::Gltf),
            [b'p', b'l', b'y', b'\n' | b'\r', ..] => Some(Self::Ply),
            [b's', b'o', b'l', b'i', b'd', b' ' | b'\n' | b'\r', ..] => Some(Self::Stl),
            _ => None,
        }
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Ply => "PLY",
            Self::Gltf => "glTF",
        })
    }
}

/// A mesh, and what there is to know about the file it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The mesh: at least one vertex, all finite, all triangles in range.
    pub mesh: Mesh,
    /// The format it was read as.
    pub format: Format,
    /// SHA-256 of the file's bytes, lower-case hexadecimal. Side files of a glTF are not part of it.
    pub sha256: String,
    /// Objects in the file, at least 1: `o` statements (or else `g`) of an OBJ, solids of an STL, nodes with
    /// a mesh of a glTF.
    pub object_count: usize,
    /// Vertices in the file, before any welding.
    pub file_vertex_count: usize,
    /// Faces in the file, of any number of corners.
    pub face_count: usize,
    /// Whether exact duplicates were welded.
    pub welded: bool,
}

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In a text.
    Line {
        /// The line, from 1.
        line: usize,
        /// The byte within the line, from 1.
        column: Option<usize>,
    },
    /// In a binary file, in bytes from its beginning, from 0.
    Byte(u64),
}

/// Why a file gave no mesh: what is wrong, where, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    /// The file, unless the bytes came from elsewhere.
    pub path: Option<PathBuf>,
    /// Where in the file, if it is at one place.
    pub place: Option<Place>,
    /// What is wrong, and what to do.
    pub message: String,
}

impl ReadError {
    fn new(place: Option<Place>, message: impl Into<String>) -> Self {
        Self { path: None, place, message: message.into() }
    }

    fn with_path(self, path: &Path) -> Self {
        Self { path: Some(path.to_owned()), ..self }
    }
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (&self.path, self.place) {
            (Some(path), Some(Place::Line { line, column: None })) => {
                write!(f, "{}:{line}: ", path.display())?;
            }
            (Some(path), Some(Place::Line { line, column: Some(column) })) => {
                write!(f, "{}:{line}:{column}: ", path.display())?;
            }
            (Some(path), Some(Place::Byte(byte))) => {
                write!(f, "{}: at byte {byte}: ", path.display())?;
            }
            (Some(path), None) => write!(f, "{}: ", path.display())?,
            (None, Some(Place::Line { line, column: None })) => write!(f, "line {line}: ")?,
            (None, Some(Place::Line { line, column: Some(column) })) => {
                write!(f, "line {line}, column {column}: ")?;
            }
            (None, Some(Place::Byte(byte))) => write!(f, "at byte {byte}: ")?,
            (None, None) => {}
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for ReadError {}

/// What a reader finds in a file.
struct Parsed {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    face_count: usize,
    object_count: usize,
}

/// Reads a mesh file; its extension tells the format. `weld` overrides the format's default (see the
/// [module](self)).
///
/// # Errors
/// [`ReadError`] when the path is no regular file of a known extension and at most 4 GiB, or its content is no
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

/// Reads a mesh from bytes. `folder` is where the side files of a glTF lie; without one, they are an error.
///
/// # Errors
/// [`ReadError`], without a path, when the bytes are no mesh.
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
        welded,
    })
}

/// Merges vertices that are exactly equal (0 and -0 are), in the order of their first occurrence.
///
/// Triangles are renumbered. One that has the same vertex twice is dropped: it has no area, and no
/// direction. There is no tolerance: vertices that differ in the last bit stay two.
pub fn weld(mesh: Mesh) -> Mesh {
    let mut first_of: HashMap<[u64; 3], u32> = HashMap::new();
    let mut vertices = Vec::new();
    // the new number of each vertex
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
    // triangles, without those that have no area left
    let triangles = mesh
        .triangles
        .iter()
        .map(|triangle| triangle.map(|i| renumbered[i as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    Mesh { vertices, triangles }
}
