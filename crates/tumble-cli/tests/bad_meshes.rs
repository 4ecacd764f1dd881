//! Scenes whose meshes cannot be used: the message names the scene's line and the mesh's own.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Desk, TETRAHEDRON, says};

fn refused(desk: &Desk, keys: &str) -> String {
    desk.refused(format!("[[body]]\n{keys}\n"), &[])
}

#[test]
fn a_file_that_is_no_mesh() {
    let desk = Desk::new();
    desk.write("t.obj", TETRAHEDRON);
    desk.write("empty.obj", "");
    desk.write("bare.obj", "# nothing\n");
    desk.write("nan.obj", "v 0 0 0\nv 1 nan 0\n");
    desk.write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    let binary: Vec<u8> =
        (0..5000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    desk.write("binary.obj", binary);
    let mut stl = vec![0u8; 80];
    stl.extend(u32::MAX.to_le_bytes());
    stl.extend([0u8; 100]);
    desk.write("huge.stl", stl);
    desk.write("cat.xyz", "");
    std::fs::create_dir(desk.path("folder.obj")).unwrap();
    let cases: [(&str, &[&str]); 10] = [
        ("tt.obj", &["tt.obj", "no such file", "did you mean \"t.obj\"?"]),
        ("no/t.obj", &["the folder no does not exist"]),
        ("folder.obj", &["folder.obj", "this is a folder"]),
        ("empty.obj", &["the file is empty"]),
        ("bare.obj", &["no vertices"]),
        ("nan.obj", &["nan.obj", "nan.obj:2:5"]),
        ("range.obj", &["range.obj:4:", "vertex 4", "only 3 vertices"]),
        ("binary.obj", &["binary.obj"]),
        ("huge.stl", &["4294967295 triangles", "the file has 184"]),
        ("cat.xyz", &[".obj, .stl, .ply, .gltf, .glb"]),
    ];
    for (mesh, parts) in cases {
        let message = refused(&desk, &format!("mesh = \"{mesh}\""));
        says(&message, &["error: `body.0.mesh`", "s.toml:2:8"]);
        says(&message, parts);
        assert!(message.len() < 2000);
    }
}

#[test]
fn a_missing_mesh_is_told_along_with_everything_else() {
    let desk = Desk::new();
    let message =
        refused(&desk, "mesh = \"a.obj\"\nscal = 2\n[[body]]\nname = \"b\"\nmesh = \"b.obj\"");
    says(&message, &["s.toml:2:8", "s.toml:3:1", "s.toml:6:8", "`scale`", "3 problems"]);
}

#[test]
fn an_open_mesh_has_no_inside() {
    let desk = Desk::new();
    desk.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let mesh = "mesh = \"open.obj\"";
    let message = refused(&desk, &format!("{mesh}\nmass_model = \"solid\""));
    says(&message, &["`body.0.mass_model`", "s.toml:3:14", "open"]);
    let message = refused(&desk, &format!("{mesh}\ndensity = 1000"));
    says(&message, &["`body.0.density`", "s.toml:3:11"]);
    let message = refused(&desk, &format!("{mesh}\nsampling = \"volume\"\nspacing = 0.1"));
    says(&message, &["`body.0.sampling`", "s.toml:3:12"]);
}

#[test]
fn points_without_triangles_have_no_surface() {
    let desk = Desk::new();
    desk.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let mesh = "mesh = \"points.obj\"";
    let message = refused(&desk, &format!("{mesh}\nmass_model = \"shell\""));
    says(&message, &["`body.0.mass_model`", "s.toml:3:14"]);
    let message = refused(&desk, &format!("{mesh}\nsampling = \"surface\"\nspacing = 0.1"));
    says(&message, &["`body.0.sampling`", "s.toml:3:12"]);
}

#[test]
fn sampling_too_finely_is_refused_before_any_work() {
    let desk = Desk::new();
    let start = std::time::Instant::now();
    for (sampling, spacing) in [("surface", "1e-9"), ("volume", "1e-300"), ("surface", "5e-324")] {
        let keys = format!("shape = \"sphere\"\nsampling = \"{sampling}\"\nspacing = {spacing}");
        says(&refused(&desk, &keys), &["`body.0.sampling`", "s.toml:3:12", "would do"]);
    }
    assert!(start.elapsed() < std::time::Duration::from_secs(20));
}

#[test]
fn a_mesh_of_another_hash_is_refused() {
    let desk = Desk::new();
    desk.write("t.obj", TETRAHEDRON);
    let message = refused(&desk, "mesh = \"t.obj\"\nmesh_sha256 = \"00\"");
    says(&message, &["`body.0.mesh_sha256` does not match", "s.toml:3:15"]);
}
