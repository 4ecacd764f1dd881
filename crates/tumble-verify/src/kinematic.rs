//! Contact with kinematic bodies: fixed floors and slopes, a conveyor belt, a piston.

use std::f64::consts::TAU;

use tumble::{Body, DQuat, DVec3, Motion, Oscillation, Prescribed, Primitive, Surface, World};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{FLOOR, G, ball, material, mesh_body, step_until};

pub(crate) const SLOPE: Case = Case {
    name: "rolling down",
    description: "A solid ball rolls down a slope without slip with the acceleration 5/7 g sin θ. The slope is a wall or the face of a mesh.",
    run: slope,
    slow: false,
};

pub(crate) const WALL_OR_MESH: Case = Case {
    name: "wall or mesh",
    description: "A spinning ball and a box bounce off a floor that is a wall or the face of a fixed mesh. The table has the difference \
            of the two final states.",
    run: wall_or_mesh,
    slow: false,
};

pub(crate) const BELT: Case = Case {
    name: "belt",
    description: "A solid ball at rest on a conveyor belt of speed V slides, then rolls at 2/7 V. The belt has done the work 2/7 M V², half of \
            which is lost to slip.",
    run: belt,
    slow: false,
};

pub(crate) const PISTON: Case = Case {
    name: "piston",
    description: "A ball stays on a piston that oscillates with an acceleration a of up to 0.9 g. The contact force is M (g + a), and the \
            energy ledger includes the work of the piston.",
    run: piston,
    slow: false,
};

/// A kinematic box with a mesh surface, its upper face at y = 0.
fn slab(motion: Prescribed) -> Result<Body, Error> {
    let body = mesh_body(Primitive::Box { size: DVec3::new(6.0, 0.5, 6.0), divisions: 1 })?;
    Ok(body.position(DVec3::Y * -0.25).motion(Motion::Prescribed(motion)).name("slab"))
}

fn slope() -> Outcome {
    let (angle, k, mass, radius) = (0.3, 1e6, 0.5, 0.05);
    let depth = mass * G * libm::cos(angle) / k;
    let mut checks = Vec::new();
    for mesh in [false, true] {
        // the floor is horizontal and gravity is tilted
        let gravity = DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0) * G;
        let world = World::builder().gravity(gravity).dt(5e-5).material(material(k, 0.3, 0.5));
        let world = world.body(ball(radius, mass)?.position(DVec3::Y * (radius - depth)));
        let world = if mesh { world.body(slab(Prescribed::default())?) } else { world.wall(FLOOR) };
        let mut world = world.build()?;
        step_until(&mut world, 0.2)?;
        let before = world.body(0).velocity().x;
        step_until(&mut world, 0.7)?;
        let acceleration = (world.body(0).velocity().x - before) / 0.5;
        let expected = 5.0 / 7.0 * G * libm::sin(angle);
        let name = if mesh { "mesh" } else { "wall" };
        let quantity = format!("acceleration, {name}");
        checks.push(Check::new(quantity, expected, acceleration, 1e-5 * expected, "m/s²"));
        let slip = world.energy().slip / world.energy().kinetic;
        let quantity = format!("loss to slip, relative to the kinetic energy, {name}");
        checks.push(Check::error(quantity, slip, 1e-6, ""));
    }
    Ok(checks)
}

fn wall_or_mesh() -> Outcome {
    let cuboid = Primitive::Box { size: DVec3::new(0.2, 0.15, 0.1), divisions: 2 };
    let bodies = [
        ("ball, with friction", ball(0.05, 0.5)?, 0.4),
        (
            "box of particles, without friction",
            mesh_body(cuboid)?.mass(0.5).surface(Surface::None),
            0.0,
        ),
    ];
    let mut checks = Vec::new();
    for (name, body, friction) in bodies {
        let body = body
            .position(DVec3::Y * 0.4)
            .orientation(DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9))
            .velocity(DVec3::new(0.7, -1.0, 0.2))
            .angular_velocity(DVec3::new(3.0, 5.0, -20.0));
        let final_state = |mesh: bool| -> Result<(DVec3, DVec3, DVec3), Error> {
            let world = World::builder().dt(1e-5).material(material(2e4, 0.6, friction));
            let world = world.body(body.clone());
            let world =
                if mesh { world.body(slab(Prescribed::default())?) } else { world.wall(FLOOR) };
            let mut world = world.build()?;
            step_until(&mut world, 0.5)?;
            let body = world.body(0);
            Ok((body.position(), body.velocity(), body.angular_velocity()))
        };
        let (a, b) = (final_state(false)?, final_state(true)?);
        let mut add = |name_of_vector: &str, a: DVec3, b: DVec3, unit| {
            let quantity = format!("{name_of_vector} of the {name}");
            checks.push(Check::error(quantity, (a - b).length(), 1e-8, unit));
        };
        add("position", a.0, b.0, "m");
        add("velocity", a.1, b.1, "m/s");
        add("angular velocity", a.2, b.2, "rad/s");
    }
    Ok(checks)
}

fn belt() -> Outcome {
    let (k, mass, radius, speed) = (1e6, 0.5, 0.05, 1.0);
    let depth = mass * G / k;
    let belt = Prescribed { surface_velocity: DVec3::X * speed, ..Prescribed::default() };
    let mut world = World::builder()
        .dt(2e-5)
        .material(material(k, 0.3, 0.3))
        .body(ball(radius, mass)?.position(DVec3::Y * (radius - depth)))
        .body(slab(belt)?)
        .build()?;
    let start = world.energy();
    // sliding ends after 2/7 V/(μ g)
    step_until(&mut world, 0.3)?;
    let (body, energy) = (world.body(0), world.energy());
    let (v, spin_speed) = (body.velocity().x, body.angular_velocity().z * radius);
    let scale = mass * speed * speed;
    let losses = energy.slip + energy.dashpot;
    let residual = (energy.total() - start.total()) / scale;
    Ok(vec![
        Check::new("speed when it rolls", 2.0 / 7.0 * speed, v, 1e-3 * speed, "m/s"),
        Check::new("ω R when it rolls", 5.0 / 7.0 * speed, spin_speed, 1e-3 * speed, "m/s"),
        Check::new("work of the belt", 2.0 / 7.0 * scale, energy.work, 1e-3 * scale, "J"),
        Check::new("loss to slip and dashpot", scale / 7.0, losses, 1e-3 * scale, "J"),
        Check::error("residual, relative to M V²", residual, 1e-5, ""),
    ])
}

fn piston() -> Outcome {
    let (k, mass, radius, frequency) = (1e6, 0.1, 0.05, 5.0);
    let omega = TAU * frequency;
    let amplitude = 0.9 * G / (omega * omega);
    // starts at the upper turning point, where the velocity is zero
    let oscillation = Oscillation {
        amplitude: DVec3::Y * amplitude,
        frequency,
        phase: std::f64::consts::FRAC_PI_2,
    };
    let piston = Prescribed { oscillation: Some(oscillation), ..Prescribed::default() };
    let depth = mass * (G - 0.9 * G) / k;
    let mut world = World::builder()
        .dt(2e-5)
        .material(material(k, 0.5, 0.3))
        .body(ball(radius, mass)?.position(DVec3::Y * (radius - depth)))
        .body(slab(piston)?)
        .build()?;
    let start = world.energy().total();
    let (mut force_error, mut least_force) = (0.0f64, f64::INFINITY);
    let (mut scale, mut residual) = (0.0f64, 0.0f64);
    for _ in 0..50_000 {
        world.step()?;
        let middle = world.time() - 0.5 * world.dt();
        let expected = mass * G * (1.0 - 0.9 * libm::cos(omega * middle));
        let force = world.contact_wrench(0).force.y;
        let energy = world.energy();
        force_error = force_error.max((force - expected).abs() / (mass * G));
        least_force = least_force.min(force / (mass * G));
        scale = scale.max(energy.kinetic + energy.work.abs());
        residual = residual.max((energy.total() - start).abs());
    }
    Ok(vec![
        Check::new("least force, relative to M g", 0.1, least_force, 1e-3, ""),
        Check::error("error of the force, relative to M g", force_error, 1e-3, ""),
        Check::error(
            "residual over 5 periods, relative to kinetic energy and work",
            residual / scale,
            1e-5,
            "",
        ),
    ])
}
