//! Joints and loads in scenes: what is read, written and refused.

#![allow(clippy::unwrap_used)]

mod common;

use common::{TestDir, assert_contains};

/// Two arms on hinges, the upper one with a motor, and a load.
const SCENE: &str = r#"
duration = 1.0
dt = 1e-3
[[body]]
name = "upper"
shape = "box"
mass_model = "solid"
mass = 1.0
position = [0.5, 0.0, 0.0]
[[body]]
name = "lower, \"b\""
shape = "box"
mass_model = "solid"
mass = 1.0
position = [1.5, 0.0, 0.0]
[[joint]]
name = "shoulder"
kind = "hinge"
between = ["upper", "world"]
at = [0, 0, 0]
axis = [0, 0, 2]
motor = { speed = 20.0, effort = 5.0 }
[[joint]]
name = "elbow, \"e\""
kind = "hinge"
between = ["lower, \"b\"", "upper"]
at = [1, 0, 0]
axis = [0, 0, 1]
limits = [-1.0, inf]
friction = 0.1
[[load]]
body = "upper"
force = [0, 3, 0]
frequency = 1.0
[output]
interval = 0.01
"#;

#[test]
fn joints_csv_has_a_row_for_each_joint_and_frame() {
    let dir = TestDir::new();
    dir.write("s.toml", SCENE);
    dir.run(&["s.toml"], "out");
    let text = dir.read("out/joints.csv");
    assert!(text.starts_with("time,joint,fx,fy,fz,tx,ty,tz,coordinate,rate\n"), "{text}");
    let mut reader = csv::Reader::from_path(dir.path("out/joints.csv")).unwrap();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 2 * 101);
    assert_eq!((&rows[0][1], &rows[1][1]), ("shoulder", "elbow, \"e\""));
    // the motor is at its limit, or the arm turns at 20 rad/s
    let last = &rows[200];
    let [torque, rate] = [7, 9].map(|column| last[column].parse::<f64>().unwrap());
    assert!((torque - 5.0).abs() < 1e-9 || (rate - 20.0).abs() < 0.1, "{torque} {rate}");
    let elbow: Vec<f64> = rows.iter().skip(1).step_by(2).map(|r| r[8].parse().unwrap()).collect();
    assert!(elbow.iter().all(|angle| *angle > -1.0 - 1e-9));
    let energy = dir.read("out/energy.csv");
    assert!(energy.lines().next().unwrap().ends_with(",residual,work,spring,motor,joint_friction"));
    // the scene as run gives the same run
    dir.run(&["out/scene.toml"], "again");
    assert_eq!(dir.read("again/joints.csv"), text);
    assert_eq!(dir.read("again/trajectory.csv"), dir.read("out/trajectory.csv"));
    assert_eq!(dir.read("again/energy.csv"), energy);
}

#[test]
fn a_run_with_joints_resumes_with_the_same_rows() {
    let dir = TestDir::new();
    dir.write("s.toml", SCENE);
    dir.run(&["s.toml"], "whole");
    dir.run(&["s.toml", "--duration", "0.4"], "part");
    let again = ["resume", "part", "--duration", "1.0"];
    dir.tumble(&again).expect_status(0);
    for file in ["joints.csv", "trajectory.csv", "energy.csv"] {
        assert_eq!(dir.read(&format!("part/{file}")), dir.read(&format!("whole/{file}")), "{file}");
    }
    assert_eq!(dir.summary("part")["state_hash"], dir.summary("whole")["state_hash"]);
}

#[test]
fn invalid_joints_and_loads_are_refused_with_their_place() {
    let dir = TestDir::new();
    let body = "[[body]]\nname = \"a\"\nshape = \"box\"\nmass_model = \"solid\"\n";
    let hinge =
        "kind = \"hinge\"\nbetween = [\"a\", \"world\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
    for (lines, parts) in [
        (
            "[[joint]]\nkind = \"hinge\"",
            &["`joint.0.axis` is missing", "`joint.0.at`", "between"][..],
        ),
        (
            "[[joint]]\nkind = \"hinj\"",
            &["`joint.0.kind` must be one of \"ball\"", "mean \"hinge\"?"],
        ),
        (&format!("[[joint]]\n{hinge}motr = 1"), &["`joint.0.motr`", "mean `motor`?", ":10:1"]),
        (&format!("[[joint]]\n{hinge}motor = {{}}"), &["`joint.0.motor` needs `speed`"]),
        (&format!("[[joint]]\n{hinge}limits = [1, 2]"), &["`joint.0.limits`", ":10:10", "with 0"]),
        (
            "[[joint]]\nkind = \"ball\"\nbetween = [\"b\", \"world\"]\nat = [0, 0, 0]",
            &["`joint.0.between`", "\"b\", but must be names of bodies", ":7:11"],
        ),
        (
            "[[joint]]\nkind = \"ball\"\nbetween = [\"a\", \"a\"]\nat = [0, 0, 0]",
            &["`joint.0.between`", "two different bodies"],
        ),
        (
            "[[joint]]\nkind = \"ball\"\nbetween = [\"a\", \"world\"]\nat = [[0, 0, 0], [1, 0, 0]]",
            &["`joint.0.at`", "meet there"],
        ),
        (
            "[[joint]]\nkind = \"rope\"\nbetween = [\"a\", \"world\"]\nat = [0, 0, 0]",
            &["`joint.0.at`", "a point for each body"],
        ),
        ("[[joint]]\nkind = \"distance\"\nchain = \"a\"", &["`joint.0.chain`", "with `copies`"]),
        ("[[load]]\nbody = \"b\"\nforce = [1, 0, 0]", &["`load.0.body`", "the name of a body"]),
        ("[[load]]\nbody = \"a\"", &["`load.0` needs `force"]),
        (
            "[[load]]\nbody = \"a\"\ntable = [[0, 1, 0, 0], [0, 2, 0, 0]]",
            &["`load.0.table`", "whose times rise"],
        ),
        ("[central_gravity]\ngm = 0", &["`central_gravity.gm` must be above 0"]),
        (
            &format!("[[joint]]\n{hinge}[[joint]]\nname = \"joint 0\"\n{hinge}"),
            &["`joint.1.name`", "different from those of other joints"],
        ),
    ] {
        let message = dir.rejected(format!("{body}{lines}\n"), &[]);
        assert_contains(&message, parts);
    }
    let euler = format!("integrator = \"euler\"\n{body}[[joint]]\n{hinge}");
    assert_contains(&dir.rejected(euler, &[]), &["\"splitting\" or \"implicit\""]);
}

#[test]
fn redundant_constraints_are_said() {
    let dir = TestDir::new();
    let outcome = dir.tumble(&["run", "four-bar", "--duration", "0.01", "--out", "o"]);
    assert_contains(&outcome.expect_status(0).stdout, &["3 constraints follow from the others"]);
    let outcome = dir.tumble(&["info", "four-bar"]);
    assert_contains(&outcome.expect_status(0).stdout, &["4 hinge; 3 of their constraints follow"]);
}
