//! The folder of a run: what may be overwritten, and what it holds after an interruption or error.

#![allow(clippy::unwrap_used)]
#![cfg(unix)]

mod common;

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::{TestDir, assert_contains, rows};

fn start(dir: &TestDir, args: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_tumble"))
        .current_dir(dir.0.path())
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
        assert!(start.elapsed() < Duration::from_secs(30), "{} was not created", path.display());
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_run_does_not_overwrite_another() {
    let dir = TestDir::new();
    let args = ["run", "task1", "--duration", "0.02", "--out", "o"];
    dir.tumble(&args).expect_status(0);
    let before = dir.read("o/summary.json");
    let outcome = dir.tumble(&args).expect_status(2);
    assert_contains(&outcome.stderr, &["o already holds a run", "--out", "--force"]);
    assert_eq!(dir.read("o/summary.json"), before);

    // a single file of a run is enough, even a broken link
    for name in ["energy.svg", "summary.json"] {
        fs::create_dir_all(dir.path(name).with_extension("d")).unwrap();
        let folder = dir.path(name).with_extension("d");
        symlink("/nowhere/at/all", folder.join(name)).unwrap();
        let outcome =
            dir.tumble(&["run", "task1", "--out", folder.to_str().unwrap()]).expect_status(2);
        assert_contains(&outcome.stderr, &["already holds a run"]);
    }

    // other files are kept
    dir.write("o/notes.txt", "mine");
    let mut forced = args.to_vec();
    forced.extend(["--force", "--set", "dt=1e-2"]);
    dir.tumble(&forced).expect_status(0);
    assert_eq!(dir.summary("o")["steps"], 2);
    assert_eq!(dir.read("o/notes.txt"), "mine");
}

#[test]
fn force_does_not_overwrite_a_scene_that_no_run_wrote() {
    let dir = TestDir::new();
    let mine = format!("# mine\nduration = 0.02\n{}", common::BODY);
    dir.write("o/scene.toml", &mine);
    let args = ["run", "o/scene.toml", "--out", "o", "--force"];
    let outcome = dir.tumble(&args).expect_status(2);
    assert_contains(&outcome.stderr, &["o/scene.toml was not written by a run", "--out"]);
    assert_eq!(dir.read("o/scene.toml"), mine);
    // the scene.toml of a run can be run again in its own folder
    dir.run(&["o/scene.toml"], "p");
    dir.tumble(&["run", "p/scene.toml", "--out", "p", "--force"]).expect_status(0);
}

#[test]
fn runs_started_at_once_get_different_folders() {
    let dir = TestDir::new();
    let runs: Vec<Child> =
        (0..6).map(|_| start(&dir, &["run", "task1", "--duration", "0.02"])).collect();
    for run in runs {
        assert!(run.wait_with_output().unwrap().status.success());
    }
    assert_eq!(dir.files("out"), ["task1", "task1-2", "task1-3", "task1-4", "task1-5", "task1-6"]);
    for folder in dir.files("out") {
        assert_eq!(dir.summary(&format!("out/{folder}"))["steps"], 20);
        let trajectory = dir.read(&format!("out/{folder}/trajectory.csv"));
        assert_eq!(rows(&trajectory).len(), 1 + 3);
    }
}

#[test]
fn a_folder_in_which_a_run_is_going_is_not_written_to() {
    let dir = TestDir::new();
    let mut child = start(&dir, &["run", "task2", "--duration", "1e6", "--out", "o"]);
    wait_for(&dir.path("o/checkpoint.tumble"));
    let calls: [&[&str]; 4] = [
        &["run", "task1", "--duration", "0.02", "--out", "o"],
        &["run", "task1", "--duration", "0.02", "--out", "o", "--force"],
        &["resume", "o", "--duration", "0.02"],
        &["resume", "o", "--duration", "1e7", "--out", "o/../o", "--force"],
    ];
    for call in calls {
        let outcome = dir.tumble(call).expect_status(2);
        assert_contains(&outcome.stderr, &["error: a run is still going in o", "--out"]);
    }
    assert!(child.try_wait().unwrap().is_none(), "the run was disturbed");
    // a killed run locks nothing
    child.kill().unwrap();
    child.wait().unwrap();
    dir.tumble(&["run", "task1", "--duration", "0.02", "--out", "o", "--force"]).expect_status(0);
    assert!(!dir.files("o").iter().any(|name| name.contains("lock")), "{:?}", dir.files("o"));
}

#[test]
fn ctrl_c_leaves_a_complete_folder() {
    for name in ["-INT", "-TERM"] {
        let dir = TestDir::new();
        let child = start(&dir, &["run", "task2", "--duration", "1e6", "--out", "o"]);
        wait_for(&dir.path("o/energy.csv"));
        // let it take some steps
        std::thread::sleep(Duration::from_millis(300));
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130));
        let text = String::from_utf8(output.stdout).unwrap();
        assert_contains(&text, &["stopped early"]);
        assert!(output.stderr.is_empty());
        let summary = dir.summary("o");
        assert_eq!(summary["interrupted"], true);
        let steps = summary["steps"].as_u64().unwrap();
        assert!(steps > 0 && steps < 1_000_000_000);
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
        // all frames so far, all rows complete
        let rows = rows(&dir.read("o/trajectory.csv"));
        assert_eq!(rows.len() as u64, 2 + steps / 10);
        assert!(rows.iter().all(|row| row.len() == 18));
    }
}

#[test]
fn an_ignored_sighup_does_not_stop_a_run() {
    let dir = TestDir::new();
    let child = Command::new("sh")
        .current_dir(dir.0.path())
        .args(["-c", "trap '' HUP; exec \"$0\" run task2 --duration 1e6 --out o"])
        .arg(env!("CARGO_BIN_EXE_tumble"))
        .stdout(Stdio::null())
        .spawn();
    let mut child = child.unwrap();
    wait_for(&dir.path("o/energy.csv"));
    signal(&child, "-HUP");
    std::thread::sleep(Duration::from_millis(400));
    assert!(child.try_wait().unwrap().is_none(), "the run ended");
    signal(&child, "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_folder_that_cannot_be_created_is_status_1() {
    let dir = TestDir::new();
    dir.write("file", "mine");
    for out in ["file", "file/below", "/proc/nowhere/o"] {
        let outcome =
            dir.tumble(&["run", "task1", "--duration", "0.02", "--out", out]).expect_status(1);
        assert_contains(&outcome.stderr, &["error: cannot make the folder", out, "--out"]);
        assert_eq!(outcome.stdout, "");
    }
    assert_eq!(dir.read("file"), "mine");
    dir.write("out", "a file where the folders of runs go");
    let outcome = dir.tumble(&["run", "task1", "--duration", "0.02"]).expect_status(1);
    assert_contains(&outcome.stderr, &["cannot make the folder out/task1"]);
}

/// The message of a run that fails because no file may have more than so many KiB.
fn message_at_file_limit(dir: &TestDir, limit: u32, arguments: &str) -> String {
    let script = format!("trap '' XFSZ; ulimit -f {limit}; exec \"$0\" run {arguments}");
    let output = Command::new("bash")
        .current_dir(dir.0.path())
        .args(["-c", &script, env!("CARGO_BIN_EXE_tumble")])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_file_that_cannot_be_written_is_status_1_without_a_summary() {
    let dir = TestDir::new();
    // the scene cannot be written: files may have no bytes
    let message = message_at_file_limit(&dir, 0, "task1 --duration 0.02 --out o");
    assert_contains(&message, &["cannot write o/scene.toml", "--out"]);
    assert!(dir.files("o").is_empty(), "{:?}", dir.files("o"));

    // the summary cannot be written: all but the last file is there
    fs::create_dir(dir.path("o/.summary.json.partial")).unwrap();
    let outcome =
        dir.tumble(&["run", "task1", "--duration", "0.02", "--out", "o"]).expect_status(1);
    assert_contains(&outcome.stderr, &["cannot write o/summary.json"]);
    assert!(!dir.path("o/summary.json").exists());
    assert!(dir.path("o/motion.png").exists());
}

#[test]
fn temporary_files_do_not_follow_links() {
    let dir = TestDir::new();
    dir.write("precious", "mine");
    fs::create_dir(dir.path("o")).unwrap();
    for name in ["scene.toml", "checkpoint.tumble", "summary.json", "motion.html"] {
        symlink(dir.path("precious"), dir.path("o").join(format!(".{name}.partial"))).unwrap();
    }
    dir.tumble(&["run", "task1", "--duration", "0.02", "--out", "o"]).expect_status(0);
    assert_eq!(dir.read("precious"), "mine");
    for name in dir.files("o") {
        assert!(!dir.path("o").join(&name).is_symlink() && !name.contains("partial"), "{name}");
    }
}

#[test]
fn a_trajectory_that_does_not_fit_is_status_1_without_a_summary() {
    let dir = TestDir::new();
    let message = message_at_file_limit(&dir, 32, "task2 --set output.interval=1e-3 --out o");
    assert_contains(&message, &["cannot write o/trajectory.csv", "--out"]);
    assert!(!dir.path("o/summary.json").exists());
}

#[test]
fn a_closed_or_full_output_does_not_change_the_results() {
    let dir = TestDir::new();
    let status = |redirect: &str| {
        let script = format!("\"$0\" {redirect}");
        let mut shell = Command::new("sh");
        shell.current_dir(dir.0.path()).args(["-c", &script, env!("CARGO_BIN_EXE_tumble")]);
        shell.output().unwrap().status.code()
    };
    assert_eq!(status("run nope 2>/dev/full"), Some(2));
    assert_eq!(status("run nope 2>&-"), Some(2));
    assert_eq!(status("run task1 --duration 0.02 --out o >/dev/full"), Some(1));
    assert_eq!(dir.summary("o")["steps"], 20, "the results are complete");
    assert_eq!(status("scenes | head -n 1"), Some(0));
}
