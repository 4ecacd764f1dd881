//! The tangential force of wall contacts: Coulomb friction with friction springs.

use tumble::{Body, DMat3, DVec3, Damping, Material, Mesh, Shape, World, WorldBuilder};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{self, FLOOR, G, step_until, world_with_floor};

pub(crate) const SLIDING: Case = Case {
    name: "sliding",
    description: "A block of 1 kg that slides at v = 2 m/s stops after the distance v²/(2 μ g).",
    run: sliding,
    slow: false,
};

pub(crate) const SLOPE: Case = Case {
    name: "slope",
    description: "A block on a slope stays at rest at 0.9 of the friction angle atan μ. At 1.1 of it, it slides with the acceleration \
            g (sin θ − μ cos θ).",
    run: slope,
    slow: false,
};

pub(crate) const ROLLING: Case = Case {
    name: "rolling",
    description: "A ball that starts to slide without spin ends rolling at 5/7 of its initial speed.",
    run: rolling,
    slow: false,
};

/// A material so stiff that friction springs stretch by about a millionth of the sliding distance.
fn material(friction: f64) -> Material {
    setup::material(1e7, 0.1, friction)
}

/// A block of 0.2 × 0.1 × 0.2 m and 1 kg, its lower corners at the depth where their springs carry its weight.
fn block(material: &Material) -> Result<Body, Error> {
    let corner = |i: u32| {
        DVec3::new(0.1, 0.05, 0.1)
            * DVec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }))
    };
    let points: Vec<_> = (0..8).map(corner).collect();
    let depth = G / (4.0 * material.collision_stiffness);
    Ok(Body::new(Shape::from_particles(&points)?).mass(1.0).position(DVec3::Y * (0.05 - depth)))
}

fn sliding() -> Outcome {
    let mut checks = Vec::new();
    for friction in [0.1, 0.2, 0.5] {
        let material = material(friction);
        let body = block(&material)?;
        let mut world = world_with_floor(material).dt(2e-5).body(body).build()?;
        step_until(&mut world, 0.2)?;
        // a new world starts from the position of rest, with a velocity
        let rest = world.body(0).position();
        let sliding = block(&material)?.position(rest).velocity(DVec3::X * 2.0);
        let mut world = world_with_floor(material).dt(2e-5).body(sliding).build()?;
        step_until(&mut world, 2.0 / (friction * G) + 0.2)?;
        let distance = world.body(0).position().x - rest.x;
        let expected = 4.0 / (2.0 * friction * G);
        let quantity = format!("sliding distance for μ = {friction}");
        checks.push(Check::new(quantity, expected, distance, 1e-4 * expected, "m"));
    }
    Ok(checks)
}

/// A block on a slope of `angle` (rad): the floor is horizontal and gravity is tilted.
fn on_slope(world: WorldBuilder, material: &Material, angle: f64) -> Result<World, Error> {
    let gravity = DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0) * G;
    Ok(world.material(*material).gravity(gravity).wall(FLOOR).body(block(material)?).build()?)
}

fn slope() -> Outcome {
    slope_checks(&World::builder().dt(1e-4), "")
}

/// The checks of a block on a slope in worlds with the settings of `builder`; their names end with `setting`.
pub(crate) fn slope_checks(builder: &WorldBuilder, setting: &str) -> Outcome {
    let friction: f64 = 0.5;
    let friction_angle = libm::atan(friction);
    let material = Material { collision_stiffness: 1e5, ..material(friction) };
    let mut world = on_slope(builder.clone(), &material, 0.9 * friction_angle)?;
    step_until(&mut world, 3.0)?;
    let position = world.body(0).position();
    step_until(&mut world, 13.0)?;
    let creep = (world.body(0).position() - position).length() / 10.0;

    let angle = 1.1 * friction_angle;
    let mut world = on_slope(builder.clone(), &material, angle)?;
    step_until(&mut world, 1.0)?;
    let before = world.body(0).velocity().x;
    step_until(&mut world, 2.0)?;
    let acceleration = world.body(0).velocity().x - before;
    let expected = G * (libm::sin(angle) - friction * libm::cos(angle));
    Ok(vec![
        Check::error(
            format!("creep velocity at 0.9 of the friction angle{setting}"),
            creep,
            1e-12,
            "m/s",
        ),
        Check::new(
            format!("acceleration at 1.1 of the friction angle{setting}"),
            expected,
            acceleration,
            1e-4 * expected,
            "m/s²",
        ),
    ])
}

fn rolling() -> Outcome {
    // particles on a circle, with the inertia 2/5 M R² of a solid ball
    let (radius, count, speed) = (0.1, 1000, 1.0);
    let circle: Vec<_> = (0..count)
        .map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(count));
            DVec3::new(cos, sin, 0.0) * radius
        })
        .collect();
    let gyration = DMat3::IDENTITY * (0.4 * radius * radius);
    let shape = Shape::from_distribution(&circle, Mesh::default(), DVec3::ZERO, gyration)?;
    let material = Material {
        collision_stiffness: 1e6,
        damping: Damping::Dashpot(10.0),
        friction_stiffness: 0.3,
        friction_damping: Some(5.0),
        ..Material::default()
    };
    let ball = Body::new(shape).mass(1.0).position(DVec3::Y * radius).velocity(DVec3::X * speed);
    let mut world = world_with_floor(material).dt(2e-5).body(ball).build()?;
    // sliding ends after 2/7 v/(μ g)
    step_until(&mut world, 0.2)?;
    let (v, spin) = (world.body(0).velocity().x, -world.body(0).angular_velocity().z);
    Ok(vec![
        Check::new("speed when it rolls", 5.0 / 7.0 * speed, v, 2e-3, "m/s"),
        Check::new("ω R when it rolls", v, spin * radius, 2e-3, "m/s"),
    ])
}
