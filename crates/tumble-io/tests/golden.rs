//! The built-in scenes come out the same to the last bit, on every machine.
//!
//! These hashes prove nothing about the physics: only that nothing has changed. Renew them when a change of
//! the physics is meant, says so in the CHANGELOG, and `tumble verify` passes; the message of a failure
//! holds the new table.

#![allow(clippy::unwrap_used)]

use tumble_io::scene::{BUILTIN, LoadOptions, load_builtin};

/// Name and state hash after 400 steps.
const GOLDEN: &[(&str, &str)] = &[
    ("task1", "0250c4d3c6675bea0b46b3f629238c64"),
    ("task2", "92ff8a894b7ff117a3fda6fe11033c6d"),
    ("task1-cat", "daac09b4740b63aacffb6857aab2708c"),
    ("task2-cat", "bd163607a118cb3d1e7e697b1f3fabfe"),
    ("top", "52f8dfbb3e0c7755e0d864cdee8d6be1"),
    ("racket", "58f87ebe4bfc4d004dcd914db700c9f1"),
    ("coin", "c3c3e549af7b69b1f155ebdf005b3586"),
    ("slope", "d4a442a1bee5f295e93a54308ac624f0"),
    ("many", "c5ae10e078e1e8c216842acd9aae3cbb"),
    ("bounce", "5a31c4305bd738cbe5e3ce90668a2d0c"),
    ("cradle", "a270b7c451d67f167046f2674db036e8"),
    ("dominoes", "92abd8debae3e99409c4ae50b30c13d2"),
    ("stack", "45bf2aa35ee33a68387a30935c04e6e7"),
    ("chain", "787cabe1315d4e62c19900796d9a4bb2"),
    ("cats", "44eb90ccb827df45f1ce9f033bce32d0"),
    ("hopper", "b31a1d2bcd5b69a9a456be63c726aceb"),
    ("drum", "b7a6bccea27df9685fafab57e2bf7d3a"),
    ("conveyor", "b46d2f8130de83e8e95598fa8c15a450"),
];

#[test]
fn the_built_in_scenes_are_what_they_were() {
    let found: Vec<(&str, String)> = BUILTIN
        .iter()
        .map(|scene| {
            let mut world =
                load_builtin(scene.name, &LoadOptions::default()).unwrap().unwrap().world;
            for _ in 0..400 {
                // what may be forgotten must not matter
                world.clear_scratch();
                world.step().unwrap();
            }
            (scene.name, world.state().hash())
        })
        .collect();
    let same = found.len() == GOLDEN.len()
        && found.iter().zip(GOLDEN).all(|(f, g)| f.0 == g.0 && f.1 == g.1);
    let table: String = found.iter().map(|(n, h)| format!("    (\"{n}\", \"{h}\"),\n")).collect();
    assert!(
        same,
        "states differ from the golden ones; if that is meant, the table is now\n{table}"
    );
}
