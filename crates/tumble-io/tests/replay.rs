//! A run is read back as it was written; invalid folders are rejected.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use tempfile::TempDir;
use tumble_io::replay::{Replay, ReplayError};
use tumble_io::run::{RunFolder, run};
use tumble_io::scene::{LoadOptions, Loaded, Source, load_text};

const SCENE: &str = "dt = 1e-3\nduration = 0.05\noutput = { interval = 0.01 }\n\
    wall = [{ normal = [0, 1, 0] }]\n\
    [[body]]\nname = \"a\"\nshape = \"box\"\nposition = [0, 0.11, 0]\ninitial_velocity = [0, -1, 0]\n\
    initial_angular_velocity = [1, 2, 3]\n\
    [[body]]\nname = \"b\"\nparticles = [[0, 0, 0], [1, 0, 0]]\nposition = [0, 2, 0]\n";

fn run_folder() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let source = Source { name: "s.toml".to_owned(), text: SCENE.to_owned() };
    let loaded = load_text("thrown", source, Path::new("."), &LoadOptions::default()).unwrap();
    let folder = RunFolder::create(dir.path(), false).unwrap();
    run(loaded, &folder, &mut |_| true).unwrap();
    dir
}

/// The error message after a change to a file; the file is restored.
fn error_after(dir: &TempDir, file: &str, change: impl FnOnce(String) -> String) -> String {
    let path = dir.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, change(text.clone())).unwrap();
    let message = Replay::open(dir.path()).unwrap_err().to_string();
    fs::write(&path, text).unwrap();
    message
}

#[test]
fn a_run_is_read_back_as_it_was_written() {
    let dir = run_folder();
    let replay = Replay::open(dir.path()).unwrap();
    assert_eq!(replay.scene.name, "thrown");
    assert_eq!((replay.frames.len(), replay.ledger.len()), (6, 6));
    let source = Source { name: "s.toml".to_owned(), text: SCENE.to_owned() };
    let Loaded { mut world, .. } =
        load_text("s", source, Path::new("."), &LoadOptions::default()).unwrap();
    for (frame, row) in replay.frames.iter().zip(&replay.ledger) {
        while world.time() < frame.time {
            world.step().unwrap();
        }
        assert_eq!((frame.time, row.total), (world.time(), world.energy().total()));
        for (pose, body) in frame.poses.iter().zip(world.bodies()) {
            assert_eq!(pose.position, body.position());
            assert_eq!(pose.velocity, body.velocity());
            assert_eq!(pose.orientation, body.orientation());
            assert_eq!(pose.angular_velocity, body.angular_velocity());
            assert_eq!(pose.angular_momentum, body.angular_momentum());
        }
    }
    // without a checkpoint, the name is that of the folder
    fs::remove_file(dir.path().join("checkpoint.tumble")).unwrap();
    let replay = Replay::open(dir.path()).unwrap();
    assert_eq!(replay.scene.name, dir.path().file_name().unwrap().to_string_lossy());
}

#[test]
fn errors_in_rows_name_file_and_line() {
    let dir = run_folder();
    let truncate = |text: String| text[..text.len() - 9].to_owned();
    let message = error_after(&dir, "trajectory.csv", truncate);
    assert!(message.contains("trajectory.csv:13: is cut short"), "{message}");
    assert!(message.contains("tumble resume"), "{message}");
    let message = error_after(&dir, "energy.csv", truncate);
    assert!(message.contains("energy.csv:7: is cut short"), "{message}");
    let message = error_after(&dir, "trajectory.csv", |text| text.replacen(",b,", ",c,", 1));
    assert!(message.contains("trajectory.csv:3: names the body \"c\""), "{message}");
    let message = error_after(&dir, "trajectory.csv", |text| text.replacen(",b,", ",a,", 1));
    assert!(message.contains(":3: is a row of \"a\", but one of \"b\" is expected"), "{message}");
    let without_last_row =
        |text: String| text.lines().take(12).collect::<Vec<_>>().join("\n") + "\n";
    let message = error_after(&dir, "trajectory.csv", without_last_row);
    assert!(message.contains("is not followed by a row of \"b\""), "{message}");
    let first_three_lines =
        |text: String| text.lines().take(3).collect::<Vec<_>>().join("\n") + "\n";
    let message = error_after(&dir, "energy.csv", first_three_lines);
    assert!(message.contains("energy.csv:3: has no row of t = 0.02 s"), "{message}");
    let message = error_after(&dir, "trajectory.csv", first_three_lines);
    assert!(message.contains("energy.csv:3: has more rows than trajectory.csv"), "{message}");
    let message = error_after(&dir, "trajectory.csv", |text| text.replacen("0.02,a", "0.03,a", 1));
    assert!(message.contains("trajectory.csv:7: has t = 0.02 s in the middle of"), "{message}");
    let message = error_after(&dir, "trajectory.csv", |text| text.replace("0.02,", "0.01,"));
    assert!(message.contains("trajectory.csv:7: has a time that does not increase"), "{message}");
    let message =
        error_after(&dir, "trajectory.csv", |text| text.replacen("0.01,a,0.0", "0.01,a,inf", 1));
    assert!(message.contains("trajectory.csv:4: has a number that is not finite"), "{message}");
    let message =
        error_after(&dir, "trajectory.csv", |text| text.lines().take(1).collect::<String>() + "\n");
    assert!(message.contains("holds no frame"), "{message}");
    let message = error_after(&dir, "trajectory.csv", |_| String::new());
    assert!(message.contains("does not begin with its header"), "{message}");
    let message = error_after(&dir, "trajectory.csv", |text| text + &"1".repeat(1 << 20));
    assert!(message.contains("has a row that is too long"), "{message}");
    let message = error_after(&dir, "scene.toml", |_| String::new());
    assert!(message.contains("has not started"), "{message}");
    let message = error_after(&dir, "scene.toml", |text| text.replace("dt =", "dT ="));
    assert!(message.contains("dT"), "{message}");
}

#[test]
fn folders_without_a_run_are_rejected() {
    let dir = run_folder();
    for file in ["scene.toml", "trajectory.csv", "energy.csv"] {
        let (path, renamed) = (dir.path().join(file), dir.path().join("renamed"));
        fs::rename(&path, &renamed).unwrap();
        let error = Replay::open(dir.path()).unwrap_err();
        assert!(error.to_string().contains(file), "{error}");
        fs::create_dir(&path).unwrap();
        assert!(Replay::open(dir.path()).is_err());
        fs::remove_dir(&path).unwrap();
        fs::rename(&renamed, &path).unwrap();
    }
    let is_not_a_run = |path: &Path| matches!(Replay::open(path), Err(ReplayError::NotARun(..)));
    assert!(is_not_a_run(&dir.path().join("scene.toml")));
    assert!(is_not_a_run(&dir.path().join("nowhere")));
    assert!(is_not_a_run(&std::env::temp_dir()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn arbitrary_bytes_are_rejected(
        file in 0usize..3,
        bytes in proptest::collection::vec(any::<u8>(), 0..300),
    ) {
        let dir = copy_of_run();
        let files = ["scene.toml", "trajectory.csv", "energy.csv"];
        change_file(&dir, files[file], |_| bytes);
        prop_assert!(Replay::open(dir.path()).is_err());
    }

    #[test]
    fn damaged_rows_are_read_or_rejected(
        file in 1usize..3,
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in any::<prop::sample::Index>(),
        is_cut in any::<bool>(),
    ) {
        let dir = copy_of_run();
        let files = ["scene.toml", "trajectory.csv", "energy.csv"];
        change_file(&dir, files[file], |mut bytes| {
            for (at, byte) in &damage {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            if is_cut {
                bytes.truncate(cut.index(bytes.len()));
            }
            bytes
        });
        if let Ok(replay) = Replay::open(dir.path()) {
            prop_assert!(replay.frames.iter().all(|frame| frame.poses.len() == 2));
            prop_assert_eq!(replay.frames.len(), replay.ledger.len());
            let is_finite = |pose: &tumble_io::replay::Pose| pose.position.is_finite();
            prop_assert!(replay.frames.iter().flat_map(|frame| &frame.poses).all(is_finite));
        }
    }
}

/// A copy of the files of a run that is simulated only once.
fn copy_of_run() -> TempDir {
    static RUN: std::sync::OnceLock<TempDir> = std::sync::OnceLock::new();
    let source = RUN.get_or_init(run_folder);
    let dir = tempfile::tempdir().unwrap();
    for file in ["scene.toml", "trajectory.csv", "energy.csv"] {
        fs::copy(source.path().join(file), dir.path().join(file)).unwrap();
    }
    dir
}

fn change_file(dir: &TempDir, file: &str, change: impl FnOnce(Vec<u8>) -> Vec<u8>) {
    let path = dir.path().join(file);
    fs::write(&path, change(fs::read(&path).unwrap())).unwrap();
}

#[test]
fn only_a_scene_with_prescribed_motion_has_the_column_work() {
    let header = |motion: &str| {
        let text = format!("{SCENE}motion = \"{motion}\"\n");
        let source = Source { name: "s.toml".to_owned(), text };
        let loaded = load_text("s", source, Path::new("."), &LoadOptions::default()).unwrap();
        let dir = tempfile::tempdir().unwrap();
        let folder = RunFolder::create(dir.path(), false).unwrap();
        run(loaded, &folder, &mut |_| true).unwrap();
        let replay = Replay::open(dir.path()).unwrap();
        assert_eq!(replay.ledger[0].work, 0.0);
        let rows = fs::read_to_string(dir.path().join("energy.csv")).unwrap();
        rows.lines().next().unwrap().to_owned()
    };
    assert!(header("free").ends_with(",total,residual"));
    assert!(header("fixed").ends_with(",total,residual"));
    assert!(header("prescribed").ends_with(",total,residual,work"));
}
