//! Export as Wavefront OBJ.

use crate::mesh::Mesh;
use crate::solid::Solid;
use std::fmt::Write;

const HEADER: &str = "# a sitting cat: closed surface, y up, facing +z, 2 units tall, centred
# modelled by assets/modeller: cargo run -p tumble-modeller
# licence: MIT OR Apache-2.0";

/// The mesh as OBJ text with up to six decimals per coordinate. The header lists the parts of the model.
pub fn to_obj(mesh: &Mesh, solid: &Solid) -> String {
    let names: Vec<&str> = solid.parts.iter().map(|part| part.name).collect();
    let mut text = format!("{HEADER}\n# parts: {}\no cat\n", names.join(", "));
    for point in &mesh.points {
        let [x, y, z] = point.to_array().map(format_decimal);
        // writing to a string cannot fail
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    text
}

/// Formats a number with up to six decimals, without trailing zeros and without a negative zero.
fn format_decimal(value: f64) -> String {
    let padded = format!("{value:.6}");
    let trimmed = padded.trim_end_matches('0').trim_end_matches('.');
    if trimmed == "-0" { "0".to_string() } else { trimmed.to_string() }
}
