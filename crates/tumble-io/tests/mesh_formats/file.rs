use std::fs;

use tumble::Mesh;
use tumble_io::mesh::{Format, Place, Weld, parse_mesh, read_mesh};

use super::{area_and_volume, assert_contains, parse_valid, samples, v};

#[test]
fn all_formats_give_the_same_tetrahedron() {
    let cases = [
        (Format::Obj, samples::obj()),
        (Format::Stl, samples::stl_text()),
        (Format::Stl, samples::stl_binary(b"solid")),
        (Format::Ply, samples::ply("ascii")),
        (Format::Ply, samples::ply("binary_little_endian")),
        (Format::Ply, samples::ply("binary_big_endian")),
        (Format::Gltf, samples::gltf()),
        (Format::Gltf, samples::glb()),
    ];
    let expected: Vec<_> = samples::VERTICES.map(|p| glam::Vec3::from(p).as_dvec3()).to_vec();
    let triangles = samples::TRIANGLES.map(|t| t.map(u32::from));
    for (format, bytes) in cases {
        let file = parse_valid(format, &bytes);
        let sorted = |mesh: &Mesh| {
            let corner = |i: u32| mesh.vertices[i as usize].to_array().map(|c| (c * 4.0) as i64);
            let mut all: Vec<_> = mesh.triangles.iter().map(|t| t.map(corner)).collect();
            all.sort_unstable();
            all
        };
        assert_eq!(file.mesh.vertices.len(), 4);
        let reference = Mesh::new(expected.clone(), triangles.to_vec()).unwrap();
        assert_eq!(sorted(&file.mesh), sorted(&reference), "{format}");
        if format != Format::Stl {
            assert_eq!(file.mesh, reference, "{format}");
        }
        assert_eq!(area_and_volume(&file).1.abs(), 0.75, "{format}");
        assert_eq!((file.format, file.object_count, file.face_count), (format, 1, 4));
    }
}

#[test]
fn a_mesh_file_is_read_and_hashed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Point.OBJ");
    fs::write(&path, "v 1 2 3\n").unwrap();
    let file = read_mesh(&path, None).unwrap();
    assert_eq!(file.mesh.vertices, [v(1.0, 2.0, 3.0)]);
    // computed with sha256sum
    assert_eq!(file.sha256, HASH);
}

const HASH: &str = "d84416b98ab0f76a39095f9653d2fa0436d3ce2d7a326f708c6be9547771c4ef";

#[test]
fn errors_report_file_line_and_column() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.obj");
    fs::write(&path, "v 1 2 3\nf 1 1 7\n").unwrap();
    let error = read_mesh(&path, None).unwrap_err();
    assert_eq!(error.path.as_deref(), Some(path.as_path()));
    assert_eq!(error.place, Some(Place::Line { line: 2, column: Some(7) }));
    assert_contains(
        &error.to_string(),
        &["bad.obj:2:7: face refers to vertex 7, but the file has only 1 vertex"],
    );
}

#[test]
fn paths_that_are_not_mesh_files_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str| read_mesh(&folder.path().join(name), None).unwrap_err().to_string();
    fs::write(folder.path().join("cat.obj"), "v 1 2 3\n").unwrap();
    fs::write(folder.path().join("mesh.fbx"), "").unwrap();
    fs::write(folder.path().join("mesh"), "").unwrap();
    fs::write(folder.path().join("empty.stl"), "").unwrap();
    fs::create_dir(folder.path().join("folder.obj")).unwrap();
    assert_contains(&message("cta.obj"), &["no such file; did you mean \"cat.obj\"?"]);
    assert_contains(&message("cat.stl"), &["did you mean \"cat.obj\"?"]);
    assert!(message("elephant.obj").ends_with("no such file"));
    assert_contains(&message("nowhere/cat.obj"), &["the folder", "does not exist"]);
    assert_contains(
        &message("mesh.fbx"),
        &["unknown mesh format .fbx", ".obj, .stl, .ply, .gltf, .glb"],
    );
    assert_contains(&message("mesh"), &["no extension"]);
    assert_contains(&message("empty.stl"), &["empty"]);
    assert_contains(&message("folder.obj"), &["this is a folder"]);
}

#[test]
fn files_above_4_gib_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("huge.stl");
    // a sparse file takes no disk space
    if fs::File::create(&path).unwrap().set_len((4 << 30) + 1).is_ok() {
        assert_contains(
            &read_mesh(&path, None).unwrap_err().to_string(),
            &["4.0 GiB", "at most 4 GiB"],
        );
    }
}

#[cfg(unix)]
#[test]
fn devices_sockets_and_pipes_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("zero.obj");
    std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
    assert_contains(&read_mesh(&path, None).unwrap_err().to_string(), &["not a regular file"]);
    let socket = folder.path().join("socket.obj");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    assert_contains(&read_mesh(&socket, None).unwrap_err().to_string(), &["not a regular file"]);
    let pipe = folder.path().join("pipe.obj");
    if std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|s| s.success()) {
        assert_contains(&read_mesh(&pipe, None).unwrap_err().to_string(), &["not a regular file"]);
    }
}

#[test]
fn welding_without_a_tolerance_merges_equal_vertices_only() {
    let vertices = vec![
        v(1.0, 0.0, 0.0),
        v(0.0, -0.0, 0.0),
        v(1.0, -0.0, 0.0),
        v(1.0 + f64::EPSILON, 0.0, 0.0),
        v(0.0, 0.0, -0.0),
        v(0.0, 1.0, 0.0),
    ];
    let triangles = vec![[0, 1, 5], [2, 3, 4], [0, 2, 5], [5, 4, 1]];
    let weld = |mesh: Mesh| mesh.welded(Some(0.0)).mesh;
    let welded = weld(Mesh::new(vertices, triangles).unwrap());
    // in the order of first occurrence; degenerate triangles are removed
    let expected =
        [v(1.0, 0.0, 0.0), v(0.0, 0.0, 0.0), v(1.0 + f64::EPSILON, 0.0, 0.0), v(0.0, 1.0, 0.0)];
    assert_eq!(welded.vertices, expected);
    assert!(welded.vertices[1].y.is_sign_negative(), "the first occurrence is kept unchanged");
    assert_eq!(welded.triangles, [[0, 1, 3], [0, 2, 1]]);
    assert_eq!(weld(welded.clone()), welded);
}

#[test]
fn the_caller_can_override_welding() {
    let text = b"v 0 0 0\nv 0 0 0\n";
    let count = |weld| parse_mesh(Format::Obj, text, None, weld).unwrap().mesh.vertices.len();
    assert_eq!((count(None), count(Some(Weld::Never)), count(Some(Weld::Auto))), (2, 2, 1));
    assert_eq!(count(Some(Weld::Within(0.0))), 1);
}
