//! Contact along the wall: Coulomb friction with its springs.

use tumble::{Body, DMat3, DVec3, Damping, Material, Mesh, Shape, World};

use crate::check::{Case, Check, Outcome};
use crate::contact::on_floor;
use crate::flight::run;

type Error = Box<dyn std::error::Error>;

const G: f64 = 9.8;

pub(crate) const SLIDING: Case = Case {
    name: "sliding",
    about: "a block of 1 kg at 2 m/s slides to rest after v²/(2 μ g)",
    run: sliding,
    slow: false,
};

pub(crate) const SLOPE: Case = Case {
    name: "slope",
    about: "a block on a slope: at 0.9 of the friction angle it stays for ever, at 1.1 it slides at g (sin θ − μ cos θ)",
    run: slope,
    slow: false,
};

pub(crate) const ROLLING: Case = Case {
    name: "rolling",
    about: "a ball that starts sliding without spin ends rolling at 5/7 of its speed",
    run: rolling,
    slow: false,
};

/// Stiff enough that friction springs stretch by a millionth of the way.
fn material(friction: f64) -> Material {
    Material {
        collision_stiffness: 1e7,
        damping: Damping::Restitution(0.1),
        friction_stiffness: friction,
        ..Material::default()
    }
}

/// A block of 0.2 × 0.1 × 0.2 m and 1 kg, its lowest corners at the depth that carries it.
fn block(material: &Material) -> Result<Body, Error> {
    let corner = |i: u32| {
        DVec3::new(0.1, 0.05, 0.1)
            * DVec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }))
    };
    let points: Vec<_> = (0..8).map(corner).collect();
    let sag = G / (4.0 * material.collision_stiffness);
    Ok(Body::new(Shape::of_particles(&points)?).mass(1.0).position(DVec3::Y * (0.05 - sag)))
}

fn sliding() -> Outcome {
    let mut checks = Vec::new();
    for friction in [0.1, 0.2, 0.5] {
        let material = material(friction);
        let body = block(&material)?;
        let mut world = on_floor(material).dt(2e-5).body(body).build()?;
        // settle first, then push: the world is built anew from where it came to rest
        run(&mut world, 0.2)?;
        let place = world.body(0).position();
        let pushed = block(&material)?.position(place).velocity(DVec3::X * 2.0);
        let mut world = on_floor(material).dt(2e-5).body(pushed).build()?;
        run(&mut world, 2.0 / (friction * G) + 0.2)?;
        let way = world.body(0).position().x - place.x;
        let expected = 4.0 / (2.0 * friction * G);
        checks.push(Check::new(
            format!("way for μ = {friction}"),
            expected,
            way,
            1e-4 * expected,
            "m",
        ));
    }
    Ok(checks)
}

/// A world in which gravity leans by `angle` (rad), so that the floor is a slope.
fn tilted(material: Material, angle: f64, dt: f64) -> Result<World, Error> {
    let gravity = DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0) * G;
    Ok(on_floor(material).gravity(gravity).dt(dt).body(block(&material)?).build()?)
}

fn slope() -> Outcome {
    let friction: f64 = 0.5;
    let limit = libm::atan(friction);
    let material = Material { collision_stiffness: 1e5, ..material(friction) };
    let mut held = tilted(material, 0.9 * limit, 1e-4)?;
    run(&mut held, 3.0)?;
    let place = held.body(0).position();
    run(&mut held, 13.0)?;
    let creep = (held.body(0).position() - place).length() / 10.0;

    let angle = 1.1 * limit;
    let mut slides = tilted(material, angle, 1e-4)?;
    run(&mut slides, 1.0)?;
    let before = slides.body(0).velocity().x;
    run(&mut slides, 2.0)?;
    let found = slides.body(0).velocity().x - before;
    let expected = G * (libm::sin(angle) - friction * libm::cos(angle));
    Ok(vec![
        Check::error("creep at 0.9 of the friction angle", creep, 1e-12, "m/s"),
        Check::new("acceleration at 1.1", expected, found, 1e-4 * expected, "m/s²"),
    ])
}

fn rolling() -> Outcome {
    // a rim of particles carries the inertia of a solid ball, 2/5 M R²
    let (radius, count, speed) = (0.1, 1000, 1.0);
    let rim: Vec<_> = (0..count)
        .map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(count));
            DVec3::new(cos, sin, 0.0) * radius
        })
        .collect();
    let gyration = DMat3::IDENTITY * (0.4 * radius * radius);
    let shape = Shape::of_distribution(&rim, Mesh::default(), DVec3::ZERO, gyration)?;
    let material = Material {
        collision_stiffness: 1e6,
        damping: Damping::Dashpot(10.0),
        friction_stiffness: 0.3,
        friction_damping: Some(5.0),
        ..Material::default()
    };
    let ball = Body::new(shape).mass(1.0).position(DVec3::Y * radius).velocity(DVec3::X * speed);
    let mut world = on_floor(material).dt(2e-5).body(ball).build()?;
    // slip ends after 2/7 v/(μ g)
    run(&mut world, 0.2)?;
    let (v, spin) = (world.body(0).velocity().x, -world.body(0).angular_velocity().z);
    Ok(vec![
        Check::new("speed once it rolls", 5.0 / 7.0 * speed, v, 2e-3, "m/s"),
        Check::new("speed of its rim", v, spin * radius, 2e-3, "m/s"),
    ])
}
