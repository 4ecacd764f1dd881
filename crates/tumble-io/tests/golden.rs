//! The built-in scenes come out the same to the last bit, on every machine.
//!
//! These hashes prove nothing about the physics: only that nothing has changed. Renew them when a change of
//! the physics is meant, says so in the CHANGELOG, and `tumble verify` passes; the message of a failure
//! holds the new table.

#![allow(clippy::unwrap_used)]

use tumble_io::scene::{BUILTIN, LoadOptions, load_builtin};

/// Name and state hash after 400 steps.
const GOLDEN: &[(&str, &str)] = &[
    ("task1", "89784919b55608302bf0f2ba8e450a37"),
    ("task2", "166c845789beb0781e3d64d734f8506f"),
    ("task1-cat", "daac09b4740b63aacffb6857aab2708c"),
    ("task2-cat", "bd163607a118cb3d1e7e697b1f3fabfe"),
    ("top", "93d71a947b97faf74eede21faf2f89c2"),
    ("racket", "5675f2f02314daed7f3b503609cf8043"),
    ("coin", "d2853d24762eb76477b5f85f828c3d4c"),
    ("slope", "d4a442a1bee5f295e93a54308ac624f0"),
    ("many", "f497ce1ac531ca7c100043ba0de05c14"),
    ("bounce", "407bca6fa98dd4a0e99dd6d4804d65ce"),
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
                world.forget_scratch();
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
