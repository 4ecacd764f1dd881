//! One `[[body]]`, key by key.

use std::path::PathBuf;

use tumble::{DMat3, DVec3, MassModel, Sampling};

use super::common::{material, orientation};
use super::description::{BodyScene, Copies, Geometry, MASS_MODELS, MassScene, MeshScene};
use super::motion::motion;
use super::problem::Problem;
use super::reader::{Range, Reader};
use super::shape::{SHAPE_KEYS, shape_scene};
use super::surface::surface;
use crate::mesh::{Repair, Weld};

/// Keys that give the geometry; exactly one is needed.
const GEOMETRY_KEYS: [&str; 3] = ["mesh", "shape", "particles"];

/// Keys that give the mass; only one may be given.
pub const MASS_KEYS: [&str; 3] = ["particle_mass", "mass", "density"];

/// The largest number of characters in a name.
const MAX_NAME_LENGTH: usize = 200;

/// The largest number of bodies in a scene.
pub const MAX_COPIES: u64 = 1_000_000;

/// Reads body number `index`. Invalid values are replaced by defaults.
pub fn body(reader: Reader, index: usize) -> BodyScene {
    let geometry = geometry(&reader);
    let name = match reader.string("name") {
        Some("") => {
            reader.problem("name", "must not be empty");
            String::new()
        }
        // a line of trajectory.csv is a row
        Some(name) if name.contains(char::is_control) => {
            reader.problem("name", "must not contain line breaks or other control characters");
            name.to_owned()
        }
        Some(name) if name.chars().nth(MAX_NAME_LENGTH).is_some() => {
            reader.problem("name", format!("must have at most {MAX_NAME_LENGTH} characters"));
            String::new()
        }
        Some(name) => name.to_owned(),
        None => format!("body {index}"),
    };
    let velocity = reader.vector("initial_velocity");
    let angular_velocity = reader.vector("initial_angular_velocity");
    let starts = [("initial_velocity", velocity), ("initial_angular_velocity", angular_velocity)];
    let starts = starts.map(|(key, start)| (key, start.unwrap_or(DVec3::ZERO)));
    let body = BodyScene {
        name,
        scale: reader.number("scale", Range::Positive).unwrap_or(1.0),
        sampling: sampling(&reader),
        mass_model: mass_model(&reader),
        mass: mass(&reader),
        center_of_mass: reader.vector("center_of_mass"),
        inertia: inertia(&reader),
        position: reader.vector("position"),
        orientation: orientation(&reader),
        initial_velocity: velocity,
        initial_angular_velocity: angular_velocity,
        material: material(&reader),
        surface: surface(&reader, geometry.as_ref()),
        motion: motion(&reader, starts),
        copies: reader.table("copies").and_then(copies),
        geometry: geometry.unwrap_or(Geometry::Particles(vec![DVec3::ZERO])),
    };
    reader.finish();
    body
}

fn geometry(reader: &Reader) -> Option<Geometry> {
    match reader.only_one(&GEOMETRY_KEYS) {
        Some("mesh") => {
            let weld = reader.switch_or_number(
                "weld",
                Range::NotNegative,
                "a length in the unit of the file",
            );
            let weld = weld.map(|value| value.map_or_else(Weld::Within, Weld::from));
            let repair = reader.choice("mesh_repair", &Repair::NAMES).and_then(Repair::from_name);
            let repair = repair.unwrap_or_default();
            let sha256 = reader.string("mesh_sha256").unwrap_or_default().to_lowercase();
            let origin = reader.string("mesh_origin").map(PathBuf::from);
            let path = PathBuf::from(reader.string("mesh")?);
            let mesh = MeshScene { path, origin, sha256, weld, repair, ..MeshScene::default() };
            Some(Geometry::Mesh(mesh))
        }
        Some("shape") => {
            let shape = shape_scene(reader).map(Geometry::Shape);
            // the keys of an unknown shape cannot be checked
            if shape.is_none() {
                reader.mark_known(&SHAPE_KEYS);
            }
            shape
        }
        Some(_) => reader.points("particles").map(Geometry::Particles),
        None => {
            reader.mark_known(&SHAPE_KEYS);
            reader.mark_known(&["weld", "mesh_repair", "mesh_sha256", "mesh_origin"]);
            let message = "needs one of `mesh = \"FILE\"`, `shape = \"NAME\"` or `particles = [[x, y, z], …]`";
            let problem = Problem::new(reader.place_of(""), reader.key(""), message);
            reader.missing(&GEOMETRY_KEYS, problem);
            None
        }
    }
}

fn sampling(reader: &Reader) -> Sampling {
    let choice = reader.choice("sampling", &["vertices", "surface", "volume"]);
    let spacing = reader.number("spacing", Range::Positive);
    if let Some(kind @ ("surface" | "volume")) = choice {
        if !reader.has("spacing") {
            let message = format!("\"{kind}\" needs `spacing`, the distance between particles (m)");
            let problem =
                Problem::new(reader.place_of("sampling"), reader.key("sampling"), message);
            reader.missing(&["spacing"], problem);
        }
        let spacing = spacing.unwrap_or(1.0);
        return if kind == "surface" {
            Sampling::Surface { spacing }
        } else {
            Sampling::Volume { spacing }
        };
    }
    if reader.has("spacing") {
        reader.problem("spacing", "only goes with sampling = \"surface\" or \"volume\"");
    }
    Sampling::Vertices
}

fn mass_model(reader: &Reader) -> MassModel {
    let choice = reader.choice("mass_model", &MASS_MODELS.map(|(name, _)| name));
    MASS_MODELS.iter().find(|(name, _)| Some(*name) == choice).map_or(MassModel::default(), |m| m.1)
}

fn mass(reader: &Reader) -> MassScene {
    reader.only_one(&MASS_KEYS);
    let particle = reader.number("particle_mass", Range::Positive).map(MassScene::Particle);
    let total = reader.number("mass", Range::Positive).map(MassScene::Total);
    let density = reader.number("density", Range::Positive).map(MassScene::Density);
    particle.or(total).or(density).unwrap_or(MassScene::Particle(1.0))
}

/// `inertia`: rows of a tensor, which needs `mass`.
fn inertia(reader: &Reader) -> Option<DMat3> {
    let rows = reader.matrix("inertia");
    if reader.has("inertia") && !reader.has("mass") {
        let message = match MASS_KEYS.iter().find(|key| reader.has(key)) {
            Some(key) => format!("only goes with `mass` (kg), but the mass is given by `{key}`"),
            None => "needs `mass` (kg), the mass of the body that has this inertia".to_owned(),
        };
        let place = reader.place_of("inertia");
        reader.missing(&["mass"], Problem::new(place, reader.key("inertia"), message));
    }
    rows.map(|rows| DMat3::from_cols_array_2d(&rows).transpose())
}

fn copies(reader: Reader) -> Option<Copies> {
    let count = reader.numbers::<3>("count", Range::Positive);
    let spacing = reader.vector("spacing");
    let seed = reader.integer("seed", 0, i64::MAX).map(|seed| seed as u64);
    for key in ["count", "spacing"] {
        reader.need(key, "is missing: copies need `count` and `spacing`, each [x, y, z]");
    }
    let count = count.filter(|count| {
        let whole = count.iter().all(|n| n.fract() == 0.0);
        let total: f64 = count.iter().product();
        if !whole || total > MAX_COPIES as f64 {
            let message = format!("must hold whole numbers whose product is at most {MAX_COPIES}");
            reader.problem("count", message);
        }
        whole && total <= MAX_COPIES as f64
    });
    reader.finish();
    Some(Copies { count: count?.map(|n| n as u32), spacing: spacing?, seed })
}
