//! `tumble info`: numbers of a mesh that can be checked by hand, and meshes that cannot be read.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Desk, TETRAHEDRON, says};

#[test]
fn a_tetrahedron_by_hand() {
    let desk = Desk::new();
    desk.write("t.obj", TETRAHEDRON);
    let said = desk.tumble(&["info", "t.obj"]).ends_with(0);
    assert_eq!(said.err, "");
    let line = |key: &str| {
        said.out.lines().find(|line| line.trim().starts_with(key)).unwrap_or(key).to_owned()
    };
    says(&line("file"), &["OBJ"]);
    says(&line("particles"), &["4"]);
    says(&line("triangles"), &["4"]);
    says(&line("mass"), &["4 kg"]);
    says(&line("centre"), &["(0.25, 0.25, 0.25)"]);
    says(&line("size"), &["(1, 1, 1)"]);
    says(&line("watertight"), &["yes"]);
    // 1/6 m³, and 3/2 + √3/2 m²
    says(&line("volume"), &["0.16667"]);
    says(&line("surface"), &["2.366"]);

    let said = desk.tumble(&["info", "t.obj", "--scale", "2", "--particle-mass", "0.5"]);
    says(&said.ends_with(0).out, &["mass               2 kg", "1.3333 m³"]);
}

#[test]
fn an_open_mesh_says_so() {
    let desk = Desk::new();
    desk.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    says(&desk.tumble(&["info", "open.obj"]).ends_with(0).out, &["watertight", "no: "]);
}

#[test]
fn what_is_no_mesh_is_status_2() {
    let desk = Desk::new();
    desk.write("t.obj", TETRAHEDRON);
    desk.write("empty.obj", "");
    desk.write("nan.obj", "v 0 0 nan\n");
    desk.write("cat.xyz", "");
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
        let said = desk.tumble(args).ends_with(2);
        says(&said.err, parts);
        assert_eq!(said.out, "", "{args:?}");
    }
}
