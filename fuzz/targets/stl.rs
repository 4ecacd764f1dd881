//! Parses arbitrary bytes as a mesh of this format. The result is a valid mesh or an error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use tumble_io::mesh::{Format, parse_mesh};

fuzz_target!(|bytes: &[u8]| {
    match parse_mesh(Format::Stl, bytes, None, None) {
        Ok(file) => {
            let count = file.mesh.vertices.len();
            assert!(count > 0);
            assert!(file.mesh.vertices.iter().all(|vertex| vertex.is_finite()));
            assert!(file.mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
