//! The built-in scenes come out the same to the last bit, on every machine.
//!
//! These hashes prove nothing about the physics: only that nothing has changed. Renew them when a change of
//! the physics is meant, says so in the CHANGELOG, and `tumble verify` passes; the message of a failure
//! holds the new table.

#![allow(clippy::unwrap_used)]

use tumble_io::scene::{BUILTIN, LoadOptions, load_builtin};

/// Name and state hash after 400 steps.
const GOLDEN: &[(&str, &str)] = &[
    ("task1", "162106944c9a2cc1adaeaf668f2a96bd"),
    ("task2", "b8b9369ae573bdbdf32b3740f228c13e"),
    ("task1-cat", "8accbc5685a98681f1d8a32c8d86afdb"),
    ("task2-cat", "b8d48a49af920d5119f884d44603fe4b"),
    ("top", "93d71a947b97faf74eede21faf2f89c2"),
    ("racket", "5675f2f02314daed7f3b503609cf8043"),
    ("coin", "3dfb3d66d04e7b60db2e869d05186288"),
    ("slope", "d4a442a1bee5f295e93a54308ac624f0"),
    ("many", "aa76daacf816bfab2f4137fb5d62214c"),
    ("bounce", "b87477dcf70b7b6ca2efa4efc2d3be57"),
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
