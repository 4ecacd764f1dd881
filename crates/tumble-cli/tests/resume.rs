//! `tumble resume`: the results are bitwise those of an uninterrupted run.

#![allow(clippy::unwrap_used)]

mod common;

use std::fs;

use tumble_io::checkpoint::read_checkpoint;

use common::{TETRAHEDRON, TestDir, assert_contains, rows};

/// A box that bounces down a rough slope: dashpots, friction, drag.
const SLOPE: &str = "duration = 0.6\n\
    dt = 1e-4\n\
    velocity_damping_stiffness = 0.02\n\
    [collision]\nrestitution = 0.6\nfriction_stiffness = 0.3\n\
    [[wall]]\nnormal = [0.4, 1.0, 0.0]\n\
    [[body]]\nname = \"box\"\nshape = \"box\"\nsize = [0.3, 0.2, 0.2]\ndivisions = 2\nmass = 2\n\
    position = [0, 0.25, 0]\ninitial_velocity = [1, -1, 0.3]\n\
    initial_angular_velocity = [1, 2, 3]\n\
    [[body]]\nname = \"other box\"\nshape = \"box\"\nsize = [0.2, 0.2, 0.2]\ndivisions = 2\n\
    position = [0, 0.5, 0]\n\
    [output]\ninterval = 0.01\n";

fn slope() -> TestDir {
    let dir = TestDir::new();
    dir.write("slope.toml", SLOPE);
    dir
}

/// Asserts that two folders hold the same bytes, except for the wall-clock times in `summary.json`.
#[track_caller]
fn assert_same_files(dir: &TestDir, a: &str, b: &str) {
    assert_eq!(dir.files(a), dir.files(b));
    for name in dir.files(a) {
        let read = |folder: &str| fs::read(dir.path(folder).join(&name)).unwrap();
        if name == "summary.json" {
            let without_times = |folder: &str| {
                let mut summary = dir.summary(folder);
                let summary = summary.as_object_mut().unwrap();
                assert!(summary.remove("wall_seconds").is_some());
                assert!(summary.remove("steps_per_second").is_some());
                summary.clone()
            };
            assert_eq!(without_times(a), without_times(b));
        } else {
            assert!(read(a) == read(b), "{a}/{name} and {b}/{name} differ");
        }
    }
}

/// The state in a run's checkpoint.
fn state(dir: &TestDir, folder: &str) -> tumble::State {
    read_checkpoint(&dir.path(folder).join("checkpoint.tumble")).unwrap().state
}

#[test]
fn every_integrator_resumes_to_the_same_files() {
    let dir = slope();
    let variants: [&[&str]; 3] = [
        &["--set", "integrator=euler", "--set", "output.contact_points=true"],
        &["--set", "integrator=splitting", "--set", "output.contact_points=true"],
        &["--set", "energy_tolerance=1e-6", "--set", "dt=1e-3"],
    ];
    for (index, variant) in variants.iter().enumerate() {
        let (whole, parts) = (format!("whole{index}"), format!("parts{index}"));
        let with = |more: &[&'static str]| [&["slope.toml"], *variant, more].concat();
        dir.run(&with(&[]), &whole);
        let checkpoint = format!("{parts}/checkpoint.tumble");
        // during a contact and between two frames
        dir.run(&with(&["--duration", "0.303"]), &parts);
        let springs = state(&dir, &parts).springs;
        assert!(springs.iter().any(|s| !s.is_empty()), "there is no friction spring");
        if index == 0 {
            dir.tumble(&["resume", &checkpoint, "--duration", "0.481"]).expect_status(0);
            assert_eq!(dir.summary(&parts)["interrupted"], false);
        }
        let outcome = dir.tumble(&["resume", &parts, "--duration", "0.6"]).expect_status(0);
        assert_contains(&outcome.stdout, &["slope", "steps", ", the last ", "residual", &parts]);
        assert_eq!(outcome.stderr, "");
        assert_same_files(&dir, &whole, &parts);
    }
}

#[test]
fn contact_points_of_big_steps_are_resumed_to_the_same_bytes() {
    let dir = slope();
    let sets = ["--set", "integrator=implicit", "--set", "dt=2e-3"];
    let with = [&["slope.toml", "--set", "output.contact_points=true"], &sets[..]].concat();
    dir.run(&with, "whole");
    dir.run(&[&with[..], &["--duration", "0.304"]].concat(), "parts");
    // damaged after the checkpoint
    let rows = dir.read("parts/contact_points.csv");
    assert!(rows.lines().count() > 10, "{rows}");
    dir.write("parts/contact_points.csv", format!("{rows}0.31,box,wall 0,\n0.3"));
    dir.tumble(&["resume", "parts", "--duration", "0.6", "--out", "next"]).expect_status(0);
    dir.tumble(&["resume", "parts", "--duration", "0.6"]).expect_status(0);
    assert_same_files(&dir, "whole", "parts");
    assert_same_files(&dir, "whole", "next");
}

#[test]
fn a_new_folder_gets_all_rows_and_the_old_one_is_unchanged() {
    let dir = slope();
    dir.run(&["slope.toml"], "whole");
    dir.run(&["slope.toml", "--duration", "0.25"], "first");
    let before = dir.read("first/trajectory.csv");
    let call = ["resume", "first/checkpoint.tumble", "--duration", "0.6", "--out", "next"];
    dir.tumble(&call).expect_status(0);
    assert_same_files(&dir, "whole", "next");
    assert_eq!(dir.read("first/trajectory.csv"), before);
    assert_eq!(dir.summary("first")["duration"], 0.25);
    // another run is not overwritten
    let outcome = dir.tumble(&call).expect_status(2);
    assert_contains(&outcome.stderr, &["next already holds a run", "--force"]);
    dir.tumble(&[&call[..], &["--force"]].concat()).expect_status(0);
    assert_same_files(&dir, "whole", "next");
    // --out may be the checkpoint's own folder, also by another path
    let call = ["resume", "first", "--duration", "0.6", "--out", "next/../first", "--force"];
    dir.tumble(&call).expect_status(0);
    assert_same_files(&dir, "whole", "first");
}

#[test]
fn from_a_checkpoint_alone_the_rows_begin_at_its_time() {
    let dir = slope();
    let whole = dir.run(&["slope.toml"], "whole");
    dir.run(&["slope.toml", "--duration", "0.2537"], "first");
    fs::create_dir(dir.path("alone")).unwrap();
    fs::rename(dir.path("first/checkpoint.tumble"), dir.path("alone/c.tumble")).unwrap();
    let call = ["resume", "alone/c.tumble", "--duration", "0.4", "--out", "next"];
    let outcome = dir.tumble(&call).expect_status(0);
    assert_contains(&outcome.stderr, &["note: ", "begin at t = 0.2537"]);
    // the result can be resumed like any other run
    let outcome = dir.tumble(&["resume", "next", "--duration", "0.6"]).expect_status(0);
    assert_eq!(outcome.stderr, "");
    assert_eq!(dir.summary("next")["state_hash"], whole["state_hash"]);
    assert_eq!(dir.summary("next")["energy_start"], whole["energy_start"]);
    let (all, end) = (dir.read("whole/trajectory.csv"), dir.read("next/trajectory.csv"));
    assert_eq!(rows(&end)[1][0], "0.26");
    assert!(all.ends_with(end.split_once('\n').unwrap().1));
    // without --out the results are written to its folder
    let outcome = dir.tumble(&["resume", "alone/c.tumble", "--duration", "0.6"]).expect_status(0);
    assert_contains(&outcome.stderr, &["note: "]);
    assert_eq!(dir.read("alone/energy.csv"), dir.read("next/energy.csv"));
}

#[test]
fn rows_after_the_checkpoint_and_an_incomplete_row_are_removed() {
    let dir = slope();
    dir.run(&["slope.toml"], "whole");
    dir.run(&["slope.toml", "--duration", "0.25"], "first");
    let checkpoint = fs::read(dir.path("first/checkpoint.tumble")).unwrap();
    dir.tumble(&["resume", "first", "--duration", "0.3"]).expect_status(0);
    dir.write("first/checkpoint.tumble", checkpoint);
    for name in ["first/trajectory.csv", "first/energy.csv"] {
        dir.write(name, dir.read(name) + "0.31,bo");
    }
    dir.tumble(&["resume", "first", "--duration", "0.6"]).expect_status(0);
    assert_same_files(&dir, "whole", "first");
}

#[test]
fn inconsistent_rows_are_rejected() {
    let dir = slope();
    dir.run(&["slope.toml", "--duration", "0.1"], "o");
    let (trajectory, ledger) = (dir.read("o/trajectory.csv"), dir.read("o/energy.csv"));
    let call = ["resume", "o", "--duration", "0.2"];
    let rejected = |parts: &[&str]| {
        let before = dir.read("o/energy.csv");
        let outcome = dir.tumble(&call).expect_status(2);
        assert_contains(&outcome.stderr, parts);
        assert!(dir.path("o/summary.json").exists(), "nothing was changed");
        assert_eq!(dir.read("o/energy.csv"), before);
    };
    let missing = trajectory.lines().take(7).collect::<Vec<_>>().join("\n");
    dir.write("o/trajectory.csv", missing + "\n");
    rejected(&["o/trajectory.csv has no row of \"box\" at t = 0.030000000000000002 s"]);
    dir.write("o/trajectory.csv", trajectory.replace("other box", "another"));
    rejected(&["another row than that of \"other box\" at t = 0 s"]);
    dir.write("o/trajectory.csv", "x".repeat(100_000));
    rejected(&["o/trajectory.csv has a row that is too long"]);
    dir.write("o/trajectory.csv", "");
    rejected(&["does not begin with its header"]);
    fs::remove_file(dir.path("o/trajectory.csv")).unwrap();
    rejected(&["o/trajectory.csv cannot be read"]);
    dir.write("o/trajectory.csv", &trajectory);
    for (from, to) in [("\n0.05,", "\n0.0501,"), ("\n0.0,", "\n1e300,"), ("\n0.02,", "\nnan,")] {
        dir.write("o/energy.csv", ledger.replace(from, to));
        rejected(&["o/energy.csv has "]);
    }
    dir.write("o/energy.csv", &ledger);
    dir.tumble(&call).expect_status(0);
}

#[test]
fn a_folder_of_another_run_is_rejected() {
    let dir = slope();
    dir.run(&["slope.toml", "--duration", "0.1"], "a");
    dir.run(&["slope.toml", "--duration", "0.1", "--set", "dt=2e-4"], "b");
    fs::copy(dir.path("a/checkpoint.tumble"), dir.path("b/a.tumble")).unwrap();
    let outcome = dir.tumble(&["resume", "b/a.tumble", "--duration", "0.2"]).expect_status(2);
    assert_contains(
        &outcome.stderr,
        &["b holds files that are not of the checkpoint's run", "--out"],
    );
    // the rows of the other run are not copied
    let call = ["resume", "b/a.tumble", "--duration", "0.2", "--out", "c"];
    assert_contains(&dir.tumble(&call).expect_status(0).stderr, &["begin at t = 0.1 s"]);
}

#[test]
fn a_duration_that_is_already_reached_is_status_2() {
    let dir = slope();
    dir.run(&["slope.toml", "--duration", "0.1"], "o");
    for more in [&[][..], &["--duration", "0.1"], &["--duration", "0.05"], &["--out", "p"]] {
        let outcome = dir.tumble(&[&["resume", "o"], more].concat()).expect_status(2);
        assert_contains(&outcome.stderr, &["nothing left to do", "at t = 0.1 s", "--duration"]);
        assert!(!dir.path("p").exists());
    }
    for seconds in ["-1", "nan", "soon"] {
        let outcome = dir.tumble(&["resume", "o", "--duration", seconds]).expect_status(2);
        assert_contains(&outcome.stderr, &["--set:1:", "duration"]);
    }
    // missing pictures of a complete run are drawn
    let whole = dir.summary("o");
    for name in ["summary.json", "motion.png", "energy.svg"] {
        fs::remove_file(dir.path("o").join(name)).unwrap();
    }
    dir.tumble(&["resume", "o"]).expect_status(0);
    assert_eq!(dir.summary("o")["state_hash"], whole["state_hash"]);
    assert!(dir.path("o/motion.png").exists());
}

#[test]
fn invalid_checkpoints_are_status_2() {
    let dir = slope();
    dir.run(&["slope.toml", "--duration", "0.01"], "o");
    let good = fs::read(dir.path("o/checkpoint.tumble")).unwrap();
    let mut flipped = good.clone();
    let middle = flipped.len() / 2;
    flipped[middle] ^= 4;
    let cases: [(&[u8], &str); 4] = [
        (b"", "is empty"),
        (SLOPE.as_bytes(), "is no checkpoint: it begins with other bytes"),
        (&good[..good.len() - 1], "is cut short"),
        (&flipped, "is damaged"),
    ];
    for (bytes, part) in cases {
        dir.write("c.tumble", bytes);
        let outcome = dir.tumble(&["resume", "c.tumble", "--out", "p"]).expect_status(2);
        assert_contains(&outcome.stderr, &["error: c.tumble ", part]);
        assert!(!dir.path("p").exists());
    }
    for name in ["nowhere", "/dev/zero", ""] {
        dir.tumble(&["resume", name]).expect_status(2);
    }
    let outcome = dir.tumble(&["resume"]).expect_status(2);
    assert_contains(&outcome.stderr, &["CHECKPOINT"]);
}

#[test]
fn a_missing_or_changed_mesh_is_status_2() {
    let dir = TestDir::new();
    dir.write("m.obj", TETRAHEDRON);
    dir.write("s.toml", "duration = 0.05\n[[body]]\nmesh = \"m.obj\"\nscale = 0.3\n");
    dir.run(&["s.toml"], "o");
    let call = ["resume", "o", "--duration", "0.1"];
    dir.write("m.obj", TETRAHEDRON.replace("v 1 0 0", "v 2 0 0"));
    let outcome = dir.tumble(&call).expect_status(2);
    assert_contains(
        &outcome.stderr,
        &["the scene in o/checkpoint.tumble", "mesh_sha256", "does not match"],
    );
    fs::remove_file(dir.path("m.obj")).unwrap();
    let outcome = dir.tumble(&call).expect_status(2);
    assert_contains(
        &outcome.stderr,
        &["the scene in o/checkpoint.tumble", "m.obj", "no such file"],
    );
    assert!(dir.path("o/summary.json").exists(), "nothing was changed");
    dir.write("m.obj", TETRAHEDRON);
    dir.tumble(&call).expect_status(0);
}

#[test]
fn a_diverged_run_leaves_the_last_good_state() {
    let dir = TestDir::new();
    // the failure is found by the ledger at a frame or, without frames, by a step
    for (out, interval) in [("ledger", "0.5"), ("step", "1e300")] {
        let set = format!("output.interval={interval}");
        let run = ["run", "task1", "--set", "dt=0.5", "--set", &set, "--duration", "1e5"];
        let first = dir.tumble(&[&run[..], &["--force", "--out", out]].concat()).expect_status(1);
        let before = state(&dir, out);
        if out == "step" {
            assert_contains(&first.stderr, &[&format!("at step {} ", before.step + 1)]);
        }
        let again = dir.tumble(&["resume", out]).expect_status(1);
        assert_eq!(first.stderr, again.stderr, "it fails again at the same step");
        assert_eq!(state(&dir, out), before);
        assert!(!dir.path(out).join("summary.json").exists());
    }
}

#[test]
fn intermediate_checkpoints_do_not_change_the_results() {
    let dir = slope();
    let plain = dir.run(&["slope.toml"], "plain");
    let set = ["slope.toml", "--set", "output.checkpoint_interval=0.0137"];
    let often = dir.run(&set, "often");
    assert_eq!(plain["state_hash"], often["state_hash"]);
    assert_eq!(dir.read("plain/trajectory.csv"), dir.read("often/trajectory.csv"));
    assert_contains(&dir.read("often/scene.toml"), &["checkpoint_interval = 0.0137"]);
}

#[cfg(unix)]
mod interrupted {
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    use super::*;

    /// Starts a long run with a checkpoint every 0.1 s of simulated time, and waits for the first checkpoint.
    fn start(dir: &TestDir) -> Child {
        let child = Command::new(env!("CARGO_BIN_EXE_tumble"))
            .current_dir(dir.0.path())
            .args(["run", "slope.toml", "--duration", "1e6", "--out", "o"])
            .args(["--set", "output.checkpoint_interval=0.1", "--set", "dt=1e-5"])
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while !dir.path("o/checkpoint.tumble").exists() {
            assert!(start.elapsed() < Duration::from_secs(30), "no checkpoint was written");
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(150));
        child
    }

    /// Resumes to a little after the time of interruption, and compares with an uninterrupted run.
    fn resume_and_compare(dir: &TestDir) {
        let energy = dir.read("o/energy.csv");
        let whole = &energy[..energy.rfind('\n').unwrap()];
        let last: f64 = rows(whole).last().unwrap()[0].parse().unwrap();
        let until = format!("{}", last + 0.1234);
        dir.tumble(&["resume", "o", "--duration", &until]).expect_status(0);
        let sets = ["--set", "output.checkpoint_interval=0.1", "--set", "dt=1e-5"];
        dir.run(&[&["slope.toml", "--duration", &until], &sets[..]].concat(), "whole");
        assert_same_files(dir, "o", "whole");
    }

    #[test]
    fn by_ctrl_c() {
        let dir = slope();
        let mut child = start(&dir);
        let id = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert_eq!(dir.summary("o")["interrupted"], true);
        resume_and_compare(&dir);
    }

    #[test]
    fn by_kill_9() {
        let dir = slope();
        for round in 0..2u64 {
            let mut child = start(&dir);
            std::thread::sleep(Duration::from_millis(7 * round));
            child.kill().unwrap();
            child.wait().unwrap();
            assert!(!dir.path("o/summary.json").exists());
            // a temporary file may remain
            let _ = fs::remove_file(dir.path("o/.checkpoint.tumble.partial"));
            resume_and_compare(&dir);
            fs::remove_dir_all(dir.path("o")).unwrap();
            fs::remove_dir_all(dir.path("whole")).unwrap();
        }
    }
}
