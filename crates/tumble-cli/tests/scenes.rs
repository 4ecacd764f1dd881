//! `tumble scenes`, and every built-in scene from the shell to a file and back.

#![allow(clippy::unwrap_used)]

mod common;

use common::{Desk, says};

#[test]
fn every_scene_prints_saves_and_runs() {
    let desk = Desk::new();
    let list = desk.tumble(&["scenes"]).ends_with(0);
    assert_eq!(list.err, "");
    let names: Vec<&str> =
        list.out.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    assert!(names.contains(&"task1") && names.contains(&"task2"));
    for name in names {
        let line = list.out.lines().find(|line| line.starts_with(name)).unwrap();
        assert!(line.len() > name.len() + 10, "{name} has no description");
        let text = desk.tumble(&["scenes", name]).ends_with(0).out;
        desk.write(&format!("{name}.toml"), &text);
        // the file and the built-in one are the same scene
        let file = format!("{name}.toml");
        let a = desk.run(&[&file, "--duration", "0.02"], &format!("{name}-a"));
        let b = desk.run(&[name, "--duration", "0.02"], &format!("{name}-b"));
        assert_eq!(a["state_hash"], b["state_hash"], "{name}");
    }
}

#[test]
fn an_unknown_scene_is_status_2_with_a_suggestion() {
    let desk = Desk::new();
    let said = desk.tumble(&["scenes", "rackt"]).ends_with(2);
    says(&said.err, &["rackt", "did you mean `racket`?"]);
    let said = desk.tumble(&["scenes", "zzzzzz"]).ends_with(2);
    says(&said.err, &["the built-in scenes are task1"]);
}
