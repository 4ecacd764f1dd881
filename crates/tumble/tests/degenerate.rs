//! Bodies without inertia about some axis: results are finite, and energy and spin stay bounded.
#![allow(clippy::unwrap_used)]

use tumble::{Body, DVec3, Integrator, Material, Shape, WallBox, World};

/// Two seconds of a throw in the arena, for a body with these particles of 1 kg each. `energy_grows` is the allowed
/// relative growth of mechanical energy.
fn bounce(name: &str, places: &[DVec3], integrator: Integrator, dt: f64, energy_grows: f64) {
    let shape = Shape::from_particles(places).unwrap();
    let radius = shape.radius();
    let inverse = shape.principal().moments.to_array();
    let least = inverse.into_iter().filter(|&m| m > 0.0).fold(f64::INFINITY, f64::min);
    let body = Body::new(shape)
        .position(DVec3::ZERO)
        .velocity(DVec3::new(4.0, 2.0, 3.0))
        .angular_velocity(DVec3::new(3.0, 20.0, -7.0));
    let mut world = World::builder()
        .integrator(integrator)
        .dt(dt)
        .material(Material { collision_stiffness: 1e4, ..Material::default() })
        .box_walls(&WallBox::arena())
        .body(body)
        .build()
        .unwrap();
    // gravitational energy from the floor up, so that all of it is at least zero
    let mass = world.body(0).model().mass;
    let floor = mass * 9.8 * (1.0 + radius);
    let start = world.energy().total() + floor;
    let mut fastest = 0.0f64;
    while world.time() < 2.0 {
        world.step().unwrap_or_else(|error| panic!("{name}: {error}"));
        let body = world.body(0);
        assert!(body.position().is_finite() && body.angular_velocity().is_finite(), "{name}");
        fastest = fastest.max(body.angular_velocity().length());
        let energy = world.energy();
        let total = energy.total() + floor;
        let time = world.time();
        assert!(
            total < start * (1.0 + energy_grows) && total > start * (1.0 - energy_grows.min(0.5)),
            "{name}, {integrator:?}: energy {total} of {start} J at {time} s"
        );
    }
    // all energy as rotation about the axis of least inertia
    let bound = if least.is_finite() {
        (2.0 * start * (1.0 + energy_grows) / (mass * least)).sqrt()
    } else {
        0.0
    };
    assert!(fastest <= bound, "{name}, {integrator:?}: {fastest:e} rad/s, at most {bound:e}");
}

/// Both integrators, at the step of the basic system and a tenth of it. The explicit rotation of the basic system
/// adds energy to all bodies except points and lines (`docs/theory.md`).
fn bounces(name: &str, places: &[DVec3]) {
    for (dt, splitting, euler) in [(1e-3, 0.02, 4.0), (1e-4, 2e-3, 0.2)] {
        bounce(name, places, Integrator::Splitting, dt, splitting);
        bounce(name, places, Integrator::Euler, dt, euler);
    }
}

#[test]
fn a_single_particle_bounces() {
    bounces("at the origin", &[DVec3::ZERO]);
    bounces("elsewhere", &[DVec3::new(0.1, 0.2, -0.3)]);
}

#[test]
fn coincident_particles_bounce() {
    bounces("five", &[DVec3::new(0.1, 0.7, 1.0 / 3.0); 5]);
    bounces("far from the origin", &[DVec3::new(1e3, 0.7, 1.0 / 3.0); 5]);
}

#[test]
fn particles_on_a_line_bounce() {
    let line = |along: DVec3, at: DVec3| -> Vec<_> {
        (-3..=3).map(|i| at + along * f64::from(i)).collect()
    };
    bounces("x", &line(DVec3::X * 0.1, DVec3::ZERO));
    bounces("diagonal", &line(DVec3::splat(0.05), DVec3::ZERO));
    bounces("askew", &line(DVec3::new(0.07, -0.031, 0.05), DVec3::new(0.1, 0.2, 0.3)));
    bounces("far from the origin", &line(DVec3::new(0.07, -0.031, 0.05), DVec3::splat(100.1)));
    bounces("two", &[DVec3::new(0.1, 0.1, 0.1), DVec3::new(-0.1, 0.2, 0.3)]);
}

#[test]
fn particles_in_a_plane_bounce() {
    let (a, b) = (DVec3::new(0.1, 0.03, -0.02), DVec3::new(-0.01, 0.07, 0.06));
    let grid = |a: DVec3, b: DVec3| -> Vec<_> {
        (0..12).map(|i| a * f64::from(i % 4) + b * f64::from(i / 4)).collect()
    };
    bounces("upright", &grid(DVec3::X * 0.1, DVec3::Y * 0.1));
    bounces("askew", &grid(a, b));
    bounces("three", &[a, b, DVec3::ZERO]);
}

#[test]
fn particles_nearly_on_a_line_bounce() {
    for off in [1e-3, 1e-5, 1e-7, 1e-9, 1e-12] {
        let mut places: Vec<_> = (-3..=3).map(|i| DVec3::splat(0.05) * f64::from(i)).collect();
        places[2].x += off;
        places[5].z -= off;
        let name = format!("off by {off:e} m");
        // the start and end of contact cause errors of a few percent at a fixed step; only growth is an error
        bounce(&name, &places, Integrator::Splitting, 1e-3, 0.1);
        bounce(&name, &places, Integrator::Splitting, 1e-4, 0.01);
    }
}
