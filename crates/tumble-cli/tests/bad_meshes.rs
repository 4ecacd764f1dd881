//! Scenes with unusable meshes: the message gives the place in the scene and in the mesh.

#![allow(clippy::unwrap_used)]

mod common;

use common::{TETRAHEDRON, TestDir, assert_contains};

fn rejected(dir: &TestDir, keys: &str) -> String {
    dir.rejected(format!("[[body]]\n{keys}\n"), &[])
}

#[test]
fn invalid_mesh_files_are_rejected() {
    let dir = TestDir::new();
    dir.write("t.obj", TETRAHEDRON);
    dir.write("empty.obj", "");
    dir.write("bare.obj", "# nothing\n");
    dir.write("nan.obj", "v 0 0 0\nv 1 nan 0\n");
    dir.write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    let binary: Vec<u8> =
        (0..5000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    dir.write("binary.obj", binary);
    let mut stl = vec![0u8; 80];
    stl.extend((u32::MAX - 1).to_le_bytes());
    stl.extend([0u8; 107]);
    dir.write("huge.stl", stl);
    dir.write("cat.xyz", "");
    std::fs::create_dir(dir.path("folder.obj")).unwrap();
    let cases: [(&str, &[&str]); 10] = [
        ("tt.obj", &["tt.obj", "no such file", "did you mean \"t.obj\"?"]),
        ("no/t.obj", &["the folder no does not exist"]),
        ("folder.obj", &["folder.obj", "this is a folder"]),
        ("empty.obj", &["the file is empty"]),
        ("bare.obj", &["no vertices"]),
        ("nan.obj", &["nan.obj", "nan.obj:2:5"]),
        ("range.obj", &["range.obj:4:", "vertex 4", "only 3 vertices"]),
        ("binary.obj", &["binary.obj"]),
        ("huge.stl", &["4294967294 triangles", "the file has 191"]),
        ("cat.xyz", &[".obj, .stl, .ply, .gltf, .glb"]),
    ];
    for (mesh, parts) in cases {
        let message = rejected(&dir, &format!("mesh = \"{mesh}\""));
        assert_contains(&message, &["error: `body.0.mesh`", "s.toml:2:8"]);
        assert_contains(&message, parts);
        assert!(message.len() < 2000);
    }
}

#[test]
fn a_missing_mesh_is_reported_with_all_other_problems() {
    let dir = TestDir::new();
    let message =
        rejected(&dir, "mesh = \"a.obj\"\nscal = 2\n[[body]]\nname = \"b\"\nmesh = \"b.obj\"");
    assert_contains(&message, &["s.toml:2:8", "s.toml:3:1", "s.toml:6:8", "`scale`", "3 problems"]);
}

#[test]
fn an_open_mesh_has_no_volume() {
    let dir = TestDir::new();
    dir.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let mesh = "mesh = \"open.obj\"";
    let message = rejected(&dir, &format!("{mesh}\nmass_model = \"solid\""));
    assert_contains(&message, &["`body.0.mass_model`", "s.toml:3:14", "open"]);
    let message = rejected(&dir, &format!("{mesh}\ndensity = 1000"));
    assert_contains(&message, &["`body.0.density`", "s.toml:3:11"]);
    let message = rejected(&dir, &format!("{mesh}\nsampling = \"volume\"\nspacing = 0.1"));
    assert_contains(&message, &["`body.0.sampling`", "s.toml:3:12"]);
}

#[test]
fn points_without_triangles_have_no_surface() {
    let dir = TestDir::new();
    dir.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let mesh = "mesh = \"points.obj\"";
    let message = rejected(&dir, &format!("{mesh}\nmass_model = \"shell\""));
    assert_contains(&message, &["`body.0.mass_model`", "s.toml:3:14"]);
    let message = rejected(&dir, &format!("{mesh}\nsampling = \"surface\"\nspacing = 0.1"));
    assert_contains(&message, &["`body.0.sampling`", "s.toml:3:12"]);
}

#[test]
fn too_fine_sampling_is_rejected_at_once() {
    let dir = TestDir::new();
    let start = std::time::Instant::now();
    for (sampling, spacing) in [("surface", "1e-9"), ("volume", "1e-300"), ("surface", "5e-324")] {
        let keys = format!("shape = \"sphere\"\nsampling = \"{sampling}\"\nspacing = {spacing}");
        assert_contains(&rejected(&dir, &keys), &["`body.0.sampling`", "s.toml:3:12", "would do"]);
    }
    assert!(start.elapsed() < std::time::Duration::from_secs(20));
}

#[test]
fn a_mesh_with_another_hash_is_rejected() {
    let dir = TestDir::new();
    dir.write("t.obj", TETRAHEDRON);
    let message = rejected(&dir, "mesh = \"t.obj\"\nmesh_sha256 = \"00\"");
    assert_contains(&message, &["`body.0.mesh_sha256` does not match", "s.toml:3:15"]);
}
