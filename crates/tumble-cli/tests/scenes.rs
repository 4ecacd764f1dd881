//! `tumble scenes`: lists, prints and runs every built-in scene.

#![allow(clippy::unwrap_used)]

mod common;

use common::{TestDir, assert_contains};

#[test]
fn every_scene_can_be_printed_to_a_file_and_run() {
    let dir = TestDir::new();
    let list = dir.tumble(&["scenes"]).expect_status(0);
    assert_eq!(list.stderr, "");
    let names: Vec<&str> =
        list.stdout.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    assert!(names.contains(&"task1") && names.contains(&"task2"));
    for name in names {
        let line = list.stdout.lines().find(|line| line.starts_with(name)).unwrap();
        assert!(line.len() > name.len() + 10, "{name} has no description");
        let text = dir.tumble(&["scenes", name]).expect_status(0).stdout;
        dir.write(&format!("{name}.toml"), &text);
        // the file and the built-in scene give the same results
        let file = format!("{name}.toml");
        let a = dir.run(&[&file, "--duration", "0.02"], &format!("{name}-a"));
        let b = dir.run(&[name, "--duration", "0.02"], &format!("{name}-b"));
        assert_eq!(a["state_hash"], b["state_hash"], "{name}");
    }
}

#[test]
fn an_unknown_scene_is_status_2_with_a_suggestion() {
    let dir = TestDir::new();
    let outcome = dir.tumble(&["scenes", "rackt"]).expect_status(2);
    assert_contains(&outcome.stderr, &["rackt", "did you mean `racket`?"]);
    let outcome = dir.tumble(&["scenes", "zzzzzz"]).expect_status(2);
    assert_contains(&outcome.stderr, &["the built-in scenes are task1"]);
}
