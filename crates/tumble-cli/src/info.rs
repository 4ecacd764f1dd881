//! `tumble info`: prints the properties of a mesh.

use std::path::PathBuf;

use clap::Args;
use tumble::{DVec3, MassModel, Sampling, Shape};
use tumble_io::mesh::{MeshFile, read_mesh};

use crate::failure::{Failure, print};
use crate::format::{columns, count, number};

#[derive(Args)]
#[command(after_help = "Mass, centre and moments are those of equal particles at the vertices.")]
pub struct InfoArgs {
    /// Mesh file: .obj, .stl, .ply, .gltf or .glb
    mesh: PathBuf,
    /// Factor for all coordinates
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR")]
    scale: f64,
    /// Mass of one particle (kg)
    #[arg(long, default_value_t = 1.0, value_name = "KG")]
    particle_mass: f64,
    /// Whether to merge vertices with the same coordinates [default: true for .stl, .gltf and .glb]
    #[arg(long, value_name = "true|false")]
    weld: Option<bool>,
}

pub fn info(args: &InfoArgs) -> Result<(), Failure> {
    for (name, value) in [("--scale", args.scale), ("--particle-mass", args.particle_mass)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Failure::call(&format!("{name} must be above 0, but is {value}")));
        }
    }
    let mut file = read_mesh(&args.mesh, args.weld).map_err(|error| Failure::call(&error))?;
    for vertex in &mut file.mesh.vertices {
        *vertex *= args.scale;
    }
    let shape = Shape::from_mesh(&file.mesh, Sampling::Vertices, MassModel::Particles)
        .map_err(|error| Failure::call(&error))?;
    print(&columns(&rows(&file, &shape, args.particle_mass)))
}

fn rows(file: &MeshFile, shape: &Shape, particle_mass: f64) -> Vec<(&'static str, String)> {
    let mesh = &file.mesh;
    let mass = particle_mass * shape.moments().count;
    let infinite = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (min, max) = mesh.vertices.iter().fold(infinite, |(min, max), &v| (min.min(v), max.max(v)));
    let axes = shape.principal().axes;
    let moments = shape.principal().moments * mass;
    let objects = if file.object_count == 1 { "object" } else { "objects" };
    let mut rows = vec![
        ("file", format!("{}, {} {objects}", file.format, file.object_count)),
        ("particles", particles(file)),
        ("triangles", count(mesh.triangles.len() as u64)),
        ("mass", format!("{} kg ({} kg per particle)", number(mass), number(particle_mass))),
        ("centre of mass", format!("{} m", vector(shape.centre()))),
        ("size", format!("{} m", vector(max - min))),
        ("bounds", format!("{} to {} m", vector(min), vector(max))),
        ("bounding radius", format!("{} m about the centre of mass", number(shape.radius()))),
        ("principal moments", format!("{} kg·m²", vector(moments))),
        (
            "principal axes",
            format!("{}, {}, {}", vector(axes.x_axis), vector(axes.y_axis), vector(axes.z_axis)),
        ),
        ("rotational axes", shape.principal().rotation_count().to_string()),
    ];
    match mesh.solid_integrals() {
        Ok(solid) => {
            rows.push(("watertight", "yes".to_owned()));
            rows.push(("volume", format!("{} m³", number(solid.measure))));
        }
        Err(why) => rows.push(("watertight", format!("no: {why}"))),
    }
    if let Ok(shell) = mesh.shell_integrals() {
        rows.push(("surface", format!("{} m²", number(shell.measure))));
    }
    rows.push(("sha256", file.sha256.clone()));
    rows
}

fn particles(file: &MeshFile) -> String {
    let kept = file.mesh.vertices.len();
    let merged = file.file_vertex_count - kept;
    let all = count(kept as u64);
    if merged > 0 {
        {
            let duplicates = if merged == 1 { "duplicate" } else { "duplicates" };
            format!("{all} ({} {duplicates} merged)", count(merged as u64))
        }
    } else {
        all
    }
}

fn vector(v: DVec3) -> String {
    format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
}
