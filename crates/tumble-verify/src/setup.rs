//! Bodies, materials and worlds that several cases share.

use tumble::{
    Body, DMat3, DVec3, Damping, MassModel, Material, Mesh, Primitive, Sampling, Shape, Surface,
    WallPlane, World, WorldBuilder,
};

use crate::check::Error;

/// Magnitude of the gravitational acceleration (m/s²).
pub(crate) const G: f64 = 9.8;

/// The floor y = 0.
pub(crate) const FLOOR: WallPlane = WallPlane { normal: DVec3::Y, offset: 0.0 };

/// Steps a world until `time` (s).
pub(crate) fn step_until(world: &mut World, time: f64) -> Result<(), Error> {
    while world.state().step < (time / world.dt()).round() as u64 {
        world.step()?;
    }
    Ok(())
}

/// A world whose floor y = 0 has this material.
pub(crate) fn world_with_floor(material: Material) -> WorldBuilder {
    World::builder().material(material).wall(FLOOR)
}

/// A material of stiffness `k` (N/m), restitution `e` and coefficient of friction `friction`.
pub(crate) fn material(k: f64, e: f64, friction: f64) -> Material {
    Material {
        collision_stiffness: k,
        damping: Damping::Restitution(e),
        friction_stiffness: friction,
        ..Material::default()
    }
}

/// A single particle of 1 kg at `height` (m) above the floor y = 0.
pub(crate) fn particle(height: f64) -> Result<Body, Error> {
    let shape = Shape::from_particles(&[DVec3::ZERO])?;
    Ok(Body::new(shape).mass(1.0).position(DVec3::Y * height))
}

/// A body of 1 kg with these principal moments (kg·m²) about x, y, z.
pub(crate) fn body_with_moments(moments: DVec3) -> Result<Body, Error> {
    let points = [DVec3::X, -DVec3::X];
    let gyration = DMat3::from_diagonal(moments);
    let shape = Shape::from_distribution(&points, Mesh::default(), DVec3::ZERO, gyration)?;
    Ok(Body::new(shape).mass(1.0))
}

/// A solid ball: one sphere with the inertia 2/5 M R². `radius` in m, `mass` in kg.
pub(crate) fn ball(radius: f64, mass: f64) -> Result<Body, Error> {
    let gyration = DMat3::IDENTITY * (0.4 * radius * radius);
    let shape = Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, gyration)?;
    Ok(Body::new(shape).mass(mass).surface(Surface::Spheres { radius }))
}

/// A solid body whose contact surface is the mesh of a primitive.
pub(crate) fn mesh_body(primitive: Primitive) -> Result<Body, Error> {
    let shape = Shape::from_mesh(&primitive.mesh()?, Sampling::Vertices, MassModel::Solid)?;
    Ok(Body::new(shape).surface(Surface::Mesh))
}
