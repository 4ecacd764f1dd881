//! Finds and reads the mesh file of a body.
//!
//! The scene of a run names its mesh by a path from the folder of the run, so that both can be moved or copied
//! together. If the mesh is not there, it is looked for where it was when the run began, and then in the folder of the
//! run under its hash. A file counts only if it has the hash that the scene asks for.

use std::path::{Component, Path, PathBuf};

use tumble::Mesh;

use super::description::{MeshNotes, MeshScene};
use super::geometry_error::{GeometryError, error};
use crate::counted::counted;
use crate::mesh::{MeshFile, ReadError, prepare, read_mesh};

/// The folder in the folder of a run that holds copies of meshes.
pub(crate) const MESHES_FOLDER: &str = "meshes";

/// Why a file is not the mesh.
enum Miss {
    Unreadable(ReadError),
    /// The file has another hash.
    Other {
        path: PathBuf,
        sha256: String,
    },
}

/// Reads the mesh, and fills in its path, hash, tree and side files. Relative paths start at `folder`, which is that of the scene.
pub fn load(mesh: &mut MeshScene, folder: &Path) -> Result<Mesh, GeometryError> {
    let places = places(mesh, folder);
    let mut misses = Vec::new();
    for place in &places {
        match read(mesh, place) {
            Ok(file) => {
                mesh.tree = tree(mesh, folder);
                mesh.path = canonical(place);
                mesh.side_files.clone_from(&file.side_files);
                mesh.sha256.clone_from(&file.sha256);
                return put_right(mesh, &file);
            }
            Err(miss) => misses.push(miss),
        }
    }
    Err(not_found(mesh, &places, misses))
}

/// The mesh of a file with its triangles put right; says what was done.
fn put_right(mesh: &mut MeshScene, file: &MeshFile) -> Result<Mesh, GeometryError> {
    let prepared = prepare(&file.mesh, mesh.repair).map_err(|cause| {
        let path = mesh.path.display();
        error("mesh_repair", format!("cannot be done for {path}, in the unit of the file: {cause}"))
    })?;
    let of_weld = file.weld.filter(|weld| weld.near > 0).map(|weld| {
        let vertices = counted(weld.near, "vertex", "vertices");
        let collapsed = match weld.collapsed {
            0 => String::new(),
            n => format!("; {} of no area left out", counted(n, "triangle", "triangles")),
        };
        format!(
            "{vertices} at open edges within {:.2e} of others: merged{collapsed}",
            weld.tolerance
        )
    });
    mesh.notes = MeshNotes {
        points: of_weld.into_iter().chain(prepared.repair_note()).collect(),
        triangles: prepared.notes(),
        unit: file.header_unit,
    };
    Ok(prepared.mesh)
}

/// The paths at which the mesh may be, in the order in which they are tried.
fn places(mesh: &MeshScene, folder: &Path) -> Vec<PathBuf> {
    let mut places = vec![folder.join(&mesh.path)];
    let Some(origin) = &mesh.origin else { return places };
    // a path that the user has changed since then asks for another mesh
    let is_unchanged = mesh.path.file_name() == origin.file_name() || is_copy(mesh);
    if is_unchanged && is_hash(&mesh.sha256) {
        places.push(origin.clone());
        places.push(folder.join(copy_name(mesh)));
    }
    places
}

/// The name of a copy of the mesh, from the folder of the run.
pub(crate) fn copy_name(mesh: &MeshScene) -> String {
    let hash = &mesh.sha256;
    let ending = mesh.path.extension().unwrap_or_default().to_string_lossy();
    if mesh.side_files.is_empty() {
        format!("{MESHES_FOLDER}/{hash}.{ending}")
    } else {
        // the names of side files may be the same for different meshes
        format!("{MESHES_FOLDER}/{hash}/{hash}.{ending}")
    }
}

/// Whether the path is that of a copy under the hash of the mesh.
pub(crate) fn is_copy(mesh: &MeshScene) -> bool {
    is_hash(&mesh.sha256) && mesh.path.file_stem().is_some_and(|stem| stem == mesh.sha256.as_str())
}

fn is_hash(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

fn read(mesh: &MeshScene, path: &Path) -> Result<MeshFile, Miss> {
    let file = read_mesh(path, mesh.weld).map_err(Miss::Unreadable)?;
    if mesh.sha256.is_empty() || mesh.sha256 == file.sha256 {
        return Ok(file);
    }
    Err(Miss::Other { path: path.to_owned(), sha256: file.sha256 })
}

/// The folder of the scene or, if a run wrote the scene and names the mesh by a path that leads out of its folder, the
/// folder in which both are.
fn tree(mesh: &MeshScene, folder: &Path) -> PathBuf {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let mut tree = canonical(folder);
    if mesh.origin.is_some() {
        let is_up = |part: &Component| *part == Component::ParentDir;
        for _ in mesh.path.components().take_while(is_up) {
            tree.pop();
        }
    }
    tree
}

/// The path without links, since a link may lead out of the tree.
fn canonical(path: &Path) -> PathBuf {
    let absolute = || std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    path.canonicalize().unwrap_or_else(|_| absolute())
}

fn not_found(mesh: &MeshScene, places: &[PathBuf], misses: Vec<Miss>) -> GeometryError {
    let advice = match places {
        [_, .., copy] => format!("; put that mesh back, or save it as {}", copy.display()),
        _ => String::new(),
    };
    let other = misses.iter().find_map(|miss| match miss {
        Miss::Other { path, sha256 } => Some((path, sha256)),
        Miss::Unreadable(_) => None,
    });
    if let Some((path, sha256)) = other {
        let message = format!(
            "does not match: {} has the hash {sha256}, but the mesh that this scene was made with has {}{advice}",
            path.display(),
            mesh.sha256
        );
        return error("mesh_sha256", message);
    }
    let first = misses.into_iter().find_map(|miss| match miss {
        Miss::Unreadable(problem) => Some(problem.to_string()),
        Miss::Other { .. } => None,
    });
    let elsewhere = match places {
        [_, origin, _] => {
            format!("; nor is the mesh with the hash {} at {}", mesh.sha256, origin.display())
        }
        _ => String::new(),
    };
    error("mesh", format!("{}{elsewhere}{advice}", first.unwrap_or_default()))
}
