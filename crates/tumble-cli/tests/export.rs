//! `tumble export` from outside: every format appears whole or not at all.

#![allow(clippy::unwrap_used)]

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use common::{BODY, Desk, rows, says};

/// A desk with a short run in the folder `r`.
fn desk() -> Desk {
    let desk = Desk::new();
    let scene = format!(
        "duration = 0.2\noutput = {{ interval = 0.02 }}\n[box]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n{BODY}"
    );
    desk.write("s.toml", scene);
    desk.run(&["s.toml"], "r");
    desk
}

#[test]
fn every_format_is_written_and_reported() {
    let desk = desk();
    for ending in ["glb", "usda", "pvd", "csv", "png", "gif", "b.GLB"] {
        let file = format!("a.{ending}");
        let mut args = vec!["export", "r", "--to", &file];
        if ["png", "gif"].contains(&ending) {
            args.extend(["--size", "120x80"]);
        }
        let said = desk.tumble(&args).ends_with(0);
        says(&said.out, &[&file, " frame", " kB"]);
        assert_eq!(said.err, "", "a pipe hears nothing of the progress");
    }
    let names = [
        "a.b.GLB", "a.csv", "a.gif", "a.glb", "a.png", "a.pvd", "a.usda", "a_frames", "r", "s.toml",
    ];
    assert_eq!(desk.files(""), names);
    assert_eq!(desk.files("a_frames").len(), 11);
    // with every frame, the rows are those of the run
    assert_eq!(desk.read("a.csv"), desk.read("r/trajectory.csv"));
    assert!(fs::read(desk.path("a.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(fs::read(desk.path("a.gif")).unwrap().starts_with(b"GIF89a"));
    assert_eq!(fs::read(desk.path("a.glb")).unwrap(), fs::read(desk.path("a.b.GLB")).unwrap());
}

#[test]
fn frames_and_views_are_as_asked() {
    let desk = desk();
    let csv = |args: &[&str]| {
        let mut all = vec!["export", "r", "--to", "b.csv", "--force"];
        all.extend(args);
        desk.tumble(&all).ends_with(0);
        rows(&desk.read("b.csv"))[1..].iter().map(|row| row[0].clone()).collect::<Vec<_>>()
    };
    assert_eq!(csv(&["--fps", "10"]), ["0.0", "0.1", "0.2"]);
    assert_eq!(csv(&["--from", "0.05", "--to-time", "0.09"]), ["0.06", "0.08"]);
    let png = |args: &[&str]| {
        let mut all = vec!["export", "r", "--to", "b.png", "--force", "--size", "90x60"];
        all.extend(args);
        desk.tumble(&all).ends_with(0);
        fs::read(desk.path("b.png")).unwrap()
    };
    let usual = png(&[]);
    assert_ne!(usual, png(&["--at", "0.1"]));
    assert_ne!(png(&["--camera", "-30,20"]), png(&["--camera=-30,20,2"]));
    assert_eq!(usual, png(&["--to-time", "9"]));
}

#[test]
fn an_interrupted_run_is_exported_as_far_as_it_went() {
    let desk = desk();
    fs::remove_file(desk.path("r/summary.json")).unwrap();
    fs::remove_file(desk.path("r/checkpoint.tumble")).unwrap();
    desk.tumble(&["export", "r", "--to", "a.glb"]).ends_with(0);
    let text = desk.read("r/trajectory.csv");
    desk.write("r/trajectory.csv", &text[..text.len() - 5]);
    let said = desk.tumble(&["export", "r", "--to", "b.glb"]).ends_with(2);
    says(&said.err, &["r/trajectory.csv:12: is cut short", "tumble resume"]);
    assert_eq!(desk.files(""), ["a.glb", "r", "s.toml"]);
}

#[test]
fn what_is_no_run_is_refused() {
    let desk = desk();
    desk.write("empty/x", "");
    let refused = |run: &str, part: &str| {
        let said = desk.tumble(&["export", run, "--to", "a.csv"]).ends_with(2);
        says(&said.err, &["error: ", part]);
        assert_eq!((said.out.as_str(), desk.path("a.csv").exists()), ("", false));
    };
    refused("nowhere", "nowhere cannot be read");
    refused("s.toml", "s.toml is no folder");
    refused("empty", "empty holds no run");
    let header = desk.read("r/trajectory.csv").lines().next().unwrap().to_owned() + "\n";
    for (file, text, part) in [
        ("trajectory.csv", header.as_str(), "r/trajectory.csv:1: holds no frame"),
        ("energy.csv", "time\n", "r/energy.csv:1: does not begin with its header"),
        ("scene.toml", "dt = 0\n", "r/scene.toml:1:6"),
    ] {
        let whole = desk.read(&format!("r/{file}"));
        desk.write(&format!("r/{file}"), text);
        refused("r", part);
        fs::remove_file(desk.path(&format!("r/{file}"))).unwrap();
        refused("r", file);
        desk.write(&format!("r/{file}"), whole);
    }
}

#[test]
fn impossible_wishes_are_refused_before_anything_is_read() {
    let desk = Desk::new();
    desk.write("old.csv", "mine");
    fs::create_dir(desk.path("folder.csv")).unwrap();
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
        let said = desk.tumble(&args);
        let status = if file == "folder.csv" { 1 } else { 2 };
        says(&said.ends_with(status).err, parts);
    }
    let said = desk.tumble(&["export", "nowhere", "--to", "no/where/a.csv"]).ends_with(1);
    says(&said.err, &["cannot write no/where/a.csv", "make its folder first"]);
    assert_eq!(desk.read("old.csv"), "mine");
    assert_eq!(desk.files(""), ["folder.csv", "old.csv"]);
}

#[test]
fn times_without_frames_are_refused() {
    let desk = desk();
    for (file, options) in [("a.csv", ["--from", "5"]), ("a.png", ["--at", "5"])] {
        let said = desk.tumble(&["export", "r", "--to", file, options[0], options[1]]).ends_with(2);
        says(&said.err, &["no frame was recorded"]);
    }
    assert_eq!(desk.files(""), ["r", "s.toml"]);
}

/// Exports a film with only the programs of one folder on the path.
#[cfg(unix)]
fn film(desk: &Desk, path: &Path) -> (Option<i32>, String) {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("tumble"));
    command.args(["export", "r", "--to", "a.mp4", "--size", "64x48"]).env("PATH", path);
    let output = command.current_dir(desk.path("")).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[cfg(unix)]
#[test]
fn a_film_needs_ffmpeg_and_says_what_it_said() {
    use std::os::unix::fs::PermissionsExt;
    let desk = desk();
    fs::create_dir(desk.path("bin")).unwrap();
    let (status, said) = film(&desk, &desk.path("bin"));
    assert_eq!(status, Some(1));
    says(&said, &["ffmpeg", "not to be found"]);
    for (script, part) in [
        // reads everything, then fails; fails at once; leaves a torn file behind
        ("while read -r line; do :; done; echo no codec >&2; exit 3", "no codec"),
        ("echo bad option >&2; exit 1", "bad option"),
        ("for last; do :; done; echo torn > \"${last#file:}\"; exit 1", "exit status: 1"),
    ] {
        let program = desk.write("bin/ffmpeg", format!("#!/bin/sh\n{script}\n"));
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        let (status, said) = film(&desk, &desk.path("bin"));
        assert_eq!(status, Some(1), "{said}");
        // a program that goes at once may be heard as a broken pipe
        assert!(said.contains(part) || said.contains("pipe"), "{said}");
        assert_eq!(desk.files(""), ["bin", "r", "s.toml"]);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing() {
    let desk = desk();
    desk.run(&["many", "--duration", "1"], "long");
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("tumble"));
    command.args(["export", "long", "--to", "a.gif", "--size", "1600x1000"]);
    let mut child = command.current_dir(desk.path("")).spawn().unwrap();
    let begin = Instant::now();
    // until there is something to be left behind
    while !desk.files("").iter().any(|name| name.ends_with(".partial")) {
        assert!(begin.elapsed() < Duration::from_secs(50) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(20));
    }
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(desk.files(""), ["long", "r", "s.toml"]);
}
