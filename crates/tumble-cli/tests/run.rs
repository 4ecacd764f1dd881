//! `tumble run`: what it takes, what it writes, what it says.

#![allow(clippy::unwrap_used)]

mod common;

use common::{BODY, Desk, TETRAHEDRON, rows, says, tumble_in};

const SHORT: [&str; 2] = ["--duration", "0.05"];

#[test]
fn the_default_scene_is_task2_and_goes_to_the_next_free_folder() {
    let desk = Desk::new();
    let said = desk.tumble(&["run", "--duration", "0.05"]).ends_with(0);
    assert_eq!(said.err, "", "silence in a pipe");
    says(&said.out, &["task2", "euler", "out/task2"]);
    assert_eq!(desk.summary("out/task2")["scene"], "task2");
    desk.tumble(&["run", "--duration", "0.05"]).ends_with(0);
    // a file in the way takes the name as well
    desk.write("out/task2-3", "");
    let said = desk.tumble(&["run", "task2", "--duration", "0.05"]).ends_with(0);
    says(&said.out, &["out/task2-4"]);
    assert_eq!(desk.files("out"), ["task2", "task2-2", "task2-3", "task2-4"]);
}

#[test]
fn the_folder_holds_what_the_contract_says() {
    let desk = Desk::new();
    let summary = desk.run(&["task2", "--duration", "0.1"], "o");
    assert_eq!(
        desk.files("o"),
        [
            "checkpoint.tumble",
            "contacts.csv",
            "energy.csv",
            "energy.svg",
            "motion.html",
            "motion.png",
            "scene.toml",
            "summary.json",
            "trajectory.csv"
        ]
    );
    let keys = [
        "version",
        "scene",
        "integrator",
        "dt",
        "duration",
        "steps",
        "bodies",
        "particles",
        "wall_seconds",
        "steps_per_second",
        "energy_start",
        "energy_end",
        "energy_residual",
        "max_depth",
        "body_depth_end",
        "wall_depth_end",
        "state_hash",
    ];
    for key in keys {
        assert!(!summary[key].is_null(), "{key}");
    }
    assert_eq!(summary["steps"], 100);
    assert_eq!(summary["particles"], 42);
    assert_eq!(summary["interrupted"], false);
    assert!(desk.read("o/energy.svg").contains("<svg"));
    assert!(std::fs::read(desk.path("o/motion.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn the_trajectory_has_one_row_a_body_a_frame() {
    let desk = Desk::new();
    desk.write("two.toml", format!("gravity = [0, 0, 0]\nduration = 0.1\n[output]\ninterval = 0.025\n{BODY}name = \"a\"\ninitial_velocity = [1, 0, 0]\n{BODY}name = \"b\"\nposition = [0, 0.1, 0.3]\n"));
    desk.run(&["two.toml"], "o");
    let rows = rows(&desk.read("o/trajectory.csv"));
    assert_eq!(rows[0].join(","), "time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,lx,ly,lz");
    assert_eq!(rows.len(), 1 + 5 * 2);
    let times: Vec<f64> = rows[1..].iter().map(|row| row[0].parse().unwrap()).collect();
    assert_eq!(times, [0.0, 0.0, 0.025, 0.025, 0.05, 0.05, 0.075, 0.075, 0.1, 0.1]);
    for (row, name) in rows[1..].iter().zip(["a", "b"].iter().cycle()) {
        assert_eq!(row[1], *name);
        assert_eq!(row.len(), 18);
        for text in row.iter().enumerate().filter(|(i, _)| *i != 1).map(|(_, text)| text) {
            let number: f64 = text.parse().unwrap();
            assert_eq!(&format!("{number:?}"), text, "the shortest form that reads back");
        }
    }
    assert_eq!(rows[2][2..5], ["0.0", "0.1", "0.3"]);
    assert!((rows[9][2].parse::<f64>().unwrap() - 0.1).abs() < 1e-12);
}

#[test]
fn the_ledger_adds_up() {
    let desk = Desk::new();
    let summary = desk.run(&["task2", "--duration", "0.5"], "o");
    let rows = rows(&desk.read("o/energy.csv"));
    assert_eq!(
        rows[0].join(","),
        "time,kinetic,gravitational,elastic,drag,dashpot,slip,total,residual"
    );
    let numbers: Vec<Vec<f64>> =
        rows[1..].iter().map(|row| row.iter().map(|x| x.parse().unwrap()).collect()).collect();
    let start = numbers[0][7];
    assert_eq!(numbers[0][0], 0.0);
    for row in &numbers {
        let sum: f64 = row[1..7].iter().sum();
        assert!((row[7] - sum).abs() <= 1e-12 * sum.abs());
        assert_eq!(row[8], row[7] - start);
    }
    assert!(numbers.last().unwrap()[4] > 0.0, "drag takes energy");
    let of = |key: &str| summary[key].as_f64().unwrap();
    assert_eq!(of("energy_start"), start);
    assert_eq!(of("energy_end"), numbers.last().unwrap()[7]);
}

#[test]
fn a_scene_file_and_set_and_duration() {
    let desk = Desk::new();
    desk.write("sub/s.toml", format!("duration = 9\n{BODY}{BODY}"));
    let sets = [
        "--set",
        "dt=1e-2",
        "--set",
        "integrator=euler",
        "--set",
        "collision.collision_stiffness=5",
        "--set",
        "body.scale=2",
        "--set",
        "body.1.scale=0.5",
        "--set",
        "output.interval=0.05",
        "--set",
        "gravity=[0, 0, 1]",
        "--set",
        "body.0.name=with spaces",
        "--duration",
        "0.1",
    ];
    let mut args = vec!["sub/s.toml"];
    args.extend(sets);
    let summary = desk.run(&args, "o");
    assert_eq!(summary["steps"], 10);
    assert_eq!(summary["bodies"], 2);
    assert_eq!(summary["scene"], "s");
    let scene = desk.read("o/scene.toml");
    says(
        &scene,
        &[
            "dt = 0.01",
            "duration = 0.1",
            "integrator = \"euler\"",
            "collision_stiffness = 5.0",
            "scale = 2.0",
            "scale = 0.5",
            "interval = 0.05",
            "gravity = [0.0, 0.0, 1.0]",
            "name = \"with spaces\"",
        ],
    );
}

#[test]
fn the_written_scene_runs_again_to_the_same_bits() {
    let desk = Desk::new();
    for scene in ["task2", "many", "slope", "coin"] {
        let first = desk.run(&[scene, "--duration", "0.05"], &format!("{scene}-1"));
        let again = format!("{scene}-1/scene.toml");
        let second = desk.run(&[&again], &format!("{scene}-2"));
        assert_eq!(first["state_hash"], second["state_hash"], "{scene}");
        assert_eq!(desk.read(&again), desk.read(&format!("{scene}-2/scene.toml")));
    }
}

#[test]
fn the_written_scene_finds_its_meshes_from_anywhere() {
    let desk = Desk::new();
    desk.write("in/m.obj", TETRAHEDRON);
    // the second body shares the shape of the first, and needs path and hash all the same
    let body = "[[body]]\nmesh = \"m.obj\"\nscale = 0.3\ninitial_angular_velocity = [1, 2, 3]\n";
    desk.write("in/s.toml", format!("{body}name = \"a\"\n{body}name = \"b\"\n"));
    let first = desk.run(&["in/s.toml", "--duration", "0.05"], "o");
    let scene = desk.read("o/scene.toml");
    assert_eq!(scene.matches("mesh_sha256 = \"").count(), 2);
    assert_eq!(scene.matches("mesh_sha256 = \"\"").count(), 0, "{scene}");
    let elsewhere = Desk::new();
    let again = desk.path("o/scene.toml");
    tumble_in(elsewhere.0.path(), &["run", again.to_str().unwrap(), "--out", "o"]).ends_with(0);
    assert_eq!(first["state_hash"], elsewhere.summary("o")["state_hash"]);

    // and notices when they are others now
    desk.write("in/m.obj", TETRAHEDRON.replace("v 1 0 0", "v 2 0 0"));
    let said = desk.tumble(&["run", "o/scene.toml", "--out", "p"]).ends_with(2);
    says(&said.err, &["o/scene.toml:", "mesh_sha256", "does not match"]);
}

#[test]
fn frames_closer_than_steps_are_one_on_each_step() {
    // an interval far below dt once made the run count frames for ever
    let desk = Desk::new();
    for interval in ["1e-12", "1e-320", "0.0004", "0.001"] {
        let out = format!("o{interval}");
        let set = format!("output.interval={interval}");
        desk.run(&["task2", "--duration", "0.01", "--set", &set], &out);
        assert_eq!(rows(&desk.read(&format!("{out}/energy.csv"))).len(), 1 + 11);
    }
    desk.run(&["task2", "--duration", "0.01", "--set", "output.interval=1e308"], "one");
    assert_eq!(rows(&desk.read("one/energy.csv")).len(), 1 + 1);
    desk.run(&["task2", "--duration", "0.01", "--set", "output.interval=0.0025"], "between");
    let times: Vec<_> =
        rows(&desk.read("between/energy.csv")).drain(1..).map(|r| r[0].clone()).collect();
    assert_eq!(times, ["0.0", "0.003", "0.005", "0.008", "0.01"]);
}

#[test]
fn a_run_of_no_time_has_its_first_frame() {
    let desk = Desk::new();
    let summary = desk.run(&["task2", "--duration", "0"], "o");
    assert_eq!(summary["steps"], 0);
    assert_eq!(summary["interrupted"], false);
    assert_eq!(rows(&desk.read("o/trajectory.csv")).len(), 2);
}

#[test]
fn a_motion_that_diverges_is_status_1_without_a_summary() {
    let desk = Desk::new();
    let said = desk.tumble(&[
        "run",
        "task1",
        "--set",
        "dt=0.5",
        "--set",
        "duration=100",
        "--force",
        "--out",
        "o",
    ]);
    let said = said.ends_with(1);
    says(&said.err, &["error: ", "diverged", "t = ", "dt"]);
    assert!(!desk.path("o/summary.json").exists());
    assert!(desk.path("o/trajectory.csv").exists());
}

#[test]
fn wrong_calls() {
    let desk = Desk::new();
    let cases: [(&[&str], &[&str]); 12] = [
        (&["run", "task1", "--set", "dt"], &["--set:1:1", "KEY=VALUE"]),
        (&["run", "task1", "--set", "=1"], &["--set:1:1", "is no key"]),
        (&["run", "task1", "--set", "a..b=1"], &["`a..b` is no key"]),
        (&["run", "task1", "--set", "durration=1"], &["--set:1:1", "`durration`", "`duration`"]),
        (
            &["run", "task1", "--set", "body.7.scale=1"],
            &["--set:1:1", "no number 7", "there are 1"],
        ),
        (&["run", "task1", "--set", "dt.x=1"], &["--set:1:1", "`x` cannot be set inside a number"]),
        (
            &["run", "task1", "--set", "dt=fast"],
            &["--set:1:4", "`dt` must be a number", "a string"],
        ),
        (&["run", "task1", "--duration", "-1"], &["`duration` must be 0 or more, but is -1"]),
        (&["run", "task1", "--duration", "nan"], &["`duration` must be 0 or more, but is NaN"]),
        (&["run", "task1", "--out", ""], &["--out <DIR>"]),
        (&["run", "tsk1"], &["no file and no built-in scene `tsk1`", "did you mean `task1`?"]),
        (&["run", ""], &["no built-in scene ``", "task1, task2"]),
    ];
    for (args, parts) in cases {
        let said = desk.tumble(args).ends_with(2);
        says(&said.err, parts);
        assert_eq!(said.out, "");
    }
    // a key of very many parts
    let deep = format!("{}=1", vec!["a"; 50_000].join("."));
    let said = desk.tumble(&["run", "task1", "--set", &deep]).ends_with(2);
    says(&said.err, &["is no key"]);
    assert!(said.err.len() < 3000);
    assert!(desk.files("").is_empty());
}

#[test]
fn out_may_have_spaces_and_be_deep() {
    let desk = Desk::new();
    let mut args = vec!["task1"];
    args.extend(SHORT);
    desk.run(&args, "a b/ü/c");
    assert!(desk.path("a b/ü/c/summary.json").exists());
}
