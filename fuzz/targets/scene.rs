//! Loads arbitrary text as a scene. The result is a world that can be stepped, or an error.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use tumble_io::scene::{LoadOptions, Source, load_text};

fuzz_target!(|text: &str| {
    let source = Source { name: "fuzz.toml".to_owned(), text: text.to_owned() };
    match load_text("fuzz", source, Path::new("/nowhere"), &LoadOptions::default()) {
        Ok(mut loaded) => {
            let world = &mut loaded.world;
            let particles: usize = world.bodies().map(|body| body.particle_count()).sum();
            if particles > 10_000 {
                return;
            }
            for _ in 0..2 {
                // a state that is not finite must be reported as an error
                if world.step().is_err() {
                    return;
                }
                assert!(world.bodies().all(|body| body.position().is_finite()));
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
