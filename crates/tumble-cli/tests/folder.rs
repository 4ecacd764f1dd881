//! The folder of a run: who may write there, and what is left when something stops the run.

#![allow(clippy::unwrap_used)]
#![cfg(unix)]

mod common;

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::{Desk, rows, says};

fn start(desk: &Desk, args: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_tumble"))
        .current_dir(desk.0.path())
        .args(args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn signal(child: &Child, name: &str) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args([name, &id]).status().unwrap().success());
}

/// Waits until a file is there.
fn wait_for(path: &Path) {
    let start = Instant::now();
    while !path.exists() {
        assert!(start.elapsed() < Duration::from_secs(30), "{} never came", path.display());
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_run_never_writes_over_another() {
    let desk = Desk::new();
    let args = ["run", "task1", "--duration", "0.02", "--out", "o"];
    desk.tumble(&args).ends_with(0);
    let before = desk.read("o/summary.json");
    let said = desk.tumble(&args).ends_with(2);
    says(&said.err, &["o already holds a run", "--out", "--force"]);
    assert_eq!(desk.read("o/summary.json"), before);

    // one file of a run is enough, a link that leads nowhere too
    for name in ["energy.svg", "summary.json"] {
        fs::create_dir_all(desk.path(name).with_extension("d")).unwrap();
        let folder = desk.path(name).with_extension("d");
        symlink("/nowhere/at/all", folder.join(name)).unwrap();
        let said = desk.tumble(&["run", "task1", "--out", folder.to_str().unwrap()]).ends_with(2);
        says(&said.err, &["already holds a run"]);
    }

    // what is not of a run stays
    desk.write("o/notes.txt", "mine");
    let mut forced = args.to_vec();
    forced.extend(["--force", "--set", "dt=1e-2"]);
    desk.tumble(&forced).ends_with(0);
    assert_eq!(desk.summary("o")["steps"], 2);
    assert_eq!(desk.read("o/notes.txt"), "mine");
}

#[test]
fn force_keeps_a_scene_that_no_run_wrote() {
    let desk = Desk::new();
    let mine = format!("# mine\nduration = 0.02\n{}", common::BODY);
    desk.write("o/scene.toml", &mine);
    let args = ["run", "o/scene.toml", "--out", "o", "--force"];
    let said = desk.tumble(&args).ends_with(2);
    says(&said.err, &["o/scene.toml was not written by a run", "--out"]);
    assert_eq!(desk.read("o/scene.toml"), mine);
    // a run's own scene may run again in its place
    desk.run(&["o/scene.toml"], "p");
    desk.tumble(&["run", "p/scene.toml", "--out", "p", "--force"]).ends_with(0);
}

#[test]
fn runs_that_start_together_get_a_folder_each() {
    let desk = Desk::new();
    let runs: Vec<Child> =
        (0..6).map(|_| start(&desk, &["run", "task1", "--duration", "0.02"])).collect();
    for run in runs {
        assert!(run.wait_with_output().unwrap().status.success());
    }
    assert_eq!(desk.files("out"), ["task1", "task1-2", "task1-3", "task1-4", "task1-5", "task1-6"]);
    for folder in desk.files("out") {
        assert_eq!(desk.summary(&format!("out/{folder}"))["steps"], 20);
        let trajectory = desk.read(&format!("out/{folder}/trajectory.csv"));
        assert_eq!(rows(&trajectory).len(), 1 + 3);
    }
}

#[test]
fn ctrl_c_leaves_a_complete_folder() {
    for name in ["-INT", "-TERM"] {
        let desk = Desk::new();
        let child = start(&desk, &["run", "task2", "--duration", "1e6", "--out", "o"]);
        wait_for(&desk.path("o/energy.csv"));
        // the first moment of stepping
        std::thread::sleep(Duration::from_millis(300));
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130));
        let text = String::from_utf8(output.stdout).unwrap();
        says(&text, &["stopped early"]);
        assert!(output.stderr.is_empty());
        let summary = desk.summary("o");
        assert_eq!(summary["interrupted"], true);
        let steps = summary["steps"].as_u64().unwrap();
        assert!(steps > 0 && steps < 1_000_000_000);
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
        // every frame up to there, every row whole
        let rows = rows(&desk.read("o/trajectory.csv"));
        assert_eq!(rows.len() as u64, 2 + steps / 10);
        assert!(rows.iter().all(|row| row.len() == 18));
    }
}

#[test]
fn a_hang_up_that_nohup_ignores_does_not_stop_a_run() {
    let desk = Desk::new();
    let child = Command::new("sh")
        .current_dir(desk.0.path())
        .args(["-c", "trap '' HUP; exec \"$0\" run task2 --duration 1e6 --out o"])
        .arg(env!("CARGO_BIN_EXE_tumble"))
        .stdout(Stdio::null())
        .spawn();
    let mut child = child.unwrap();
    wait_for(&desk.path("o/energy.csv"));
    signal(&child, "-HUP");
    std::thread::sleep(Duration::from_millis(400));
    assert!(child.try_wait().unwrap().is_none(), "the run ended");
    signal(&child, "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_folder_that_cannot_be_made_is_status_1() {
    let desk = Desk::new();
    desk.write("file", "mine");
    for out in ["file", "file/below", "/proc/nowhere/o"] {
        let said = desk.tumble(&["run", "task1", "--duration", "0.02", "--out", out]).ends_with(1);
        says(&said.err, &["error: cannot make the folder", out, "--out"]);
        assert_eq!(said.out, "");
    }
    assert_eq!(desk.read("file"), "mine");
    desk.write("out", "a file where the folders of runs go");
    let said = desk.tumble(&["run", "task1", "--duration", "0.02"]).ends_with(1);
    says(&said.err, &["cannot make the folder out/task1"]);
}

#[test]
fn a_full_disk_is_status_1_without_a_summary() {
    let desk = Desk::new();
    // the scene does not fit
    fs::create_dir(desk.path("o")).unwrap();
    symlink("/dev/full", desk.path("o/.scene.toml.partial")).unwrap();
    let said = desk.tumble(&["run", "task1", "--duration", "0.02", "--out", "o"]).ends_with(1);
    says(&said.err, &["cannot write o/scene.toml", "No space left", "free some space", "--out"]);
    assert!(desk.files("o").is_empty(), "{:?}", desk.files("o"));

    // the summary does not fit: all but the last file is there
    symlink("/dev/full", desk.path("o/.summary.json.partial")).unwrap();
    let said = desk.tumble(&["run", "task1", "--duration", "0.02", "--out", "o"]).ends_with(1);
    says(&said.err, &["cannot write o/summary.json"]);
    assert!(!desk.path("o/summary.json").exists());
    assert!(desk.path("o/motion.png").exists());
}

#[test]
fn a_trajectory_that_does_not_fit_is_status_1_without_a_summary() {
    let desk = Desk::new();
    // 32 KiB are the most that a file may have
    let script =
        "trap '' XFSZ; ulimit -f 32; exec \"$0\" run task2 --set output.interval=1e-3 --out o";
    let output = Command::new("bash")
        .current_dir(desk.0.path())
        .args(["-c", script, env!("CARGO_BIN_EXE_tumble")])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let message = String::from_utf8(output.stderr).unwrap();
    says(&message, &["cannot write o/trajectory.csv", "--out"]);
    assert!(!desk.path("o/summary.json").exists());
}

#[test]
fn messages_that_nobody_can_read_change_nothing() {
    let desk = Desk::new();
    let status = |redirect: &str| {
        let script = format!("\"$0\" {redirect}");
        let mut shell = Command::new("sh");
        shell.current_dir(desk.0.path()).args(["-c", &script, env!("CARGO_BIN_EXE_tumble")]);
        shell.output().unwrap().status.code()
    };
    assert_eq!(status("run nope 2>/dev/full"), Some(2));
    assert_eq!(status("run nope 2>&-"), Some(2));
    assert_eq!(status("run task1 --duration 0.02 --out o >/dev/full"), Some(1));
    assert_eq!(desk.summary("o")["steps"], 20, "the results are there all the same");
    assert_eq!(status("scenes | head -n 1"), Some(0));
}
