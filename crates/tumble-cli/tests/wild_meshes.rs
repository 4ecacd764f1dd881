//! Meshes as other programs write them: rounding noise, mirrored parts, duplicates, holes, units in headers.

#![allow(clippy::unwrap_used)]

mod common;

use std::fmt::Write;

use common::{TestDir, assert_contains};

type Point = [f64; 3];
type Soup = Vec<[Point; 3]>;

/// The triangles of a cube, wound outwards.
fn cube(centre: Point, size: f64) -> Soup {
    let corner = |i: usize| {
        let bits = [i & 1, i >> 1 & 1, i >> 2];
        std::array::from_fn(|k| centre[k] + size * (bits[k] as f64 - 0.5))
    };
    let faces = [
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
    ];
    faces.map(|face| face.map(corner)).to_vec()
}

fn inside_out(mut soup: Soup) -> Soup {
    soup.iter_mut().for_each(|t| t.swap(1, 2));
    soup
}

/// An OBJ without equal vertices.
fn obj(soup: &Soup) -> String {
    let (mut vertices, mut text): (Vec<Point>, String) = Default::default();
    let mut faces = String::new();
    for triangle in soup {
        faces += "f";
        for corner in triangle {
            let known = vertices.iter().position(|v| v == corner);
            let index = known.unwrap_or_else(|| {
                vertices.push(*corner);
                writeln!(text, "v {} {} {}", corner[0], corner[1], corner[2]).unwrap();
                vertices.len() - 1
            });
            write!(faces, " {}", index + 1).unwrap();
        }
        faces += "\n";
    }
    text + &faces
}

/// A text STL with this first line. Coordinates of each facet are off by up to `noise`.
fn stl(first_line: &str, soup: &Soup, noise: f64) -> String {
    let mut text = format!("{first_line}\n");
    for (i, triangle) in soup.iter().enumerate() {
        text += "facet normal 0 0 0\nouter loop\n";
        let off = noise * ((i * 7 % 5) as f64 / 2.0 - 1.0);
        for p in triangle {
            writeln!(text, "vertex {:e} {:e} {:e}", p[0] + off, p[1], p[2]).unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid\n"
}

const SOLID: &str =
    "duration = 0.01\ngravity = [0, 0, 0]\n[[body]]\nmass_model = \"solid\"\ndensity = 1000\n";

/// Runs a scene with a solid of this mesh, and returns the report. Results are in `out`.
fn run_solid(dir: &TestDir, mesh: &str, keys: &str) -> String {
    dir.write("s.toml", format!("{SOLID}mesh = \"{mesh}\"\n{keys}\n"));
    let args = ["run", "s.toml", "--out", "out", "--force"];
    dir.tumble(&args).expect_status(0).stdout
}

/// Spin of unit angular velocity about each axis: the moments are in the angular momenta of the first frame.
fn first_row(dir: &TestDir, out: &str) -> Vec<f64> {
    let csv = dir.read(&format!("{out}/trajectory.csv"));
    let row = csv.lines().nth(1).unwrap();
    row.split(',').skip(2).map(|field| field.parse().unwrap()).collect()
}

fn close(found: &[f64], expected: &[f64], bound: f64) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= bound, "{found:?} is not {expected:?}");
    }
}

#[test]
fn rounding_noise_between_facets_closes() {
    let dir = TestDir::new();
    for noise in [1.2e-17, 1e-7] {
        dir.write("cube.stl", stl("solid cube", &cube([0.5; 3], 1.0), noise));
        let out = dir.tumble(&["info", "cube.stl"]).expect_status(0).stdout;
        assert_contains(
            &out,
            &[
                "8 of 36 vertices\n",
                " vertices merged: ",
                " equal to others, ",
                "within 1.73",
                "watertight         yes",
            ],
        );
        let report = run_solid(&dir, "cube.stl", "surface = \"mesh\"");
        assert_contains(&report, &["mesh cube.stl: ", "at open edges within 1.73e-6"]);
        let spin = "initial_angular_velocity = [1, 0, 0]\nsurface = \"mesh\"";
        run_solid(&dir, "cube.stl", spin);
        // a cube of 1000 kg has the moments 1000/6
        close(&first_row(&dir, "out")[13..14], &[1000.0 / 6.0], 1e-3);
    }
    // a tolerance is a length in the unit of the file; the scene of the run keeps it
    dir.write("rough.stl", stl("solid cube", &cube([0.5; 3], 1.0), 1e-4));
    let rejected = dir.tumble(&["info", "rough.stl"]).expect_status(0).stdout;
    assert_contains(&rejected, &["as solid           no: it is open at", "set weld = 2e-4"]);
    let out = dir.tumble(&["info", "rough.stl", "--weld", "1e-3"]).expect_status(0).stdout;
    assert_contains(&out, &["within 0.001 of others, at open edges", "as solid           yes"]);
    run_solid(&dir, "rough.stl", "weld = 1e-3\nscale = 0.5");
    assert_contains(&dir.read("out/scene.toml"), &["weld = 0.001"]);
    dir.run(&["out/scene.toml"], "again");
    assert_eq!(dir.read("again/trajectory.csv"), dir.read("out/trajectory.csv"));
}

#[test]
fn each_part_is_turned_outwards_for_mass_and_contact() {
    let dir = TestDir::new();
    let mut parts = cube([0.0; 3], 1.0);
    parts.extend(inside_out(cube([3.0, 0.0, 0.0], 0.9)));
    dir.write("two.obj", obj(&parts));
    let moments = [265.08, 4059.76, 4059.76];
    for surface in ["none", "mesh"] {
        let keys = format!("surface = \"{surface}\"\ninitial_angular_velocity = [0.2, 1.0, 0.1]");
        let report = run_solid(&dir, "two.obj", &keys);
        assert_contains(&report, &["1 closed surface of 2 wound the wrong way: turned"]);
        let row = first_row(&dir, "out");
        close(&row[..3], &[1.264893, 0.0, 0.0], 1e-6);
        close(&row[10..13], &[0.2, 1.0, 0.1], 1e-12);
        close(&row[13..16], &[0.2 * moments[0], moments[1], 0.1 * moments[2]], 0.01);
    }
    let out = dir.tumble(&["info", "two.obj"]).expect_status(0).stdout;
    assert_contains(&out, &["volume             1.729 m³", "wound the wrong way: turned"]);
    // a ball that falls on the second part lies on it
    let scene = "duration = 1.5\n[collision]\ncollision_damping = 3\n[[body]]\nmesh = \"two.obj\"\nsurface = \"mesh\"\nmotion = \"fixed\"\n\
                 [[body]]\nname = \"ball\"\nparticles = [[3, 0.6, 0]]\nparticle_radius = 0.1\nmass = 1\n";
    dir.write("fall.toml", scene);
    dir.run(&["fall.toml"], "fall");
    let csv = dir.read("fall/trajectory.csv");
    let last = csv.lines().rfind(|line| line.contains("ball")).unwrap().to_owned();
    let y: f64 = last.split(',').nth(3).unwrap().parse().unwrap();
    assert!((y - 0.55).abs() < 0.01, "the ball is at {y}");
}

#[test]
fn doubled_triangles_count_once() {
    let dir = TestDir::new();
    let one = cube([0.0; 3], 1.0);
    let twice = [one.clone(), one.clone()].concat();
    dir.write("twice.obj", obj(&twice));
    let out = dir.tumble(&["info", "twice.obj"]).expect_status(0).stdout;
    assert_contains(&out, &["12 triangles left out: copies", "volume             1 m³"]);
    let report = run_solid(&dir, "twice.obj", "initial_angular_velocity = [1, 0, 0]");
    assert_contains(&report, &["mesh twice.obj: 12 triangles left out: copies of others"]);
    close(&first_row(&dir, "out")[13..14], &[1000.0 / 6.0], 1e-9);
    // nothing is said where triangles do not matter
    dir.write("p.toml", "duration = 0.01\n[[body]]\nmesh = \"twice.obj\"\n");
    let args = ["run", "p.toml", "--out", "p"];
    assert!(!dir.tumble(&args).expect_status(0).stdout.contains("twice.obj:"));
    // two cubes at an edge: more than two triangles there
    let edge = [one.clone(), cube([1.0, 1.0, 0.0], 1.0)].concat();
    dir.write("edge.obj", obj(&edge));
    let out = dir.tumble(&["info", "edge.obj"]).expect_status(0).stdout;
    let place = "more than two triangles at 1 edge: at (0.5, 0.5, 0)";
    assert_contains(&out, &[place, "volume             2 m³", "as solid           yes"]);
}

#[test]
fn holes_are_closed_on_request_only() {
    let dir = TestDir::new();
    let open: Soup = cube([0.5; 3], 1.0).into_iter().skip(2).collect();
    dir.write("open.stl", stl("solid open", &open, 0.0));
    let out = dir.tumble(&["info", "open.stl"]).expect_status(0).stdout;
    assert_contains(&out, &["at (0.5, 0.5, 0) m: 4 edges, 4 m around, planar"]);
    assert_contains(
        &out,
        &["as solid           no: it is open at 4 edges", "set mesh_repair = \"close\""],
    );
    let scene = format!("{SOLID}mesh = \"open.stl\"\n");
    let message = dir.rejected(&scene, &[]);
    assert_contains(
        &message,
        &["`body.0.mass_model`", "4 open", "`tumble info ", "which key helps"],
    );
    let scene = "[[body]]\nmesh = \"open.stl\"\nsurface = \"mesh\"\n";
    let message = dir.rejected(scene, &[]);
    assert_contains(
        &message,
        &["`body.0.surface` cannot work", "`tumble info ", "which key helps"],
    );
    let out = dir.tumble(&["info", "open.stl", "--repair", "close"]).expect_status(0).stdout;
    assert_contains(
        &out,
        &["1 hole closed with 2 triangles, at (0.5, 0.5, 0)", "watertight         yes"],
    );
    let report = run_solid(&dir, "open.stl", "mesh_repair = \"close\"");
    assert_contains(&report, &["mesh open.stl: 1 hole closed with 2 triangles"]);
    assert_contains(&dir.read("out/scene.toml"), &["mesh_repair = \"close\""]);
    dir.run(&["out/scene.toml"], "again");
    // two faces at an edge leave a hole whose shape is not known
    let mut corner = cube([0.5; 3], 1.0);
    corner.drain(0..2);
    corner.drain(2..4);
    dir.write("corner.stl", stl("solid", &corner, 0.0));
    let scene = format!("{SOLID}mesh = \"corner.stl\"\nmesh_repair = \"close\"\n");
    assert_contains(
        &dir.rejected(&scene, &[]),
        &[
            "`body.0.mesh_repair` cannot be done",
            "the hole of 6 edges at (0.5, 0.333333, 0.333333)",
            "not planar",
        ],
    );
    let bad = format!("{SOLID}mesh = \"open.stl\"\nmesh_repair = \"closed\"\n");
    assert_contains(&dir.rejected(&bad, &[]), &["`body.0.mesh_repair`", "mean \"close\"?"]);
}

#[test]
fn a_unit_in_the_header_is_named() {
    let dir = TestDir::new();
    let part = cube([5.0; 3], 10.0);
    dir.write("part.stl", stl("solid part UNITS=mm", &part, 0.0));
    let out = dir.tumble(&["info", "part.stl"]).expect_status(0).stdout;
    assert_contains(&out, &["the header names millimetres: set scale = 0.001"]);
    let note = "its header names millimetres, but its numbers are taken as metres";
    assert_contains(&run_solid(&dir, "part.stl", ""), &[note]);
    assert!(!run_solid(&dir, "part.stl", "scale = 0.001").contains("millimetres"));
    let out = dir.tumble(&["info", "part.stl", "--scale", "0.001"]).expect_status(0).stdout;
    assert!(!out.contains("set scale"), "{out}");
}

#[test]
fn wrong_tolerances_are_refused() {
    let dir = TestDir::new();
    dir.write("c.obj", obj(&cube([0.0; 3], 1.0)));
    for weld in ["-1", "nan", "inf", "yes", "1e999"] {
        let message = dir.tumble(&["info", "c.obj", "--weld", weld]).expect_status(2).stderr;
        assert_contains(&message, &["--weld", "true, false, or a length"]);
    }
    for (weld, part) in
        [("-1", "0 or more"), ("\"yes\"", "a string"), ("nan", "must be true, false")]
    {
        let scene = format!("{SOLID}mesh = \"c.obj\"\nweld = {weld}\n");
        assert_contains(&dir.rejected(&scene, &[]), &["`body.0.weld` must be true, false", part]);
    }
    for weld in ["true", "false", "0", "1e-3"] {
        run_solid(&dir, "c.obj", &format!("weld = {weld}"));
    }
}

#[test]
fn surfaces_with_one_side_are_refused_with_the_reason() {
    let dir = TestDir::new();
    // a Möbius strip of six quadrilaterals
    let mut text = String::new();
    for i in 0..6 {
        let angle = f64::from(i) * std::f64::consts::TAU / 6.0;
        let (out, up) = (0.3 * (0.5 * angle).cos(), 0.3 * (0.5 * angle).sin());
        for side in [-1.0, 1.0] {
            let r = 1.0 + side * out;
            writeln!(text, "v {} {} {}", r * angle.cos(), r * angle.sin(), side * up).unwrap();
        }
    }
    for i in 0..6 {
        let (a, b) = (2 * i + 1, 2 * i + 2);
        let (c, d) = if i < 5 { (a + 2, b + 2) } else { (2, 1) };
        writeln!(text, "f {a} {b} {d} {c}").unwrap();
    }
    dir.write("strip.obj", text);
    let out = dir.tumble(&["info", "strip.obj"]).expect_status(0).stdout;
    assert_contains(&out, &["no winding is consistent at 1 edge", "as surface         no: "]);
    assert!(out.lines().all(|line| line.chars().count() <= 100), "{out}");
    assert!(out.lines().count() <= 24, "{out}");
}
