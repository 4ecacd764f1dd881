//! `tumble export`: every format is written completely or not at all.

#![allow(clippy::unwrap_used)]

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use common::{BODY, TestDir, assert_contains, rows};

/// A directory with a short run in the folder `r`.
fn run_dir() -> TestDir {
    let dir = TestDir::new();
    let scene = format!(
        "duration = 0.2\noutput = {{ interval = 0.02 }}\n[box]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n{BODY}"
    );
    dir.write("s.toml", scene);
    dir.run(&["s.toml"], "r");
    dir
}

#[test]
fn every_format_is_written_and_reported() {
    let dir = run_dir();
    for ending in ["glb", "usda", "pvd", "csv", "png", "gif", "b.GLB"] {
        let file = format!("a.{ending}");
        let mut args = vec!["export", "r", "--to", &file];
        if ["png", "gif"].contains(&ending) {
            args.extend(["--size", "120x80"]);
        }
        let outcome = dir.tumble(&args).expect_status(0);
        assert_contains(&outcome.stdout, &[&file, " frame", " kB"]);
        assert_eq!(outcome.stderr, "", "no progress bar in a pipe");
    }
    let names = [
        "a.b.GLB", "a.csv", "a.gif", "a.glb", "a.png", "a.pvd", "a.usda", "a_frames", "r", "s.toml",
    ];
    assert_eq!(dir.files(""), names);
    assert_eq!(dir.files("a_frames").len(), 11);
    // all frames: the same rows as in the run
    assert_eq!(dir.read("a.csv"), dir.read("r/trajectory.csv"));
    assert!(fs::read(dir.path("a.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(fs::read(dir.path("a.gif")).unwrap().starts_with(b"GIF89a"));
    assert_eq!(fs::read(dir.path("a.glb")).unwrap(), fs::read(dir.path("a.b.GLB")).unwrap());
}

#[test]
fn options_select_frames_and_camera() {
    let dir = run_dir();
    let csv = |args: &[&str]| {
        let mut all = vec!["export", "r", "--to", "b.csv", "--force"];
        all.extend(args);
        dir.tumble(&all).expect_status(0);
        rows(&dir.read("b.csv"))[1..].iter().map(|row| row[0].clone()).collect::<Vec<_>>()
    };
    assert_eq!(csv(&["--fps", "10"]), ["0.0", "0.1", "0.2"]);
    assert_eq!(csv(&["--from", "0.05", "--to-time", "0.09"]), ["0.06", "0.08"]);
    let png = |args: &[&str]| {
        let mut all = vec!["export", "r", "--to", "b.png", "--force", "--size", "90x60"];
        all.extend(args);
        dir.tumble(&all).expect_status(0);
        fs::read(dir.path("b.png")).unwrap()
    };
    let usual = png(&[]);
    assert_ne!(usual, png(&["--at", "0.1"]));
    assert_ne!(png(&["--camera", "-30,20"]), png(&["--camera=-30,20,2"]));
    assert_eq!(usual, png(&["--to-time", "9"]));
}

#[test]
fn an_interrupted_run_can_be_exported() {
    let dir = run_dir();
    fs::remove_file(dir.path("r/summary.json")).unwrap();
    fs::remove_file(dir.path("r/checkpoint.tumble")).unwrap();
    dir.tumble(&["export", "r", "--to", "a.glb"]).expect_status(0);
    let text = dir.read("r/trajectory.csv");
    dir.write("r/trajectory.csv", &text[..text.len() - 5]);
    let outcome = dir.tumble(&["export", "r", "--to", "b.glb"]).expect_status(2);
    assert_contains(&outcome.stderr, &["r/trajectory.csv:12: is cut short", "tumble resume"]);
    assert_eq!(dir.files(""), ["a.glb", "r", "s.toml"]);
}

#[test]
fn folders_without_a_run_are_rejected() {
    let dir = run_dir();
    dir.write("empty/x", "");
    let rejected = |run: &str, part: &str| {
        let outcome = dir.tumble(&["export", run, "--to", "a.csv"]).expect_status(2);
        assert_contains(&outcome.stderr, &["error: ", part]);
        assert_eq!((outcome.stdout.as_str(), dir.path("a.csv").exists()), ("", false));
    };
    rejected("nowhere", "nowhere cannot be read");
    rejected("s.toml", "s.toml is not a folder");
    rejected("empty", "empty holds no run");
    let header = dir.read("r/trajectory.csv").lines().next().unwrap().to_owned() + "\n";
    for (file, text, part) in [
        ("trajectory.csv", header.as_str(), "r/trajectory.csv:1: holds no frame"),
        ("energy.csv", "time\n", "r/energy.csv:1: does not begin with its header"),
        ("scene.toml", "dt = 0\n", "r/scene.toml:1:6"),
    ] {
        let whole = dir.read(&format!("r/{file}"));
        dir.write(&format!("r/{file}"), text);
        rejected("r", part);
        fs::remove_file(dir.path(&format!("r/{file}"))).unwrap();
        rejected("r", file);
        dir.write(&format!("r/{file}"), whole);
    }
}

#[test]
fn invalid_options_are_rejected_before_the_run_is_read() {
    let dir = TestDir::new();
    dir.write("old.csv", "mine");
    fs::create_dir(dir.path("folder.csv")).unwrap();
    for (file, options, parts) in [
        (
            "a",
            &[][..],
            &[
                "no ending that names a format",
                ".glb",
                ".usda",
                ".pvd",
                ".csv",
                ".png",
                ".gif",
                ".mp4",
            ][..],
        ),
        ("a.fbx", &[], &["a.fbx", ".glb"]),
        ("a.csv", &["--fps", "0"], &["--fps must be above 0"]),
        ("a.csv", &["--fps", "-1"], &["--fps must be above 0"]),
        ("a.csv", &["--fps", "nan"], &["--fps must be above 0"]),
        ("a.gif", &["--size", "0x0"], &["--size must have sides from 16"]),
        ("a.gif", &["--size", "99999x99999"], &["--size"]),
        ("a.gif", &["--size", "8192x8192"], &["--size"]),
        ("a.gif", &["--size", "big"], &["as in 800x500"]),
        ("a.gif", &["--from", "2", "--to-time", "1"], &["--from 2 is after --to-time 1"]),
        ("a.gif", &["--from", "inf"], &["--from must be a time"]),
        ("a.png", &["--camera", "1"], &["as in 30,20"]),
        ("a.png", &["--camera", "0,91"], &["pitch from -90 to 90"]),
        ("a.png", &["--camera", "0,0,0"], &["zoom from 0.01"]),
        ("a.gif", &["--at", "1"], &["--at is for .png"]),
        ("a.glb", &["--size", "64x64"], &["--size is for .png, .gif and .mp4"]),
        ("a.png", &["--fps", "3"], &["--fps is for all formats but .png"]),
        ("old.csv", &[], &["old.csv is there already", "--force"]),
        ("folder.csv", &["--force"], &["folder.csv", "it is a folder"]),
    ] {
        let mut args = vec!["export", "nowhere", "--to", file];
        args.extend(options);
        let outcome = dir.tumble(&args);
        let status = if file == "folder.csv" { 1 } else { 2 };
        assert_contains(&outcome.expect_status(status).stderr, parts);
    }
    let outcome = dir.tumble(&["export", "nowhere", "--to", "no/where/a.csv"]).expect_status(1);
    assert_contains(&outcome.stderr, &["cannot write no/where/a.csv", "make its folder first"]);
    assert_eq!(dir.read("old.csv"), "mine");
    assert_eq!(dir.files(""), ["folder.csv", "old.csv"]);
}

#[test]
fn times_without_frames_are_rejected() {
    let dir = run_dir();
    for (file, options) in [("a.csv", ["--from", "5"]), ("a.png", ["--at", "5"])] {
        let outcome =
            dir.tumble(&["export", "r", "--to", file, options[0], options[1]]).expect_status(2);
        assert_contains(&outcome.stderr, &["no frame was recorded"]);
    }
    assert_eq!(dir.files(""), ["r", "s.toml"]);
}

/// Exports a video with `PATH` set to one folder.
#[cfg(unix)]
fn export_video(dir: &TestDir, path: &Path) -> (Option<i32>, String) {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("tumble"));
    command.args(["export", "r", "--to", "a.mp4", "--size", "64x48"]).env("PATH", path);
    let output = command.current_dir(dir.path("")).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[cfg(unix)]
#[test]
fn a_video_needs_ffmpeg_and_its_errors_are_reported() {
    use std::os::unix::fs::PermissionsExt;
    let dir = run_dir();
    fs::create_dir(dir.path("bin")).unwrap();
    let (status, stderr) = export_video(&dir, &dir.path("bin"));
    assert_eq!(status, Some(1));
    assert_contains(&stderr, &["ffmpeg", "not to be found"]);
    for (script, part) in [
        // reads all input and fails; fails at once; leaves an incomplete file
        ("while read -r line; do :; done; echo no codec >&2; exit 3", "no codec"),
        ("echo bad option >&2; exit 1", "bad option"),
        ("for last; do :; done; echo torn > \"${last#file:}\"; exit 1", "exit status: 1"),
    ] {
        let program = dir.write("bin/ffmpeg", format!("#!/bin/sh\n{script}\n"));
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let (status, stderr) = export_video(&dir, &dir.path("bin"));
        assert_eq!(status, Some(1), "{stderr}");
        // if the program exits at once, the error may be a broken pipe
        assert!(stderr.contains(part) || stderr.contains("pipe"), "{stderr}");
        assert_eq!(dir.files(""), ["bin", "r", "s.toml"]);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_files() {
    let dir = run_dir();
    dir.run(&["many", "--duration", "1"], "long");
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("tumble"));
    command.args(["export", "long", "--to", "a.gif", "--size", "1600x1000"]);
    let mut child = command.current_dir(dir.path("")).spawn().unwrap();
    let begin = Instant::now();
    // wait until the output file has been started
    while !dir.files("").iter().any(|name| name.ends_with(".partial")) {
        assert!(begin.elapsed() < Duration::from_secs(50) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(20));
    }
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(dir.files(""), ["long", "r", "s.toml"]);
}
