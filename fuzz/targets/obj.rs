//! Any bytes as a mesh of this format: a mesh that keeps its promises, or an error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use tumble_io::mesh::{Format, Repair, parse_mesh, prepare};

fuzz_target!(|bytes: &[u8]| {
    match parse_mesh(Format::Obj, bytes, None, None) {
        Ok(file) => {
            let count = file.mesh.vertices.len();
            assert!(count > 0);
            assert!(file.mesh.vertices.iter().all(|vertex| vertex.is_finite()));
            assert!(file.mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count));
            let _ = prepare(&file.mesh, Repair::Close);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
