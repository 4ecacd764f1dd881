//! Builds the [`Shape`] and the mass of a body from its description.

use std::path::Path;
use std::sync::Arc;

use tumble::{MassModel, Mesh, Sampling, Shape, ShapeError, Surface, sphere_union_integrals};

use super::description::{BodyScene, Geometry, MassScene, ShapeScene};
use super::geometry_error::{GeometryError, error};
use super::mesh_file;
use crate::mesh::{Format, parse_mesh};

const CAT: &[u8] = include_bytes!("../../embedded/cat.obj");

/// A shape and its mass.
#[derive(Clone, Debug)]
pub struct ShapeAndMass {
    /// The shape.
    pub shape: Arc<Shape>,
    /// Total mass (kg).
    pub mass: f64,
}

/// Builds the shape of a body, with its own mass properties if it has any. Relative mesh paths start at `folder`. The hash of the mesh is compared with that of the scene, if it has
/// one, and written into the scene.
pub fn build_shape(body: &mut BodyScene, folder: &Path) -> Result<ShapeAndMass, GeometryError> {
    let of_geometry = shape_of_geometry(body, folder)?;
    with_given_mass(body, of_geometry)
}

/// Replaces the centre of mass and the inertia by those that the body has of its own.
fn with_given_mass(body: &BodyScene, built: ShapeAndMass) -> Result<ShapeAndMass, GeometryError> {
    let ShapeAndMass { shape, mass } = built;
    if body.center_of_mass.is_none() && body.inertia.is_none() {
        return Ok(ShapeAndMass { shape, mass });
    }
    let centre = body.center_of_mass.map_or(shape.centre(), |centre| centre * body.scale);
    let gyration = body.inertia.map_or(shape.gyration(), |inertia| inertia * (1.0 / mass));
    let key = if body.inertia.is_some() { "inertia" } else { "center_of_mass" };
    let shape = shape.with_distribution(centre, gyration).map_err(|cause| match cause {
        ShapeError::Impossible { moments } => {
            let [x, y, z] = (moments * mass).to_array();
            let message = format!(
                "is that of no body: its principal moments are {x:.4e}, {y:.4e} and {z:.4e} kg·m², \
                 but each is at least 0 and at most the sum of the others"
            );
            error(key, message)
        }
        ShapeError::NoInertia { .. } if body.inertia.is_none() => {
            error(key, format!("needs `mass` and `inertia` beside it: {cause}"))
        }
        ShapeError::Asymmetric => {
            error(key, "must be symmetric: row i, column j is row j, column i")
        }
        ShapeError::TooLarge => {
            error(key, "is so large that the motion cannot be computed in finite numbers")
        }
        _ => error(key, format!("cannot work: {cause}")),
    })?;
    Ok(ShapeAndMass { shape: Arc::new(shape), mass })
}

fn shape_of_geometry(body: &mut BodyScene, folder: &Path) -> Result<ShapeAndMass, GeometryError> {
    let mut mesh = load_points(&mut body.geometry, folder)?;
    for vertex in &mut mesh.vertices {
        *vertex *= body.scale;
    }
    let is_point_set = matches!(body.geometry, Geometry::Particles(_));
    if let (true, Some(radius)) = (is_point_set, solid_sphere_radius(body)) {
        return clump(body, mesh, radius);
    }
    let shape = if is_point_set
        && body.sampling == Sampling::Vertices
        && body.mass_model == MassModel::Particles
    {
        Shape::from_particles(&mesh.vertices)
    } else {
        Shape::from_mesh(&mesh, body.sampling, body.mass_model)
    };
    let shape = shape.map_err(|cause| match cause {
        ShapeError::Open(_) => error("mass_model", format!("{cause}{}", hint(body))),
        _ => error(key_of_error(body, &cause), cause),
    })?;
    let mass = mass(body, &mesh, &shape)?;
    Ok(ShapeAndMass { shape: Arc::new(shape), mass })
}

/// The radius (m) of the solid spheres that a body consists of, if it does.
fn solid_sphere_radius(body: &BodyScene) -> Option<f64> {
    let is_solid = body.mass_model == MassModel::Solid && body.sampling == Sampling::Vertices;
    match body.surface {
        Surface::Spheres { radius } if is_solid => Some(radius),
        _ => None,
    }
}

/// A body of solid spheres about its particles; where spheres overlap, the mass counts once.
fn clump(body: &BodyScene, points: Mesh, radius: f64) -> Result<ShapeAndMass, GeometryError> {
    let places = &points.vertices;
    let union =
        sphere_union_integrals(places, radius).map_err(|cause| error("particle_radius", cause))?;
    let gyration = union.inertia() * (1.0 / union.measure);
    let shape = Shape::from_distribution(places, Mesh::default(), union.centre, gyration);
    let shape = shape.map_err(|cause| error(key_of_error(body, &cause), cause))?;
    let mass = match body.mass {
        MassScene::Particle(mass) => mass * shape.moments().count,
        MassScene::Total(mass) => mass,
        MassScene::Density(density) => density * union.measure,
    };
    Ok(ShapeAndMass { shape: Arc::new(shape), mass })
}

/// The points of a body, before `scale`. Fills in what is known of a mesh file once it is read.
pub fn load_points(geometry: &mut Geometry, folder: &Path) -> Result<Mesh, GeometryError> {
    match geometry {
        Geometry::Particles(points) => Ok(Mesh { vertices: points.clone(), triangles: Vec::new() }),
        Geometry::Shape(ShapeScene::Primitive(primitive)) => {
            primitive.mesh().map_err(|cause| error("shape", cause))
        }
        Geometry::Shape(ShapeScene::Cat) => parse_mesh(Format::Obj, CAT, None, None)
            .map(|file| file.mesh)
            .map_err(|cause| error("shape", cause)),
        Geometry::Mesh(mesh) => mesh_file::load(mesh, folder),
    }
}

/// Where to learn more about the mesh file of a body, for messages.
pub fn hint(body: &BodyScene) -> String {
    let Geometry::Mesh(mesh) = &body.geometry else { return String::new() };
    format!("; `tumble info {}` says where, and which key helps", mesh.path.display())
}

/// The key that causes a shape error.
fn key_of_error(body: &BodyScene, error: &ShapeError) -> &'static str {
    match error {
        ShapeError::Sample(_) => "sampling",
        ShapeError::Open(_) | ShapeError::Shell(_) | ShapeError::Impossible { .. } => "mass_model",
        ShapeError::TooLarge => "scale",
        _ => match body.geometry {
            Geometry::Mesh(_) => "mesh",
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
                mesh.shell_integrals().map_err(|cause| error("density", cause))?.measure
            } else {
                let solid = mesh.solid_integrals();
                let message = |cause| error("density", format!("{cause}{}", hint(body)));
                solid.map_err(message)?.measure
            };
            Ok(density * measure)
        }
    }
}
