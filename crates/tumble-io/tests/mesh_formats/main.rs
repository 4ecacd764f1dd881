//! Mesh files of all formats: what is read, and what is refused with which words.
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

/// Reads bytes that must be a mesh.
#[track_caller]
fn good(format: Format, bytes: &[u8]) -> MeshFile {
    parse_mesh(format, bytes, None, None).unwrap_or_else(|error| panic!("{error}"))
}

/// The message for bytes that must be refused.
#[track_caller]
fn bad(format: Format, bytes: &[u8]) -> String {
    match parse_mesh(format, bytes, None, None) {
        Ok(file) => panic!("read as {file:?}"),
        Err(error) => error.to_string(),
    }
}

/// Checks that a message says all of these.
#[track_caller]
fn says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "{message:?} does not say {part:?}");
    }
}

/// Twice the area of all triangles, and six times the volume that they enclose.
fn measures(file: &MeshFile) -> (f64, f64) {
    let corners = |t: &[u32; 3]| t.map(|i| file.mesh.vertices[i as usize]);
    file.mesh.triangles.iter().map(corners).fold((0.0, 0.0), |(area, volume), [a, b, c]| {
        (area + (b - a).cross(c - a).length(), volume + a.dot(b.cross(c)))
    })
}

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}
