//! The built-in scenes come out the same to the last bit, on every machine.
//!
//! These hashes prove nothing about the physics: only that nothing has changed. Renew them when a change of
//! the physics is meant, says so in the CHANGELOG, and `tumble verify` passes; the message of a failure
//! holds the new table.

#![allow(clippy::unwrap_used)]

use tumble_io::scene::{BUILTIN, LoadOptions, load_builtin};

/// Name and state hash after 400 steps.
const GOLDEN: &[(&str, &str)] = &[
    ("task1", "d7b9c01364eda4169b40f3cd30d5b071"),
    ("task2", "a350aa5a52e42bf938c569180f9dbb9e"),
    ("task1-cat", "340d1e93ff70d0b0e4839c96324efaa9"),
    ("task2-cat", "7d90d778bcc521d18b22f8f8a360bcea"),
    ("top", "93d71a947b97faf74eede21faf2f89c2"),
    ("racket", "5675f2f02314daed7f3b503609cf8043"),
    ("coin", "8566f64f0e29a6236e5ce232e5bea251"),
    ("slope", "d4a442a1bee5f295e93a54308ac624f0"),
    ("many", "a35664133f3c493970a74d7bba309517"),
    ("bounce", "a09eb3f422f35331e3d4c6a956b92a5d"),
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
