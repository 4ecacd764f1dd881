//! Prints a line of JSON for each mesh file: `mesh_facts FILE…`.
//!
//! Vertices with identical coordinates are welded, as other readers do, so that the counts of different programs can
//! be compared. `bench/readers/compare.py` does that.

use std::path::Path;

use serde_json::{Value, json};
use tumble::{DVec3, Mesh};
use tumble_io::mesh::{Weld, read_mesh};

fn main() {
    for path in std::env::args().skip(1) {
        let facts = match read_mesh(Path::new(&path), Some(Weld::Within(0.0))) {
            Ok(file) => facts(&file.mesh),
            Err(error) => json!({ "error": error.to_string() }),
        };
        println!("{}", json!({ "file": path, "facts": facts }));
    }
}

/// Counts, the signed volume Σ a·(b × c)/6 and the bounds.
fn facts(mesh: &Mesh) -> Value {
    let corner = |index: u32| mesh.vertices[index as usize];
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))) / 6.0)
        .sum();
    let min = mesh.vertices.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let max = mesh.vertices.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    json!({
        "vertices": mesh.vertices.len(), "triangles": mesh.triangles.len(), "volume": volume,
        "bounds": [min.to_array(), max.to_array()],
    })
}
