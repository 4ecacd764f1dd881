//! A run that is moved or copied, with its scene or alone, finds its meshes.

#![allow(clippy::unwrap_used)]

mod common;

use std::fs;

use common::{TETRAHEDRON, TestDir, assert_contains};

/// A project with a scene and its mesh in `proj`, and its run in `proj/run1`.
fn project(mesh: &str) -> TestDir {
    let dir = TestDir::new();
    dir.write("proj/meshes/two.obj", TETRAHEDRON);
    dir.write("outside.obj", TETRAHEDRON);
    let scene = format!("duration = 0.05\n[[body]]\nmesh = \"{mesh}\"\nmass = 1\n");
    dir.write("proj/scene.toml", scene);
    dir.run(&["proj/scene.toml"], "proj/run1");
    dir
}

/// Asserts that the run in `run1` of the folder can be exported, resumed and run again there.
#[track_caller]
fn assert_works_in(dir: &TestDir, folder: &str) {
    let tumble = |args: &[&str]| {
        common::tumble_in(&dir.path(folder), args).expect_status(0);
    };
    tumble(&["export", "run1", "--to", "a.glb"]);
    tumble(&["resume", "run1", "--duration", "0.1"]);
    tumble(&["export", "run1", "--to", "b.glb"]);
    tumble(&["run", "run1/scene.toml", "--out", "again"]);
    let hash = |run: &str| dir.summary(&format!("{folder}/{run}"))["state_hash"].clone();
    assert_eq!(hash("run1"), hash("again"));
}

#[test]
fn a_project_can_be_moved() {
    let dir = project("meshes/two.obj");
    assert_contains(&dir.read("proj/run1/scene.toml"), &["mesh = \"../meshes/two.obj\""]);
    fs::create_dir(dir.path("elsewhere")).unwrap();
    fs::rename(dir.path("proj"), dir.path("elsewhere/proj")).unwrap();
    assert_works_in(&dir, "elsewhere/proj");
    // the files that it writes then name its new place
    let scene = dir.read("elsewhere/proj/run1/scene.toml");
    assert_contains(&scene, &["mesh = \"../meshes/two.obj\"", "elsewhere/proj/meshes/two.obj\""]);
}

#[test]
fn a_run_alone_can_be_moved_while_its_mesh_stays() {
    let dir = project("meshes/two.obj");
    fs::create_dir(dir.path("elsewhere")).unwrap();
    fs::rename(dir.path("proj/run1"), dir.path("elsewhere/run1")).unwrap();
    assert_works_in(&dir, "elsewhere");
    // it has its own copy now
    fs::remove_dir_all(dir.path("proj")).unwrap();
    common::tumble_in(&dir.path("elsewhere"), &["export", "run1", "--to", "c.glb"])
        .expect_status(0);
}

#[test]
fn a_mesh_from_outside_is_copied_into_the_run() {
    let dir = project("../outside.obj");
    fs::remove_file(dir.path("outside.obj")).unwrap();
    fs::create_dir(dir.path("elsewhere")).unwrap();
    fs::rename(dir.path("proj/run1"), dir.path("elsewhere/run1")).unwrap();
    assert_works_in(&dir, "elsewhere");
}

#[test]
fn a_run_with_only_the_absolute_path_of_its_mesh_still_works() {
    let dir = project("meshes/two.obj");
    let scene = dir.read("proj/run1/scene.toml");
    let mesh = dir.path("proj/meshes/two.obj").canonicalize().unwrap();
    let old = |line: &str| match line.split_once(" = ") {
        Some(("mesh", _)) => format!("mesh = {:?}\n", mesh.to_str().unwrap()),
        Some(("mesh_origin", _)) => String::new(),
        _ => format!("{line}\n"),
    };
    dir.write("proj/run1/scene.toml", scene.lines().map(old).collect::<String>());
    assert_works_in(&dir, "proj");
}

#[test]
fn a_changed_or_missing_mesh_is_named_with_its_hashes() {
    let dir = project("meshes/two.obj");
    let scene = dir.read("proj/run1/scene.toml");
    let hash = scene.lines().find_map(|line| line.strip_prefix("mesh_sha256 = \"")).unwrap();
    let hash = hash.trim_end_matches('"');
    let kept = format!("run1/meshes/{hash}.obj");
    dir.write("proj/meshes/two.obj", TETRAHEDRON.replace("v 1 0 0", "v 2 0 0"));
    let calls: [&[&str]; 3] = [
        &["export", "proj/run1", "--to", "a.glb"],
        &["resume", "proj/run1", "--duration", "1"],
        &["run", "proj/run1/scene.toml", "--out", "again"],
    ];
    for call in calls {
        let message = dir.tumble(call).expect_status(2).stderr;
        assert_contains(&message, &["run1/../meshes/two.obj has the hash ", "does not match"]);
        assert_contains(&message, &[hash, &kept]);
    }
    fs::remove_file(dir.path("proj/meshes/two.obj")).unwrap();
    for call in calls {
        let message = dir.tumble(call).expect_status(2).stderr;
        assert_contains(&message, &["two.obj", "no such file", hash, &kept]);
    }
    // the advice helps
    dir.write(&format!("proj/{kept}"), TETRAHEDRON);
    for call in calls {
        dir.tumble(call).expect_status(0);
    }
}

#[test]
fn a_mesh_that_the_user_exchanges_is_not_replaced_by_the_old_one() {
    let dir = project("meshes/two.obj");
    dir.write("other.obj", TETRAHEDRON.replace("v 1 0 0", "v 2 0 0"));
    let set = format!("body.0.mesh={:?}", dir.path("other.obj").to_str().unwrap());
    let call = ["run", "proj/run1/scene.toml", "--set", &set, "--out", "again"];
    let message = dir.tumble(&call).expect_status(2).stderr;
    assert_contains(&message, &["does not match", "other.obj has the hash"]);
}
