//! The built-in scenes come out the same to the last bit, on every machine.
//!
//! These hashes prove nothing about the physics: only that nothing has changed. Renew them when a change of
//! the physics is meant, says so in the CHANGELOG, and `tumble verify` passes; the message of a failure
//! holds the new table.

#![allow(clippy::unwrap_used)]

use tumble_io::scene::{BUILTIN, LoadOptions, load_builtin};

/// Name and state hash after 400 steps.
const GOLDEN: &[(&str, &str)] = &[
    ("task1", "4f7c2a480a8eb9a72857c2d2f24b4728"),
    ("task2", "0ac15165f8ecddde8665c8cbad1b0e36"),
    ("task1-cat", "e02152de53c556ad27dc8b69dee46138"),
    ("task2-cat", "7ec29e9817f07db613714bf3dda28bc4"),
    ("top", "61369b271758eccfe0d18bf9de54b9a3"),
    ("racket", "16c097355af38265b2142f0e7971e1e5"),
    ("coin", "72036c6bba95b89e226b09915e703e80"),
    ("slope", "e73b1f764afa7900f9ec36bd7f95322d"),
    ("many", "2110779733cd0e2b5a19baacf6b6b0b8"),
    ("bounce", "0e87c3db7f56d54ccf0118070c10cd1f"),
    ("cradle", "35415243dbfb59fa1edf76e207282417"),
    ("dominoes", "54c3c832ca3f2d2d86bb62e60c5d648b"),
    ("stack", "ae90a3fbfee908cac8eaf3068b70e2ab"),
    ("chain", "25dc10ecbba2e0a00f0a30bcdcdf7093"),
    ("cats", "47cad05658f056f6204b70e6aff3ba1b"),
    ("hopper", "cb5916e126d967ed4c2548b4a2ab8a54"),
    ("drum", "8cb11037f0b96ae0a57b714d24623953"),
    ("heap", "47a5a78cb618b98f43822bc3de58b8f4"),
    ("conveyor", "2aff2732915d97a6eafe3639a7280c6c"),
    ("pendulum", "3aeed94d248dbe6deaa4f380b3da41b1"),
    ("double-pendulum", "59702760d50890e025646d267a7b2c21"),
    ("gyroscope", "dc65391027c4c61329f9facf141a5909"),
    ("kapitza", "a60ed8d1872789127ae25f1d43d977e0"),
    ("slider-crank", "c7417d0cda50d1c4afb1cde95438c3d6"),
    ("four-bar", "03fc759954853be771c9e624b85e60c8"),
    ("cradle-strings", "86f731473a9cf0ff3f794e9549d7792d"),
    ("beads", "d1a18c45b262497e5222aeb69be20a27"),
    ("trebuchet", "f5ae6c1c4a4af0d83fc315e5ec3c81eb"),
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
