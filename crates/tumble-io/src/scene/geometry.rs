//! Builds the [`Shape`] and the mass of a body from its description.

use std::path::Path;
use std::sync::Arc;

use tumble::{MassModel, Mesh, Sampling, Shape, ShapeError, Surface, sphere_union_integrals};

use super::description::{BodyScene, Geometry, MassScene, ShapeScene};
use crate::mesh::{Format, parse_mesh, read_mesh};

const CAT: &[u8] = include_bytes!("../../../../assets/cat.obj");

/// A shape that cannot be made: the key to point at, and what is wrong.
#[derive(Debug)]
pub struct GeometryError {
    /// Key of the body that is to blame.
    pub key: &'static str,
    /// What is wrong and what to do.
    pub message: String,
}

fn blame(key: &'static str, message: impl std::fmt::Display) -> GeometryError {
    GeometryError { key, message: message.to_string() }
}

/// A shape and the mass that goes with it.
#[derive(Clone, Debug)]
pub struct Made {
    /// The shape.
    pub shape: Arc<Shape>,
    /// Total mass (kg).
    pub mass: f64,
}

/// Makes the shape of a body. `folder` is where relative mesh paths start; the mesh's hash is
/// checked against the scene's, if that has one, and written into it.
pub fn make(body: &mut BodyScene, folder: &Path) -> Result<Made, GeometryError> {
    let mut mesh = points_of(&mut body.geometry, folder)?;
    for vertex in &mut mesh.vertices {
        *vertex *= body.scale;
    }
    let bare = matches!(body.geometry, Geometry::Particles(_));
    if let (true, Some(radius)) = (bare, solid_balls(body)) {
        return clump(body, mesh, radius);
    }
    let shape =
        if bare && body.sampling == Sampling::Vertices && body.mass_model == MassModel::Particles {
            Shape::from_particles(&mesh.vertices)
        } else {
            Shape::from_mesh(&mesh, body.sampling, body.mass_model)
        };
    let shape = shape.map_err(|error| blame(guilty_key(body, &error), error))?;
    let mass = mass(body, &mesh, &shape)?;
    Ok(Made { shape: Arc::new(shape), mass })
}

/// The radius of the solid balls (m) that a body consists of, if it does.
fn solid_balls(body: &BodyScene) -> Option<f64> {
    let is_solid = body.mass_model == MassModel::Solid && body.sampling == Sampling::Vertices;
    match body.surface {
        Surface::Spheres { radius } if is_solid => Some(radius),
        _ => None,
    }
}

/// A body of solid balls about its particles; what several of them share weighs once.
fn clump(body: &BodyScene, points: Mesh, radius: f64) -> Result<Made, GeometryError> {
    let places = &points.vertices;
    let union =
        sphere_union_integrals(places, radius).map_err(|error| blame("particle_radius", error))?;
    let gyration = union.inertia() * (1.0 / union.measure);
    let shape = Shape::from_distribution(places, Mesh::default(), union.centre, gyration);
    let shape = shape.map_err(|error| blame(guilty_key(body, &error), error))?;
    let mass = match body.mass {
        MassScene::Particle(mass) => mass * shape.moments().count,
        MassScene::Total(mass) => mass,
        MassScene::Density(density) => density * union.measure,
    };
    Ok(Made { shape: Arc::new(shape), mass })
}

/// The points that a body is made of, before `scale`. Of a mesh, path and hash are filled in.
pub fn points_of(geometry: &mut Geometry, folder: &Path) -> Result<Mesh, GeometryError> {
    match geometry {
        Geometry::Particles(points) => Ok(Mesh { vertices: points.clone(), triangles: Vec::new() }),
        Geometry::Shape(ShapeScene::Primitive(primitive)) => {
            primitive.mesh().map_err(|error| blame("shape", error))
        }
        Geometry::Shape(ShapeScene::Cat) => parse_mesh(Format::Obj, CAT, None, None)
            .map(|file| file.mesh)
            .map_err(|error| blame("shape", error)),
        Geometry::Mesh { path, sha256, weld } => {
            let full = folder.join(&*path);
            let file = read_mesh(&full, *weld).map_err(|error| blame("mesh", error))?;
            if !sha256.is_empty() && *sha256 != file.sha256 {
                let message = format!(
                    "does not match: {} has {}; the mesh is not the one that this scene was made with",
                    full.display(),
                    file.sha256
                );
                return Err(blame("mesh_sha256", message));
            }
            *sha256 = file.sha256;
            *path = std::path::absolute(&full).unwrap_or(full);
            Ok(file.mesh)
        }
    }
}

/// Which key to point at when a shape cannot be made.
fn guilty_key(body: &BodyScene, error: &ShapeError) -> &'static str {
    match error {
        ShapeError::Sample(_) => "sampling",
        ShapeError::Open(_) | ShapeError::Shell(_) => "mass_model",
        ShapeError::TooLarge => "scale",
        _ => match body.geometry {
            Geometry::Mesh { .. } => "mesh",
            Geometry::Shape(_) => "shape",
            Geometry::Particles(_) => "particles",
        },
    }
}

fn mass(body: &BodyScene, mesh: &Mesh, shape: &Shape) -> Result<f64, GeometryError> {
    match body.mass {
        MassScene::Particle(mass) => Ok(mass * shape.moments().count),
        MassScene::Total(mass) => Ok(mass),
        MassScene::Density(density) => {
            let measure = if body.mass_model == MassModel::Shell {
                mesh.shell_integrals().map_err(|error| blame("density", error))?.measure
            } else {
                mesh.solid_integrals().map_err(|error| blame("density", error))?.measure
            };
            Ok(density * measure)
        }
    }
}
