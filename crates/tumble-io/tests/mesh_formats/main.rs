//! Mesh readers of all formats: valid files, and the error messages for invalid ones.
#![allow(clippy::unwrap_used)]

mod file;
mod gltf;
mod obj;
mod ply;
mod random;
mod samples;
mod stl;

use glam::DVec3;
use tumble_io::mesh::{Format, MeshFile, parse_mesh};

/// Parses bytes that must be a valid mesh.
#[track_caller]
fn parse_valid(format: Format, bytes: &[u8]) -> MeshFile {
    parse_mesh(format, bytes, None, None).unwrap_or_else(|error| panic!("{error}"))
}

/// Parses bytes that must be rejected and returns the error message.
#[track_caller]
fn parse_invalid(format: Format, bytes: &[u8]) -> String {
    match parse_mesh(format, bytes, None, None) {
        Ok(file) => panic!("not rejected: {file:?}"),
        Err(error) => error.to_string(),
    }
}

/// Checks that a message contains all of these parts.
#[track_caller]
fn assert_contains(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "{message:?} does not contain {part:?}");
    }
}

/// Twice the total area of the triangles, and six times the volume that they enclose.
fn area_and_volume(file: &MeshFile) -> (f64, f64) {
    let corners = |t: &[u32; 3]| t.map(|i| file.mesh.vertices[i as usize]);
    file.mesh.triangles.iter().map(corners).fold((0.0, 0.0), |(area, volume), [a, b, c]| {
        (area + (b - a).cross(c - a).length(), volume + a.dot(b.cross(c)))
    })
}

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}
