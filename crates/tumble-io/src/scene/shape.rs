//! Reads a built-in shape: `shape` and the keys of its dimensions.

use tumble::Primitive;

use super::description::ShapeScene;
use super::reader::{Range, Reader};

/// All keys of the built-in shapes.
pub const SHAPE_KEYS: [&str; 12] = [
    "radius",
    "subdivisions",
    "size",
    "divisions",
    "height",
    "segments",
    "tube_radius",
    "bottom_radius",
    "length",
    "bar_radius",
    "width",
    "thickness",
];

/// Reads `shape = "NAME"` and the keys that this shape has.
pub fn shape_scene(reader: &Reader) -> Option<ShapeScene> {
    let mut names = Primitive::NAMES.to_vec();
    names.push("cat");
    let mut primitive = match reader.choice("shape", &names)? {
        "cat" => return Some(ShapeScene::Cat),
        name => Primitive::from_name(name)?,
    };
    let length = |key, target: &mut f64| {
        *target = reader.number(key, Range::Positive).unwrap_or(*target);
    };
    let count = |key, target: &mut u32, most| {
        *target = reader.integer(key, 0, most).map_or(*target, |n| n as u32);
    };
    match &mut primitive {
        Primitive::Sphere { radius, subdivisions } => {
            length("radius", radius);
            count("subdivisions", subdivisions, 9);
        }
        Primitive::Box { size, divisions } => {
            *size = reader.vector("size").unwrap_or(*size);
            count("divisions", divisions, 1000);
        }
        Primitive::Cylinder { radius, height, segments }
        | Primitive::Capsule { radius, height, segments } => {
            length("radius", radius);
            length("height", height);
            count("segments", segments, 10_000);
        }
        Primitive::Torus { radius, tube_radius, segments }
        | Primitive::Knot { radius, tube_radius, segments } => {
            length("radius", radius);
            length("tube_radius", tube_radius);
            count("segments", segments, 10_000);
        }
        Primitive::Tube { radius, bottom_radius, height, thickness, segments } => {
            length("radius", radius);
            *bottom_radius = *radius;
            length("bottom_radius", bottom_radius);
            length("height", height);
            length("thickness", thickness);
            count("segments", segments, 10_000);
        }
        Primitive::Dumbbell { radius, length: long, bar_radius, segments } => {
            length("radius", radius);
            length("length", long);
            length("bar_radius", bar_radius);
            count("segments", segments, 10_000);
        }
        Primitive::THandle { length: long, width, thickness, divisions } => {
            length("length", long);
            length("width", width);
            length("thickness", thickness);
            count("divisions", divisions, 1000);
        }
        Primitive::Tetrahedron { size } => length("size", size),
    }
    Some(ShapeScene::Primitive(primitive))
}
