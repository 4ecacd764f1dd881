//! `tumble info` of a scene: its critical step, and a step for each integrator that works; and what is neither a scene nor a mesh.

#![allow(clippy::unwrap_used)]

mod common;

use common::{TETRAHEDRON, TestDir, assert_contains};

/// Two balls that fall on a floor.
const SCENE: &str = r#"
duration = 0.5
dt = 0.01
[collision]
collision_stiffness = 2e4
restitution = 0.5
[[wall]]
normal = [0, 1, 0]
[[body]]
name = "ball"
particles = [[0, 0, 0]]
particle_radius = 0.1
mass_model = "solid"
mass = 1
position = [0, 0.12, 0]
copies = { count = [2, 1, 1], spacing = [0.3, 0.3, 0.3] }
"#;

/// The value of a row.
fn row<'a>(text: &'a str, key: &str) -> &'a str {
    let rows = text.lines().filter_map(|line| line.trim().split_once("  "));
    rows.into_iter().find(|(name, _)| *name == key).map_or("", |(_, value)| value.trim())
}

/// The step in a row such as `dt = 2e-4 s: …`.
fn dt(row: &str) -> f64 {
    let text = row.strip_prefix("dt = ").and_then(|rest| rest.split_once(" s")).unwrap().0;
    text.parse().unwrap()
}

#[test]
fn the_steps_that_are_suggested_for_a_scene_work() {
    let dir = TestDir::new();
    dir.write("s.toml", SCENE);
    let out = dir.tumble(&["info", "s.toml"]).expect_status(0).stdout;
    assert_eq!((row(&out, "bodies"), row(&out, "walls")), ("2", "1"));
    // 2/√(8 k/m) in a close packing, less for the dashpot
    let critical: f64 = row(&out, "critical dt").split(' ').next().unwrap().parse().unwrap();
    assert!(critical < 5e-3 && critical > 2e-3, "{out}");
    assert_contains(row(&out, "critical dt"), &["\"ball 0\"", "so that tumble run refuses"]);
    let [splitting, implicit, euler] = ["splitting", "implicit", "euler"].map(|name| {
        assert_contains(row(&out, name), &["s for each simulated second"]);
        let step = dt(row(&out, name));
        let sets = [format!("integrator={name}"), format!("dt={step}")];
        let summary = dir.run(&["s.toml", "--set", &sets[0], "--set", &sets[1]], name);
        assert_eq!(summary["integrator"], name);
        step
    });
    assert!(splitting < critical && euler < critical && implicit > critical, "{out}");
    assert_contains(&out, &["implicit for heaps", "before bodies meet"]);
    assert_eq!(dir.tumble(&["info", "s.toml", "--set", "dt=1e-3"]).expect_status(0).stderr, "");
}

#[test]
fn a_scene_without_contact_has_no_critical_step() {
    let dir = TestDir::new();
    let out = dir.tumble(&["info", "racket", "--set", "duration=0.1"]).expect_status(0).stdout;
    assert_contains(&out, &["nothing can touch anything", "as it is     dt = 1e-4 s: "]);
    assert!(!out.contains("heaps"), "{out}");
}

#[test]
fn given_mass_properties_are_named() {
    let dir = TestDir::new();
    let keys = "center_of_mass = [0.01, 0, 0]\ninertia = [[1, 0, 0], [0, 1, 0], [0, 0, 2]]\n";
    dir.write("s.toml", format!("{SCENE}{keys}"));
    let out = dir.tumble(&["info", "s.toml"]).expect_status(0).stdout;
    let given = "\"ball\": centre of mass (0.01, 0, 0) m, principal moments (1, 1, 2) kg·m²";
    assert_contains(row(&out, "given mass"), &[given]);
    dir.write("s.toml", SCENE);
    assert!(!dir.tumble(&["info", "s.toml"]).expect_status(0).stdout.contains("given mass"));
}

#[test]
fn what_is_neither_a_mesh_nor_a_scene_is_status_2_and_names_both_forms() {
    let dir = TestDir::new();
    dir.write("t.obj", TETRAHEDRON);
    dir.write("run/scene.toml", SCENE);
    dir.write("bad.toml", "gravty = 1\n");
    let forms = ["a mesh file (.obj, .stl, .ply, .gltf, .glb)", "a scene file (.toml)"];
    let cases: [(&[&str], &[&str]); 7] = [
        (&["hoper"], &["`hoper` is neither", "did you mean `hopper`?"]),
        (&["notes.txt"], &["`notes.txt` is neither"]),
        (&["run"], &["the scene of this run is run/scene.toml"]),
        (&["none.toml"], &["no file and no built-in scene `none.toml`"]),
        (&["bad.toml"], &["`gravty` is not a known key", "bad.toml:1:1"]),
        (&["hopper", "--scale", "2"], &["--scale is for meshes, but hopper is a scene"]),
        (&["t.obj", "--set", "dt=1"], &["--set is for scenes, but t.obj is a mesh"]),
    ];
    for (args, parts) in cases {
        let outcome = dir.tumble(&[&["info"], args].concat()).expect_status(2);
        assert_contains(&outcome.stderr, parts);
        if parts[0].ends_with("neither") {
            assert_contains(&outcome.stderr, &forms);
        }
        assert_eq!(outcome.stdout, "", "{args:?}");
    }
}
