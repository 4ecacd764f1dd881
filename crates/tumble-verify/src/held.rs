//! Bodies that meet what stands still, or moves whatever they do: slopes, belts, pistons.

use std::f64::consts::TAU;

use tumble::{
    Body, DQuat, DVec3, Motion, Oscillation, Prescribed, Primitive, Surface, WallPlane, World,
};

use crate::check::{Case, Check, Outcome};
use crate::flight::run;
use crate::meeting::{ball, material, solid};

type Error = Box<dyn std::error::Error>;

const G: f64 = 9.8;

pub(crate) const SLOPE: Case = Case {
    name: "rolling down",
    about: "a solid ball rolls down a slope without slip at 5/7 g sin θ, the slope a wall or the face of a mesh",
    run: slope,
    slow: false,
};

pub(crate) const FLOOR: Case = Case {
    name: "wall or mesh",
    about: "a spinning ball, and a box, bounce off a floor given as a wall and as the face of a mesh that stands still: how far apart \
            they end",
    run: floor,
    slow: false,
};

pub(crate) const BELT: Case = Case {
    name: "belt",
    about: "a solid ball set on a belt of speed V slides, then rolls: its speed 2/7 V, the work of the belt 2/7 M V², half of \
            it lost to slip",
    run: belt,
    slow: false,
};

pub(crate) const PISTON: Case = Case {
    name: "piston",
    about: "a ball on a piston that swings at 0.9 g never leaves it: the force on it M (g + a), and the ledger with the work",
    run: piston,
    slow: false,
};

/// A box whose upper face is y = 0, as what others meet, with a motion of its own.
fn slab(given: Prescribed) -> Result<Body, Error> {
    let body = solid(Primitive::Box { size: DVec3::new(6.0, 0.5, 6.0), divisions: 1 })?;
    Ok(body.position(DVec3::Y * -0.25).motion(Motion::Prescribed(given)).name("slab"))
}

fn floor_plane() -> WallPlane {
    WallPlane { normal: DVec3::Y, offset: 0.0 }
}

fn slope() -> Outcome {
    let (angle, k, mass, radius) = (0.3, 1e6, 0.5, 0.05);
    let sag = mass * G * libm::cos(angle) / k;
    let mut checks = Vec::new();
    for mesh in [false, true] {
        // gravity leans instead of the floor
        let gravity = DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0) * G;
        let world = World::builder().gravity(gravity).dt(5e-5).material(material(k, 0.3, 0.5));
        let world = world.body(ball(radius, mass)?.position(DVec3::Y * (radius - sag)));
        let world =
            if mesh { world.body(slab(Prescribed::default())?) } else { world.wall(floor_plane()) };
        let mut world = world.build()?;
        run(&mut world, 0.2)?;
        let before = world.body(0).velocity().x;
        run(&mut world, 0.7)?;
        let found = (world.body(0).velocity().x - before) / 0.5;
        let expected = 5.0 / 7.0 * G * libm::sin(angle);
        let name = if mesh { "mesh" } else { "wall" };
        let quantity = format!("acceleration, {name}");
        checks.push(Check::new(quantity, expected, found, 1e-5 * expected, "m/s²"));
        let slip = world.energy().slip / world.energy().kinetic;
        checks.push(Check::error(format!("lost to slip, {name}"), slip, 1e-6, ""));
    }
    Ok(checks)
}

fn floor() -> Outcome {
    let cuboid = Primitive::Box { size: DVec3::new(0.2, 0.15, 0.1), divisions: 2 };
    let bodies = [
        ("ball, rough", ball(0.05, 0.5)?, 0.4),
        ("box of particles, smooth", solid(cuboid)?.mass(0.5).surface(Surface::None), 0.0),
    ];
    let mut checks = Vec::new();
    for (name, body, friction) in bodies {
        let body = body
            .position(DVec3::Y * 0.4)
            .orientation(DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9))
            .velocity(DVec3::new(0.7, -1.0, 0.2))
            .angular_velocity(DVec3::new(3.0, 5.0, -20.0));
        let end = |mesh: bool| -> Result<(DVec3, DVec3, DVec3), Error> {
            let world = World::builder().dt(1e-5).material(material(2e4, 0.6, friction));
            let world = world.body(body.clone());
            let world = if mesh {
                world.body(slab(Prescribed::default())?)
            } else {
                world.wall(floor_plane())
            };
            let mut world = world.build()?;
            run(&mut world, 0.5)?;
            let body = world.body(0);
            Ok((body.position(), body.velocity(), body.angular_velocity()))
        };
        let (a, b) = (end(false)?, end(true)?);
        let mut add = |what: &str, a: DVec3, b: DVec3, unit| {
            let quantity = format!("{what} of the {name}");
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
    let sag = mass * G / k;
    let moving = Prescribed { surface_velocity: DVec3::X * speed, ..Prescribed::default() };
    let mut world = World::builder()
        .dt(2e-5)
        .material(material(k, 0.3, 0.3))
        .body(ball(radius, mass)?.position(DVec3::Y * (radius - sag)))
        .body(slab(moving)?)
        .build()?;
    let start = world.energy();
    // slip ends after 2/7 V/(μ g)
    run(&mut world, 0.3)?;
    let (body, energy) = (world.body(0), world.energy());
    let (v, rim) = (body.velocity().x, body.angular_velocity().z * radius);
    let unit = mass * speed * speed;
    let lost = energy.slip + energy.dashpot;
    let residual = (energy.total() - start.total()) / unit;
    Ok(vec![
        Check::new("speed once it rolls", 2.0 / 7.0 * speed, v, 1e-3 * speed, "m/s"),
        Check::new("speed of its rim", 5.0 / 7.0 * speed, rim, 1e-3 * speed, "m/s"),
        Check::new("work of the belt", 2.0 / 7.0 * unit, energy.work, 1e-3 * unit, "J"),
        Check::new("lost to slip and dashpot", unit / 7.0, lost, 1e-3 * unit, "J"),
        Check::error("residual, as a part of M V²", residual, 1e-5, ""),
    ])
}

fn piston() -> Outcome {
    let (k, mass, radius, frequency) = (1e6, 0.1, 0.05, 5.0);
    let rate = TAU * frequency;
    let amplitude = 0.9 * G / (rate * rate);
    // it starts at the top of its swing, at rest
    let swing = Oscillation {
        amplitude: DVec3::Y * amplitude,
        frequency,
        phase: std::f64::consts::FRAC_PI_2,
    };
    let given = Prescribed { oscillation: Some(swing), ..Prescribed::default() };
    let sag = mass * (G - 0.9 * G) / k;
    let mut world = World::builder()
        .dt(2e-5)
        .material(material(k, 0.5, 0.3))
        .body(ball(radius, mass)?.position(DVec3::Y * (radius - sag)))
        .body(slab(given)?)
        .build()?;
    let start = world.energy().total();
    let (mut worst, mut least, mut in_play, mut residual) = (0.0f64, f64::INFINITY, 0.0f64, 0.0f64);
    for _ in 0..50_000 {
        world.step()?;
        let middle = world.time() - 0.5 * world.dt();
        let expected = mass * G * (1.0 - 0.9 * libm::cos(rate * middle));
        let force = world.contact_wrench(0).force.y;
        let energy = world.energy();
        worst = worst.max((force - expected).abs() / (mass * G));
        least = least.min(force / (mass * G));
        in_play = in_play.max(energy.kinetic + energy.work.abs());
        residual = residual.max((energy.total() - start).abs());
    }
    Ok(vec![
        Check::new("least force, as a part of M g", 0.1, least, 1e-3, ""),
        Check::error("force, as a part of M g", worst, 1e-3, ""),
        Check::error(
            "residual over 5 swings, as a part of what is in play",
            residual / in_play,
            1e-5,
            "",
        ),
    ])
}
