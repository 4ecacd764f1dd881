//! A run is read back as it was written, and nothing else is taken for one.

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
    [[body]]\nname = \"a\"\nshape = \"box\"\nposition = [0, 0.06, 0]\ninitial_velocity = [0, -1, 0]\n\
    initial_angular_velocity = [1, 2, 3]\n\
    [[body]]\nname = \"b\"\nparticles = [[0, 0, 0], [1, 0, 0]]\nposition = [0, 2, 0]\n";

fn made() -> TempDir {
    let desk = tempfile::tempdir().unwrap();
    let source = Source { name: "s.toml".to_owned(), text: SCENE.to_owned() };
    let loaded = load_text("thrown", source, Path::new("."), &LoadOptions::default()).unwrap();
    let folder = RunFolder::create(desk.path(), false).unwrap();
    run(loaded, &folder, &mut |_| true).unwrap();
    desk
}

/// The message after a file was changed.
fn complaint(desk: &TempDir, file: &str, change: impl FnOnce(String) -> String) -> String {
    let path = desk.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, change(text.clone())).unwrap();
    let message = Replay::open(desk.path()).unwrap_err().to_string();
    fs::write(&path, text).unwrap();
    message
}

#[test]
fn a_run_is_read_as_it_was_written() {
    let desk = made();
    let replay = Replay::open(desk.path()).unwrap();
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
    // without a checkpoint the folder gives the name
    fs::remove_file(desk.path().join("checkpoint.tumble")).unwrap();
    let replay = Replay::open(desk.path()).unwrap();
    assert_eq!(replay.scene.name, desk.path().file_name().unwrap().to_string_lossy());
}

#[test]
fn rows_that_are_wrong_are_named_by_file_and_line() {
    let desk = made();
    let cut = |text: String| text[..text.len() - 9].to_owned();
    let told = complaint(&desk, "trajectory.csv", cut);
    assert!(told.contains("trajectory.csv:13: is cut short"), "{told}");
    assert!(told.contains("tumble resume"), "{told}");
    let told = complaint(&desk, "energy.csv", cut);
    assert!(told.contains("energy.csv:7: is cut short"), "{told}");
    let told = complaint(&desk, "trajectory.csv", |text| text.replacen(",b,", ",c,", 1));
    assert!(told.contains("trajectory.csv:3: names the body \"c\""), "{told}");
    let told = complaint(&desk, "trajectory.csv", |text| text.replacen(",b,", ",a,", 1));
    assert!(told.contains(":3: is a row of \"a\" where one of \"b\" is due"), "{told}");
    let last = |text: String| text.lines().take(12).collect::<Vec<_>>().join("\n") + "\n";
    let told = complaint(&desk, "trajectory.csv", last);
    assert!(told.contains("is followed by no row of \"b\""), "{told}");
    let fewer = |text: String| text.lines().take(3).collect::<Vec<_>>().join("\n") + "\n";
    let told = complaint(&desk, "energy.csv", fewer);
    assert!(told.contains("energy.csv:3: has no row of t = 0.02 s"), "{told}");
    let told = complaint(&desk, "trajectory.csv", fewer);
    assert!(told.contains("energy.csv:3: has more rows than trajectory.csv"), "{told}");
    let told = complaint(&desk, "trajectory.csv", |text| text.replacen("0.02,a", "0.03,a", 1));
    assert!(told.contains("trajectory.csv:7: has t = 0.02 s in the middle of"), "{told}");
    let told = complaint(&desk, "trajectory.csv", |text| text.replace("0.02,", "0.01,"));
    assert!(told.contains("trajectory.csv:7: has a time that does not rise"), "{told}");
    let told =
        complaint(&desk, "trajectory.csv", |text| text.replacen("0.01,a,0.0", "0.01,a,inf", 1));
    assert!(told.contains("trajectory.csv:4: holds a number that is not finite"), "{told}");
    let told =
        complaint(&desk, "trajectory.csv", |text| text.lines().take(1).collect::<String>() + "\n");
    assert!(told.contains("holds no frame"), "{told}");
    let told = complaint(&desk, "trajectory.csv", |_| String::new());
    assert!(told.contains("does not begin with its header"), "{told}");
    let told = complaint(&desk, "trajectory.csv", |text| text + &"1".repeat(1 << 20));
    assert!(told.contains("has a row without an end"), "{told}");
    let told = complaint(&desk, "scene.toml", |_| String::new());
    assert!(told.contains("has not begun"), "{told}");
    let told = complaint(&desk, "scene.toml", |text| text.replace("dt =", "dT ="));
    assert!(told.contains("dT"), "{told}");
}

#[test]
fn what_is_no_folder_of_a_run_is_refused() {
    let desk = made();
    for file in ["scene.toml", "trajectory.csv", "energy.csv"] {
        let (path, aside) = (desk.path().join(file), desk.path().join("aside"));
        fs::rename(&path, &aside).unwrap();
        let error = Replay::open(desk.path()).unwrap_err();
        assert!(error.to_string().contains(file), "{error}");
        fs::create_dir(&path).unwrap();
        assert!(Replay::open(desk.path()).is_err());
        fs::remove_dir(&path).unwrap();
        fs::rename(&aside, &path).unwrap();
    }
    let is_none = |path: &Path| matches!(Replay::open(path), Err(ReplayError::NotARun(..)));
    assert!(is_none(&desk.path().join("scene.toml")));
    assert!(is_none(&desk.path().join("nowhere")));
    assert!(is_none(&std::env::temp_dir()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_bytes_are_read_or_refused(
        file in 0usize..3,
        bytes in proptest::collection::vec(any::<u8>(), 0..300),
    ) {
        let desk = made_once();
        let files = ["scene.toml", "trajectory.csv", "energy.csv"];
        write_but(&desk, files[file], |_| bytes);
        prop_assert!(Replay::open(desk.path()).is_err());
    }

    #[test]
    fn damaged_rows_are_read_or_refused(
        file in 1usize..3,
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in any::<prop::sample::Index>(),
        is_cut in any::<bool>(),
    ) {
        let desk = made_once();
        let files = ["scene.toml", "trajectory.csv", "energy.csv"];
        write_but(&desk, files[file], |mut bytes| {
            for (at, byte) in &damage {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            if is_cut {
                bytes.truncate(cut.index(bytes.len()));
            }
            bytes
        });
        if let Ok(replay) = Replay::open(desk.path()) {
            prop_assert!(replay.frames.iter().all(|frame| frame.poses.len() == 2));
            prop_assert_eq!(replay.frames.len(), replay.ledger.len());
            let is_finite = |pose: &tumble_io::replay::Pose| pose.position.is_finite();
            prop_assert!(replay.frames.iter().flat_map(|frame| &frame.poses).all(is_finite));
        }
    }
}

/// A copy of a run that is made once.
fn made_once() -> TempDir {
    static MADE: std::sync::OnceLock<TempDir> = std::sync::OnceLock::new();
    let source = MADE.get_or_init(made);
    let desk = tempfile::tempdir().unwrap();
    for file in ["scene.toml", "trajectory.csv", "energy.csv"] {
        fs::copy(source.path().join(file), desk.path().join(file)).unwrap();
    }
    desk
}

fn write_but(desk: &TempDir, file: &str, change: impl FnOnce(Vec<u8>) -> Vec<u8>) {
    let path = desk.path().join(file);
    fs::write(&path, change(fs::read(&path).unwrap())).unwrap();
}

#[test]
fn a_driven_run_has_a_column_for_the_work() {
    let header = |motion: &str| {
        let text = format!("{SCENE}motion = \"{motion}\"\n");
        let source = Source { name: "s.toml".to_owned(), text };
        let loaded = load_text("s", source, Path::new("."), &LoadOptions::default()).unwrap();
        let desk = tempfile::tempdir().unwrap();
        let folder = RunFolder::create(desk.path(), false).unwrap();
        run(loaded, &folder, &mut |_| true).unwrap();
        let replay = Replay::open(desk.path()).unwrap();
        assert_eq!(replay.ledger[0].work, 0.0);
        let rows = fs::read_to_string(desk.path().join("energy.csv")).unwrap();
        rows.lines().next().unwrap().to_owned()
    };
    assert!(header("free").ends_with(",total,residual"));
    assert!(header("fixed").ends_with(",total,residual"));
    assert!(header("prescribed").ends_with(",total,residual,work"));
}
