//! `tumble info`: a mesh whose properties are known, and invalid meshes.

#![allow(clippy::unwrap_used)]

mod common;

use common::{TETRAHEDRON, TestDir, assert_contains};

#[test]
fn the_properties_of_a_tetrahedron_are_printed() {
    let dir = TestDir::new();
    dir.write("t.obj", TETRAHEDRON);
    let outcome = dir.tumble(&["info", "t.obj"]).expect_status(0);
    assert_eq!(outcome.stderr, "");
    let line = |key: &str| {
        outcome.stdout.lines().find(|line| line.trim().starts_with(key)).unwrap_or(key).to_owned()
    };
    assert_contains(&line("file"), &["OBJ"]);
    assert_contains(&line("particles"), &["4"]);
    assert_contains(&line("triangles"), &["4"]);
    assert_contains(&line("mass"), &["4 kg"]);
    assert_contains(&line("centre"), &["(0.25, 0.25, 0.25)"]);
    assert_contains(&line("size"), &["(1, 1, 1)"]);
    assert_contains(&line("watertight"), &["yes"]);
    // 1/6 m³, and 3/2 + √3/2 m²
    assert_contains(&line("volume"), &["0.16667 m³, centred at (0.25, 0.25, 0.25) m"]);
    assert_contains(&line("surface"), &["2.366"]);

    let outcome = dir.tumble(&["info", "t.obj", "--scale", "2", "--particle-mass", "0.5"]);
    assert_contains(&outcome.expect_status(0).stdout, &["mass               2 kg", "1.3333 m³"]);
}

#[test]
fn vertices_at_one_point_are_named() {
    let dir = TestDir::new();
    dir.write("twice.obj", format!("{TETRAHEDRON}{TETRAHEDRON}"));
    let line = |args: &[&str], key: &str| {
        let out = dir.tumble(&[&["info", "twice.obj"], args].concat()).expect_status(0).stdout;
        out.lines().find(|line| line.trim().starts_with(key)).unwrap_or_default().to_owned()
    };
    assert_contains(&line(&[], "particles"), &["8, 4 of them where another one is: weld = true"]);
    assert_contains(&line(&["--weld", "true"], "particles"), &["4 of 8 vertices"]);
    let merged = "4 vertices merged, equal to others";
    assert_contains(&line(&["--weld", "true"], "weld"), &[merged]);
}

#[test]
fn an_open_mesh_is_not_watertight() {
    let dir = TestDir::new();
    dir.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_contains(
        &dir.tumble(&["info", "open.obj"]).expect_status(0).stdout,
        &["watertight", "no: "],
    );
}

#[test]
fn invalid_meshes_are_status_2() {
    let dir = TestDir::new();
    dir.write("t.obj", TETRAHEDRON);
    dir.write("empty.obj", "");
    dir.write("nan.obj", "v 0 0 nan\n");
    dir.write("cat.xyz", "");
    let cases: [(&[&str], &[&str]); 9] = [
        (&["info"], &["MESH"]),
        (&["info", "tt.obj"], &["tt.obj", "did you mean \"t.obj\"?"]),
        (&["info", "empty.obj"], &["empty.obj", "the file is empty"]),
        (&["info", "nan.obj"], &["nan.obj", "nan"]),
        (&["info", "cat.xyz"], &["cat.xyz", ".obj, .stl"]),
        (&["info", "."], &["folder"]),
        (&["info", "t.obj", "--scale", "0"], &["--scale must be above 0"]),
        (&["info", "t.obj", "--scale", "nan"], &["--scale must be above 0"]),
        (&["info", "t.obj", "--scale", "1e300"], &["error: "]),
    ];
    for (args, parts) in cases {
        let outcome = dir.tumble(args).expect_status(2);
        assert_contains(&outcome.stderr, parts);
        assert_eq!(outcome.stdout, "", "{args:?}");
    }
}
