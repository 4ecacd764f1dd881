//! Joints and loads, against closed forms and the Runge–Kutta method for the equations of each mechanism in its own coordinates.

mod gyroscope;
mod loads;
mod mechanisms;
mod pendulums;

use tumble::{Body, DMat3, DQuat, DVec3, Mesh, Shape, World, WorldBuilder};

use crate::check::Error;

pub(crate) use gyroscope::GYROSCOPE;
pub(crate) use loads::{DRIVEN, FRICTION, ORBIT};
pub(crate) use mechanisms::{CHAIN, FOUR_BAR, SLIDER_CRANK};
pub(crate) use pendulums::{DOUBLE, FOUCAULT, KAPITZA, PENDULUM, SPHERICAL};

/// Magnitude of gravity (m/s²).
const G: f64 = 9.81;

fn world(dt: f64) -> WorldBuilder {
    World::builder().dt(dt).gravity(DVec3::NEG_Y * G)
}

/// A point mass of `mass` (kg).
fn point(name: &str, mass: f64, at: DVec3) -> Result<Body, Error> {
    Ok(Body::new(Shape::from_particles(&[DVec3::ZERO])?).name(name).mass(mass).position(at))
}

/// A body of `mass` (kg) with these principal moments (kg·m²) about x, y, z.
fn rigid(name: &str, mass: f64, moments: DVec3, at: DVec3) -> Result<Body, Error> {
    let gyration = DMat3::from_diagonal(moments / mass);
    let shape = Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, gyration)?;
    Ok(Body::new(shape).name(name).mass(mass).position(at))
}

/// A thin bar of `mass` (kg) between two points in the plane z = 0; its own x axis is along it.
fn bar(name: &str, mass: f64, from: DVec3, to: DVec3) -> Result<Body, Error> {
    let length = (to - from).length();
    let across = mass * length * length / 12.0;
    let body = rigid(name, mass, DVec3::new(1e-3 * across, across, across), 0.5 * (from + to))?;
    Ok(body.orientation(DQuat::from_rotation_arc(DVec3::X, (to - from) / length)))
}

/// The extrapolation of results of second order with dt and dt/2 to dt = 0.
fn richardson(coarse: f64, fine: f64) -> f64 {
    (4.0 * fine - coarse) / 3.0
}
