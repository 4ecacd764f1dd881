//! `tumble run`: options, files and messages.

#![allow(clippy::unwrap_used)]

mod common;

use common::{BODY, TETRAHEDRON, TestDir, assert_contains, rows, tumble_in};

const SHORT: [&str; 2] = ["--duration", "0.05"];

#[test]
fn the_default_scene_is_task2_and_results_go_to_the_next_free_folder() {
    let dir = TestDir::new();
    let outcome = dir.tumble(&["run", "--duration", "0.05"]).expect_status(0);
    assert_eq!(outcome.stderr, "", "no progress bar in a pipe");
    assert_contains(&outcome.stdout, &["task2", "euler", "out/task2"]);
    assert_eq!(dir.summary("out/task2")["scene"], "task2");
    dir.tumble(&["run", "--duration", "0.05"]).expect_status(0);
    // a file with the name of the folder blocks it too
    dir.write("out/task2-3", "");
    let outcome = dir.tumble(&["run", "task2", "--duration", "0.05"]).expect_status(0);
    assert_contains(&outcome.stdout, &["out/task2-4"]);
    assert_eq!(dir.files("out"), ["task2", "task2-2", "task2-3", "task2-4"]);
}

#[test]
fn the_folder_holds_all_files_and_summary_keys() {
    let dir = TestDir::new();
    let summary = dir.run(&["task2", "--duration", "0.1"], "o");
    assert_eq!(
        dir.files("o"),
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
    assert!(dir.read("o/energy.svg").contains("<svg"));
    assert!(std::fs::read(dir.path("o/motion.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn the_trajectory_has_one_row_per_body_and_frame() {
    let dir = TestDir::new();
    dir.write("two.toml", format!("gravity = [0, 0, 0]\nduration = 0.1\n[output]\ninterval = 0.025\n{BODY}name = \"a\"\ninitial_velocity = [1, 0, 0]\n{BODY}name = \"b\"\nposition = [0, 0.1, 0.3]\n"));
    dir.run(&["two.toml"], "o");
    let rows = rows(&dir.read("o/trajectory.csv"));
    assert_eq!(rows[0].join(","), "time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,lx,ly,lz");
    assert_eq!(rows.len(), 1 + 5 * 2);
    let times: Vec<f64> = rows[1..].iter().map(|row| row[0].parse().unwrap()).collect();
    assert_eq!(times, [0.0, 0.0, 0.025, 0.025, 0.05, 0.05, 0.075, 0.075, 0.1, 0.1]);
    for (row, name) in rows[1..].iter().zip(["a", "b"].iter().cycle()) {
        assert_eq!(row[1], *name);
        assert_eq!(row.len(), 18);
        for text in row.iter().enumerate().filter(|(i, _)| *i != 1).map(|(_, text)| text) {
            let number: f64 = text.parse().unwrap();
            assert_eq!(
                &format!("{number:?}"),
                text,
                "the shortest form that parses to the same number"
            );
        }
    }
    assert_eq!(rows[2][2..5], ["0.0", "0.1", "0.3"]);
    assert!((rows[9][2].parse::<f64>().unwrap() - 0.1).abs() < 1e-12);
}

#[test]
fn the_ledger_adds_up() {
    let dir = TestDir::new();
    let summary = dir.run(&["task2", "--duration", "0.5"], "o");
    let rows = rows(&dir.read("o/energy.csv"));
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
    assert!(numbers.last().unwrap()[4] > 0.0, "drag dissipates energy");
    let of = |key: &str| summary[key].as_f64().unwrap();
    assert_eq!(of("energy_start"), start);
    assert_eq!(of("energy_end"), numbers.last().unwrap()[7]);
}

#[test]
fn set_and_duration_change_a_scene_file() {
    let dir = TestDir::new();
    dir.write("sub/s.toml", format!("duration = 9\n{BODY}{BODY}"));
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
    let summary = dir.run(&args, "o");
    assert_eq!(summary["steps"], 10);
    assert_eq!(summary["bodies"], 2);
    assert_eq!(summary["scene"], "s");
    let scene = dir.read("o/scene.toml");
    assert_contains(
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
fn the_written_scene_reproduces_the_run() {
    let dir = TestDir::new();
    for scene in ["task2", "many", "slope", "coin"] {
        let first = dir.run(&[scene, "--duration", "0.05"], &format!("{scene}-1"));
        let again = format!("{scene}-1/scene.toml");
        let second = dir.run(&[&again], &format!("{scene}-2"));
        assert_eq!(first["state_hash"], second["state_hash"], "{scene}");
        assert_eq!(dir.read(&again), dir.read(&format!("{scene}-2/scene.toml")));
    }
}

#[test]
fn the_written_scene_finds_its_meshes_from_any_folder() {
    let dir = TestDir::new();
    dir.write("in/m.obj", TETRAHEDRON);
    // both bodies share one shape, and both tables need path and hash
    let body = "[[body]]\nmesh = \"m.obj\"\nscale = 0.3\ninitial_angular_velocity = [1, 2, 3]\n";
    dir.write("in/s.toml", format!("{body}name = \"a\"\n{body}name = \"b\"\n"));
    let first = dir.run(&["in/s.toml", "--duration", "0.05"], "o");
    let scene = dir.read("o/scene.toml");
    assert_eq!(scene.matches("mesh_sha256 = \"").count(), 2);
    assert_eq!(scene.matches("mesh_sha256 = \"\"").count(), 0, "{scene}");
    let elsewhere = TestDir::new();
    let again = dir.path("o/scene.toml");
    tumble_in(elsewhere.0.path(), &["run", again.to_str().unwrap(), "--out", "o"]).expect_status(0);
    assert_eq!(first["state_hash"], elsewhere.summary("o")["state_hash"]);

    // the run is not in the folder of its scene, so that it has a copy of the mesh
    dir.write("in/m.obj", TETRAHEDRON.replace("v 1 0 0", "v 2 0 0"));
    let second = dir.run(&["o/scene.toml"], "p");
    assert_eq!(first["state_hash"], second["state_hash"]);
}

#[test]
fn an_output_interval_below_dt_gives_one_frame_per_step() {
    // tiny intervals must not make the run loop over frames
    let dir = TestDir::new();
    for interval in ["1e-12", "1e-320", "0.0004", "0.001"] {
        let out = format!("o{interval}");
        let set = format!("output.interval={interval}");
        dir.run(&["task2", "--duration", "0.01", "--set", &set], &out);
        assert_eq!(rows(&dir.read(&format!("{out}/energy.csv"))).len(), 1 + 11);
    }
    dir.run(&["task2", "--duration", "0.01", "--set", "output.interval=1e308"], "one");
    assert_eq!(rows(&dir.read("one/energy.csv")).len(), 1 + 1);
    dir.run(&["task2", "--duration", "0.01", "--set", "output.interval=0.0025"], "between");
    let times: Vec<_> =
        rows(&dir.read("between/energy.csv")).drain(1..).map(|r| r[0].clone()).collect();
    assert_eq!(times, ["0.0", "0.003", "0.005", "0.008", "0.01"]);
}

#[test]
fn a_run_of_zero_duration_has_one_frame() {
    let dir = TestDir::new();
    let summary = dir.run(&["task2", "--duration", "0"], "o");
    assert_eq!(summary["steps"], 0);
    assert_eq!(summary["interrupted"], false);
    assert_eq!(rows(&dir.read("o/trajectory.csv")).len(), 2);
}

#[test]
fn a_diverging_run_is_status_1_without_a_summary() {
    let dir = TestDir::new();
    let outcome = dir.tumble(&[
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
    let outcome = outcome.expect_status(1);
    assert_contains(&outcome.stderr, &["error: ", "diverged", "t = ", "dt"]);
    assert!(!dir.path("o/summary.json").exists());
    assert!(dir.path("o/trajectory.csv").exists());
}

#[test]
fn invalid_command_lines_are_status_2() {
    let dir = TestDir::new();
    let cases: [(&[&str], &[&str]); 12] = [
        (&["run", "task1", "--set", "dt"], &["--set:1:1", "KEY=VALUE"]),
        (&["run", "task1", "--set", "=1"], &["--set:1:1", "is no key"]),
        (&["run", "task1", "--set", "a..b=1"], &["`a..b` is no key"]),
        (&["run", "task1", "--set", "durration=1"], &["--set:1:1", "`durration`", "`duration`"]),
        (
            &["run", "task1", "--set", "body.7.scale=1"],
            &["--set:1:1", "no number 7", "the array has 1 entry"],
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
        let outcome = dir.tumble(args).expect_status(2);
        assert_contains(&outcome.stderr, parts);
        assert_eq!(outcome.stdout, "");
    }
    // a key with very many parts
    let deep = format!("{}=1", vec!["a"; 50_000].join("."));
    let outcome = dir.tumble(&["run", "task1", "--set", &deep]).expect_status(2);
    assert_contains(&outcome.stderr, &["is no key"]);
    assert!(outcome.stderr.len() < 3000);
    assert!(dir.files("").is_empty());
}

#[test]
fn the_output_path_may_be_nested_and_contain_spaces() {
    let dir = TestDir::new();
    let mut args = vec!["task1"];
    args.extend(SHORT);
    dir.run(&args, "a b/ü/c");
    assert!(dir.path("a b/ü/c/summary.json").exists());
}
