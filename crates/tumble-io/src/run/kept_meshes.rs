//! Keeps the meshes of a run with its folder, so that the run can be moved and copied.
//!
//! If mesh and run are in the tree of the scene, the run names the mesh by a path from its own folder: they are moved
//! together. Any other mesh is copied into the folder of the run.

use std::fs::File;
use std::path::{Component, Path, PathBuf};

use super::error::RunError;
use super::folder::RunFolder;
use crate::scene::{Geometry, MeshScene, Scene, copy_name, is_copy};

/// The scene as the run in `folder` keeps it, as TOML. Meshes are copied if need be.
///
/// # Errors
/// [`RunError::KeepMesh`] or [`RunError::Write`].
pub(super) fn kept_toml(scene: &Scene, folder: &RunFolder) -> Result<String, RunError> {
    let has_mesh = scene.bodies.iter().any(|body| matches!(body.geometry, Geometry::Mesh(_)));
    if !has_mesh {
        return Ok(scene.to_toml());
    }
    let run = folder.path().canonicalize();
    let run = run.map_err(|error| RunError::Write(folder.path().to_owned(), error))?;
    let mut scene = scene.clone();
    // bodies may share a mesh
    let mut copied = Vec::new();
    for body in &mut scene.bodies {
        let Geometry::Mesh(mesh) = &mut body.geometry else { continue };
        let origin = mesh.origin.take().filter(|_| is_copy(mesh));
        let kept = match path_in_tree(mesh, &run) {
            Some(path) => path,
            None => {
                let name = copy_name(mesh);
                if !copied.contains(&name) {
                    copy(mesh, &name, folder)?;
                    copied.push(name.clone());
                }
                name
            }
        };
        let found = std::mem::replace(&mut mesh.path, PathBuf::from(kept));
        mesh.origin = origin.or(Some(found));
    }
    Ok(scene.to_toml())
}

/// The path of the mesh from the folder `run`, if both are in the tree of the scene.
fn path_in_tree(mesh: &MeshScene, run: &Path) -> Option<String> {
    let is_inside = run.starts_with(&mesh.tree) && mesh.path.starts_with(&mesh.tree);
    if is_inside { relative(run, &mesh.path) } else { None }
}

/// The path from a folder to a file, with `/` on every system; `None` if it is not Unicode.
fn relative(folder: &Path, file: &Path) -> Option<String> {
    let shared = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| Some(".."));
    let down = file.components().skip(shared).map(|part| match part {
        Component::Normal(name) => name.to_str(),
        _ => None,
    });
    Some(up.chain(down).collect::<Option<Vec<_>>>()?.join("/"))
}

/// Copies the mesh and its side files into the folder of the run. `name` is that of the copy.
fn copy(mesh: &MeshScene, name: &str, folder: &RunFolder) -> Result<(), RunError> {
    let parent = |path: &Path| path.parent().unwrap_or(Path::new("")).to_owned();
    let (from, to) = (parent(&mesh.path), parent(Path::new(name)));
    let sides = mesh.side_files.iter().map(|side| (from.join(side), to.join(side)));
    for (source, target) in sides.chain([(mesh.path.clone(), PathBuf::from(name))]) {
        let file =
            File::open(&source).map_err(|error| RunError::KeepMesh(source.clone(), error))?;
        folder.copy_file(file, &target)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::fs;

    use super::*;
    use crate::scene::{LoadOptions, load_file};

    const TETRAHEDRON: &str =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

    #[test]
    fn a_relative_path_leads_from_the_folder_to_the_file() {
        let path = |folder: &str, file: &str| relative(Path::new(folder), Path::new(file)).unwrap();
        assert_eq!(path("/p/run", "/p/meshes/a.obj"), "../meshes/a.obj");
        assert_eq!(path("/p/out/run", "/p/a.obj"), "../../a.obj");
        assert_eq!(path("/p", "/p/meshes/a.obj"), "meshes/a.obj");
    }

    /// The scene that is kept of `p/s.toml` with this mesh, for a run in `run`.
    fn kept(dir: &Path, mesh: &str, run: &str) -> String {
        fs::create_dir_all(dir.join("p/meshes")).unwrap();
        fs::write(dir.join("a.obj"), TETRAHEDRON).unwrap();
        fs::write(dir.join("p/meshes/a.obj"), TETRAHEDRON).unwrap();
        let scene = dir.join("p/s.toml");
        fs::write(
            &scene,
            format!("[[body]]\nmesh = \"{mesh}\"\n").repeat(2).replacen(
                "]]",
                "]]\nname = \"b\"",
                1,
            ),
        )
        .unwrap();
        let loaded = load_file(&scene, &LoadOptions::default()).unwrap();
        let folder = RunFolder::create(&dir.join(run), false).unwrap();
        kept_toml(&loaded.scene, &folder).unwrap()
    }

    #[test]
    fn a_mesh_in_the_tree_of_the_scene_is_kept_by_a_relative_path() {
        let dir = tempfile::tempdir().unwrap();
        let scene = kept(dir.path(), "meshes/a.obj", "p/out/run");
        assert_eq!(scene.matches("mesh = \"../../meshes/a.obj\"").count(), 2, "{scene}");
        assert!(!dir.path().join("p/out/run/meshes").exists());
    }

    #[test]
    fn any_other_mesh_is_copied_under_its_hash() {
        for (mesh, run) in [("../a.obj", "p/run"), ("meshes/a.obj", "run")] {
            let dir = tempfile::tempdir().unwrap();
            let scene = kept(dir.path(), mesh, run);
            assert_eq!(scene.matches("mesh = \"meshes/").count(), 2, "{scene}");
            let copies: Vec<_> =
                fs::read_dir(dir.path().join(run).join("meshes")).unwrap().collect();
            assert_eq!(copies.len(), 1);
            assert_eq!(
                fs::read_to_string(copies[0].as_ref().unwrap().path()).unwrap(),
                TETRAHEDRON
            );
        }
    }

    #[test]
    fn side_files_are_copied_with_their_mesh() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir_all(dir.path().join("a/data")).unwrap();
        fs::create_dir_all(dir.path().join("p")).unwrap();
        let positions = [[0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let bytes: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        fs::write(dir.path().join("a/data/b.bin"), bytes).unwrap();
        let gltf = r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"uri": "data/b.bin", "byteLength": 36}]}"#;
        fs::write(dir.path().join("a/m.gltf"), gltf).unwrap();
        let (scene, run) = (dir.path().join("p/s.toml"), dir.path().join("p/run"));
        fs::write(&scene, "[[body]]\nmesh = \"../a/m.gltf\"\n").unwrap();
        let loaded = load_file(&scene, &LoadOptions::default()).unwrap();
        let folder = RunFolder::create(&run, false).unwrap();
        let toml = kept_toml(&loaded.scene, &folder).unwrap();
        // only the copies are left
        fs::remove_dir_all(dir.path().join("a")).unwrap();
        fs::write(run.join("scene.toml"), toml).unwrap();
        load_file(&run.join("scene.toml"), &LoadOptions::default()).unwrap();
    }
}
