//! `tumble resume`: a run that was stopped goes on to the bits of one that never was.

#![allow(clippy::unwrap_used)]

mod common;

use std::fs;

use tumble_io::checkpoint::read_checkpoint;

use common::{Desk, TETRAHEDRON, rows, says};

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

fn slope() -> Desk {
    let desk = Desk::new();
    desk.write("slope.toml", SLOPE);
    desk
}

/// Both folders hold the same bytes, but for the two numbers that time the stepping.
#[track_caller]
fn same_files(desk: &Desk, a: &str, b: &str) {
    assert_eq!(desk.files(a), desk.files(b));
    for name in desk.files(a) {
        let read = |folder: &str| fs::read(desk.path(folder).join(&name)).unwrap();
        if name == "summary.json" {
            let timeless = |folder: &str| {
                let mut summary = desk.summary(folder);
                let summary = summary.as_object_mut().unwrap();
                assert!(summary.remove("wall_seconds").is_some());
                assert!(summary.remove("steps_per_second").is_some());
                summary.clone()
            };
            assert_eq!(timeless(a), timeless(b));
        } else {
            assert!(read(a) == read(b), "{a}/{name} and {b}/{name} differ");
        }
    }
}

/// The state in a run's checkpoint.
fn state(desk: &Desk, folder: &str) -> tumble::State {
    read_checkpoint(&desk.path(folder).join("checkpoint.tumble")).unwrap().state
}

#[test]
fn every_integrator_goes_on_to_the_same_bits_and_files() {
    let desk = slope();
    let ways: [&[&str]; 3] = [
        &["--set", "integrator=euler"],
        &["--set", "integrator=splitting"],
        &["--set", "energy_tolerance=1e-6", "--set", "dt=1e-3"],
    ];
    for (index, way) in ways.iter().enumerate() {
        let (whole, parts) = (format!("whole{index}"), format!("parts{index}"));
        let with = |more: &[&'static str]| [&["slope.toml"], *way, more].concat();
        desk.run(&with(&[]), &whole);
        let checkpoint = format!("{parts}/checkpoint.tumble");
        // in the middle of hard contact, not at the time of a frame
        desk.run(&with(&["--duration", "0.303"]), &parts);
        let springs = state(&desk, &parts).springs;
        assert!(springs.iter().any(|s| !s.is_empty()), "no friction spring is there");
        if index == 0 {
            desk.tumble(&["resume", &checkpoint, "--duration", "0.481"]).ends_with(0);
            assert_eq!(desk.summary(&parts)["interrupted"], false);
        }
        let said = desk.tumble(&["resume", &parts, "--duration", "0.6"]).ends_with(0);
        says(&said.out, &["slope", "steps", ", the last ", "residual", &parts]);
        assert_eq!(said.err, "");
        same_files(&desk, &whole, &parts);
    }
}

#[test]
fn a_new_folder_gets_all_rows_and_the_old_one_stays() {
    let desk = slope();
    desk.run(&["slope.toml"], "whole");
    desk.run(&["slope.toml", "--duration", "0.25"], "first");
    let before = desk.read("first/trajectory.csv");
    let call = ["resume", "first/checkpoint.tumble", "--duration", "0.6", "--out", "next"];
    desk.tumble(&call).ends_with(0);
    same_files(&desk, "whole", "next");
    assert_eq!(desk.read("first/trajectory.csv"), before);
    assert_eq!(desk.summary("first")["duration"], 0.25);
    // never over another run
    let said = desk.tumble(&call).ends_with(2);
    says(&said.err, &["next already holds a run", "--force"]);
    desk.tumble(&[&call[..], &["--force"]].concat()).ends_with(0);
    same_files(&desk, "whole", "next");
    // --out that names the checkpoint's own folder is no other folder, whatever its spelling
    let call = ["resume", "first", "--duration", "0.6", "--out", "next/../first", "--force"];
    desk.tumble(&call).ends_with(0);
    same_files(&desk, "whole", "first");
}

#[test]
fn a_checkpoint_alone_begins_its_rows_where_it_stands() {
    let desk = slope();
    let whole = desk.run(&["slope.toml"], "whole");
    desk.run(&["slope.toml", "--duration", "0.2537"], "first");
    fs::create_dir(desk.path("alone")).unwrap();
    fs::rename(desk.path("first/checkpoint.tumble"), desk.path("alone/c.tumble")).unwrap();
    let call = ["resume", "alone/c.tumble", "--duration", "0.4", "--out", "next"];
    let said = desk.tumble(&call).ends_with(0);
    says(&said.err, &["note: ", "begin at t = 0.2537"]);
    // and goes on from there as any other run
    let said = desk.tumble(&["resume", "next", "--duration", "0.6"]).ends_with(0);
    assert_eq!(said.err, "");
    assert_eq!(desk.summary("next")["state_hash"], whole["state_hash"]);
    assert_eq!(desk.summary("next")["energy_start"], whole["energy_start"]);
    let (all, end) = (desk.read("whole/trajectory.csv"), desk.read("next/trajectory.csv"));
    assert_eq!(rows(&end)[1][0], "0.26");
    assert!(all.ends_with(end.split_once('\n').unwrap().1));
    // without --out, its folder becomes the run's
    let said = desk.tumble(&["resume", "alone/c.tumble", "--duration", "0.6"]).ends_with(0);
    says(&said.err, &["note: "]);
    assert_eq!(desk.read("alone/energy.csv"), desk.read("next/energy.csv"));
}

#[test]
fn rows_after_the_checkpoint_and_a_torn_one_are_cut_off() {
    let desk = slope();
    desk.run(&["slope.toml"], "whole");
    desk.run(&["slope.toml", "--duration", "0.25"], "first");
    let checkpoint = fs::read(desk.path("first/checkpoint.tumble")).unwrap();
    desk.tumble(&["resume", "first", "--duration", "0.3"]).ends_with(0);
    desk.write("first/checkpoint.tumble", checkpoint);
    for name in ["first/trajectory.csv", "first/energy.csv"] {
        desk.write(name, desk.read(name) + "0.31,bo");
    }
    desk.tumble(&["resume", "first", "--duration", "0.6"]).ends_with(0);
    same_files(&desk, "whole", "first");
}

#[test]
fn rows_that_the_run_did_not_write_are_not_gone_on_with() {
    let desk = slope();
    desk.run(&["slope.toml", "--duration", "0.1"], "o");
    let (trajectory, ledger) = (desk.read("o/trajectory.csv"), desk.read("o/energy.csv"));
    let call = ["resume", "o", "--duration", "0.2"];
    let refused = |parts: &[&str]| {
        let before = desk.read("o/energy.csv");
        let said = desk.tumble(&call).ends_with(2);
        says(&said.err, parts);
        assert!(desk.path("o/summary.json").exists(), "nothing was touched");
        assert_eq!(desk.read("o/energy.csv"), before);
    };
    let missing = trajectory.lines().take(7).collect::<Vec<_>>().join("\n");
    desk.write("o/trajectory.csv", missing + "\n");
    refused(&["o/trajectory.csv has no row of \"box\" at t = 0.030000000000000002 s"]);
    desk.write("o/trajectory.csv", trajectory.replace("other box", "another"));
    refused(&["another row than that of \"other box\" at t = 0 s"]);
    desk.write("o/trajectory.csv", "x".repeat(100_000));
    refused(&["o/trajectory.csv has a row without an end"]);
    desk.write("o/trajectory.csv", "");
    refused(&["does not begin with its header"]);
    fs::remove_file(desk.path("o/trajectory.csv")).unwrap();
    refused(&["o/trajectory.csv cannot be read"]);
    desk.write("o/trajectory.csv", &trajectory);
    for (from, to) in [("\n0.05,", "\n0.0501,"), ("\n0.0,", "\n1e300,"), ("\n0.02,", "\nnan,")] {
        desk.write("o/energy.csv", ledger.replace(from, to));
        refused(&["o/energy.csv has "]);
    }
    desk.write("o/energy.csv", &ledger);
    desk.tumble(&call).ends_with(0);
}

#[test]
fn a_folder_of_something_else_is_left_alone() {
    let desk = slope();
    desk.run(&["slope.toml", "--duration", "0.1"], "a");
    desk.run(&["slope.toml", "--duration", "0.1", "--set", "dt=2e-4"], "b");
    fs::copy(desk.path("a/checkpoint.tumble"), desk.path("b/a.tumble")).unwrap();
    let said = desk.tumble(&["resume", "b/a.tumble", "--duration", "0.2"]).ends_with(2);
    says(&said.err, &["b holds files that are not of the checkpoint's run", "--out"]);
    // its rows are not mistaken for the run's, either
    let call = ["resume", "b/a.tumble", "--duration", "0.2", "--out", "c"];
    says(&desk.tumble(&call).ends_with(0).err, &["begin at t = 0.1 s"]);
}

#[test]
fn a_time_that_was_passed_is_status_2() {
    let desk = slope();
    desk.run(&["slope.toml", "--duration", "0.1"], "o");
    for more in [&[][..], &["--duration", "0.1"], &["--duration", "0.05"], &["--out", "p"]] {
        let said = desk.tumble(&[&["resume", "o"], more].concat()).ends_with(2);
        says(&said.err, &["nothing left to do", "at t = 0.1 s", "--duration"]);
        assert!(!desk.path("p").exists());
    }
    for seconds in ["-1", "nan", "soon"] {
        let said = desk.tumble(&["resume", "o", "--duration", seconds]).ends_with(2);
        says(&said.err, &["--set:1:", "duration"]);
    }
    // a run that stopped before its pictures gets them
    let whole = desk.summary("o");
    for name in ["summary.json", "motion.png", "energy.svg"] {
        fs::remove_file(desk.path("o").join(name)).unwrap();
    }
    desk.tumble(&["resume", "o"]).ends_with(0);
    assert_eq!(desk.summary("o")["state_hash"], whole["state_hash"]);
    assert!(desk.path("o/motion.png").exists());
}

#[test]
fn files_that_are_no_checkpoint_are_status_2() {
    let desk = slope();
    desk.run(&["slope.toml", "--duration", "0.01"], "o");
    let good = fs::read(desk.path("o/checkpoint.tumble")).unwrap();
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
        desk.write("c.tumble", bytes);
        let said = desk.tumble(&["resume", "c.tumble", "--out", "p"]).ends_with(2);
        says(&said.err, &["error: c.tumble ", part]);
        assert!(!desk.path("p").exists());
    }
    for name in ["nowhere", "/dev/zero", ""] {
        desk.tumble(&["resume", name]).ends_with(2);
    }
    let said = desk.tumble(&["resume"]).ends_with(2);
    says(&said.err, &["CHECKPOINT"]);
}

#[test]
fn a_mesh_that_is_gone_or_changed_is_status_2() {
    let desk = Desk::new();
    desk.write("m.obj", TETRAHEDRON);
    desk.write("s.toml", "duration = 0.05\n[[body]]\nmesh = \"m.obj\"\nscale = 0.3\n");
    desk.run(&["s.toml"], "o");
    let call = ["resume", "o", "--duration", "0.1"];
    desk.write("m.obj", TETRAHEDRON.replace("v 1 0 0", "v 2 0 0"));
    let said = desk.tumble(&call).ends_with(2);
    says(&said.err, &["the scene in o/checkpoint.tumble", "mesh_sha256", "does not match"]);
    fs::remove_file(desk.path("m.obj")).unwrap();
    let said = desk.tumble(&call).ends_with(2);
    says(&said.err, &["the scene in o/checkpoint.tumble", "m.obj", "no such file"]);
    assert!(desk.path("o/summary.json").exists(), "nothing was touched");
    desk.write("m.obj", TETRAHEDRON);
    desk.tumble(&call).ends_with(0);
}

#[test]
fn a_run_that_diverged_leaves_the_state_before_the_failure() {
    let desk = Desk::new();
    // the ledger fails at a frame, or, without frames, a step
    for (out, interval) in [("ledger", "0.5"), ("step", "1e300")] {
        let set = format!("output.interval={interval}");
        let run = ["run", "task1", "--set", "dt=0.5", "--set", &set, "--duration", "1e5"];
        let first = desk.tumble(&[&run[..], &["--force", "--out", out]].concat()).ends_with(1);
        let before = state(&desk, out);
        if out == "step" {
            says(&first.err, &[&format!("at step {} ", before.step + 1)]);
        }
        let again = desk.tumble(&["resume", out]).ends_with(1);
        assert_eq!(first.err, again.err, "it fails again, at the same step");
        assert_eq!(state(&desk, out), before);
        assert!(!desk.path(out).join("summary.json").exists());
    }
}

#[test]
fn checkpoints_on_the_way_change_no_result() {
    let desk = slope();
    let plain = desk.run(&["slope.toml"], "plain");
    let set = ["slope.toml", "--set", "output.checkpoint_interval=0.0137"];
    let often = desk.run(&set, "often");
    assert_eq!(plain["state_hash"], often["state_hash"]);
    assert_eq!(desk.read("plain/trajectory.csv"), desk.read("often/trajectory.csv"));
    says(&desk.read("often/scene.toml"), &["checkpoint_interval = 0.0137"]);
}

#[cfg(unix)]
mod stopped {
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    use super::*;

    /// Starts a run without end, with a checkpoint each simulated 0.1 s, and waits for the first.
    fn start(desk: &Desk) -> Child {
        let child = Command::new(env!("CARGO_BIN_EXE_tumble"))
            .current_dir(desk.0.path())
            .args(["run", "slope.toml", "--duration", "1e6", "--out", "o"])
            .args(["--set", "output.checkpoint_interval=0.1", "--set", "dt=1e-5"])
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while !desk.path("o/checkpoint.tumble").exists() {
            assert!(start.elapsed() < Duration::from_secs(30), "no checkpoint came");
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(150));
        child
    }

    /// Resumes to a little after where the run stopped, and compares with a run that never did.
    fn resume_and_compare(desk: &Desk) {
        let energy = desk.read("o/energy.csv");
        let whole = &energy[..energy.rfind('\n').unwrap()];
        let last: f64 = rows(whole).last().unwrap()[0].parse().unwrap();
        let until = format!("{}", last + 0.1234);
        desk.tumble(&["resume", "o", "--duration", &until]).ends_with(0);
        let sets = ["--set", "output.checkpoint_interval=0.1", "--set", "dt=1e-5"];
        desk.run(&[&["slope.toml", "--duration", &until], &sets[..]].concat(), "whole");
        same_files(desk, "o", "whole");
    }

    #[test]
    fn by_ctrl_c() {
        let desk = slope();
        let mut child = start(&desk);
        let id = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert_eq!(desk.summary("o")["interrupted"], true);
        resume_and_compare(&desk);
    }

    #[test]
    fn by_kill_9() {
        let desk = slope();
        for round in 0..2u64 {
            let mut child = start(&desk);
            std::thread::sleep(Duration::from_millis(7 * round));
            child.kill().unwrap();
            child.wait().unwrap();
            assert!(!desk.path("o/summary.json").exists());
            // a temporary file may be left
            let _ = fs::remove_file(desk.path("o/.checkpoint.tumble.partial"));
            resume_and_compare(&desk);
            fs::remove_dir_all(desk.path("o")).unwrap();
            fs::remove_dir_all(desk.path("whole")).unwrap();
        }
    }
}
