//! Random commands in random order: each is executed or refused with a reason.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::time::Duration;

use proptest::prelude::*;
use tumble_io::scene::{LoadOptions, Loaded, Source, load_text};
use tumble_view::{Command, Session, frame, header};

const SCENE: &str = "
dt = 1e-3
[collision]
restitution = 0.6
friction_stiffness = 0.4
[box]
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[[wall]]
normal = [0.0, 1.0, 0.0]
offset = -0.9
[[body]]
shape = \"sphere\"
subdivisions = 0
position = [0.0, -0.75, 0.0]
initial_velocity = [3.0, -1.0, 0.5]
[[body]]
shape = \"box\"
position = [0.3, 0.2, 0.0]
copies = { count = [2, 1, 1], spacing = [0.4, 0, 0], seed = 3 }
";

fn load(text: &str) -> Loaded {
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    load_text("test", source, Path::new("."), &LoadOptions::default()).unwrap()
}

fn key() -> impl Strategy<Value = String> {
    let known = prop::sample::select(vec![
        "dt",
        "gravity",
        "gravity.1",
        "integrator",
        "energy_tolerance",
        "velocity_damping_stiffness",
        "collision.collision_stiffness",
        "collision.restitution",
        "collision.collision_damping",
        "collision.friction_stiffness",
        "collision",
        "box.min.0",
        "box.max",
        "box.open",
        "wall",
        "wall.offset",
        "wall.0.normal",
        "wall.0.friction_stiffness",
        "body.scale",
        "body.0.mass",
        "body.1.density",
        "body.position.1",
        "body.1.position",
        "body.0.initial_velocity",
        "body.initial_angular_velocity.2",
        "body.1.copies.count.0",
        "body.0.shape",
        "body.0.subdivisions",
        "body.0.particles",
        "body.0",
        "body",
        "duration",
        "output.interval",
    ]);
    prop_oneof![9 => known.prop_map(str::to_owned), 1 => "[a-z0-9.]{1,9}"]
}

fn value() -> impl Strategy<Value = String> {
    let number = || {
        prop_oneof![
            5 => (-4.0..4.0).prop_map(|x: f64| format!("{x:?}")),
            3 => (-6.0..6.0).prop_map(|x: f64| format!("{:?}", 10f64.powf(x))),
            2 => (-2..6).prop_map(|x: i32| x.to_string()),
        ]
    };
    let unusual = prop::sample::select(vec![
        "null",
        "true",
        "[]",
        "0",
        "1e300",
        "-1e300",
        "\"euler\"",
        "\"splitting\"",
        "\"cat\"",
        "\"knot\"",
        "[\"+y\"]",
        "[\"-x\",\"+x\"]",
        "[[0,0,0],[0.1,0,0]]",
    ]);
    prop_oneof![
        5 => number(),
        2 => prop::collection::vec(number(), 3).prop_map(|v| format!("[{}]", v.join(","))),
        2 => unusual.prop_map(str::to_owned),
    ]
}

fn message() -> impl Strategy<Value = String> {
    let simple = prop::sample::select(vec!["play", "pause", "step", "reset", "save", "release"]);
    prop_oneof![
        4 => simple.prop_map(|kind| format!("{{\"type\":\"{kind}\"}}")),
        6 => (key(), value())
            .prop_map(|(k, v)| format!("{{\"type\":\"set\",\"key\":\"{k}\",\"value\":{v}}}")),
        1 => value().prop_map(|v| format!("{{\"type\":\"speed\",\"value\":{v}}}")),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn any_sequence_of_commands_is_executed_or_refused(messages in prop::collection::vec(message(), 1..25)) {
        let mut session = Session::new(load(SCENE)).unwrap();
        for message in messages {
            let Ok(command) = Command::parse(&message) else { continue };
            let before = (session.revision(), session.world().state().clone());
            let residual = session.world().energy().total() - session.reference_energy();
            let result = session.execute(&command);
            if matches!(command, Command::Set(_)) && session.error().is_none() {
                let after = session.world().energy().total() - session.reference_energy();
                let scale = session.world().energy().total().abs() + session.reference_energy().abs();
                prop_assert!((after - residual).abs() <= 1e-9 * (1.0 + scale), "{message}");
            }
            match result {
                // the saved text is a valid scene
                Ok(Some(toml)) => { load(&toml); }
                Ok(None) => {}
                Err(reason) => {
                    prop_assert!(!reason.is_empty());
                    prop_assert_eq!(before.0, session.revision(), "{}", message);
                    if session.error().is_none() {
                        prop_assert_eq!(&before.1, session.world().state(), "{}", message);
                    }
                }
            }
            session.add_elapsed(Duration::from_millis(16));
            let mut calls = 0;
            session.advance(&mut || { calls += 1; calls < 3 });
            let header: serde_json::Value = serde_json::from_str(&header::json(&session)).unwrap();
            prop_assert_eq!(header["bodies"].as_array().unwrap().len(), session.world().body_count());
            let size = 104 + 88 * session.world().body_count();
            prop_assert_eq!(frame::record(&session).len(), size);
        }
        // a reset always recovers
        session.execute(&Command::Reset).unwrap();
        prop_assert_eq!((session.world().time(), session.error()), (0.0, None));
    }
}
