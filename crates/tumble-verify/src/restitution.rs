//! Restitution of bodies of any shape and mesh, at walls and on each other.

use tumble::{Body, DQuat, DVec3, Motion, Prescribed, Primitive, Surface, World, WorldBuilder};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{FLOOR, ball, material, mesh_body, particle};

pub(crate) const BODIES: Case = Case {
    name: "restitution of bodies",
    description: "Bodies of 1 kg meet at 1 m/s without gravity and separate at e times that speed, whatever their shape and mesh: a particle, \
            a sphere, boxes that land flat and meshed balls, at a wall, on each other and on a fixed plate with a mesh.",
    run: bodies,
    slow: false,
};

pub(crate) const LOSSES: Case = Case {
    name: "dashpot losses",
    description: "A tilted box and a meshed ball bounce on a wall and on a fixed plate with a mesh, and their points come and go. Dashpots take \
            energy in every step. The table has the largest energy that they give in a step, relative to the energy at the start.",
    run: losses,
    slow: false,
};

/// Stiffness of a particle (N/m).
const K: f64 = 1e4;
/// Radius of balls (m).
const RADIUS: f64 = 0.15;

/// What the first body meets.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    Wall,
    /// A fixed plate with a mesh of so many parts along each edge.
    Plate(u32),
    /// A sphere, free and of the same mass.
    Sphere,
    /// A box with a mesh, free and of the same mass.
    Box,
}

/// A body and its height above its lowest point (m).
type Placed = (Body, f64);

fn meshed_ball(subdivisions: u32) -> Result<Placed, Error> {
    Ok((mesh_body(Primitive::Sphere { radius: RADIUS, subdivisions })?, RADIUS))
}

fn flat_box(divisions: u32) -> Result<Placed, Error> {
    let size = DVec3::new(0.3, 0.2, 0.1);
    Ok((mesh_body(Primitive::Box { size, divisions })?, 0.5 * size.y))
}

/// The first body above the target.
fn world_with((body, height): Placed, target: Target, e: f64) -> Result<WorldBuilder, Error> {
    // a small gap, and an offset that puts no vertex above another
    let place = DVec3::new(0.011, height + 1e-3, 0.017);
    let body = body.mass(1.0).position(place).velocity(-DVec3::Y);
    let world = World::builder().gravity(DVec3::ZERO).material(material(K, e, 0.0)).body(body);
    Ok(match target {
        Target::Wall => world.wall(FLOOR),
        Target::Plate(divisions) => {
            let size = DVec3::new(1.0, 0.2, 1.0);
            let plate = mesh_body(Primitive::Box { size, divisions })?;
            let fixed = Motion::Prescribed(Prescribed::default());
            world.body(plate.position(DVec3::Y * -0.1).motion(fixed))
        }
        Target::Sphere => {
            world.body(ball(RADIUS, 1.0)?.position(DVec3::new(place.x, -RADIUS, place.z)))
        }
        Target::Box => {
            let size = DVec3::new(0.5, 0.4, 0.5);
            let body = mesh_body(Primitive::Box { size, divisions: 2 })?;
            world.body(body.mass(1.0).position(DVec3::new(place.x, -0.2, place.z)))
        }
    })
}

/// The speed (m/s) at which the first body separates from the target.
fn rebound(placed: Placed, target: Target, e: f64) -> Result<f64, Error> {
    let mut world = world_with(placed, target, e)?.dt(1e-5).build()?;
    let (mut has_touched, mut clear_steps) = (false, 0);
    // points may leave one after the other
    while clear_steps < 200 && world.time() < 1.0 {
        world.step()?;
        let touches = world.contact_wrench(0).force != DVec3::ZERO;
        has_touched |= touches;
        clear_steps = if has_touched && !touches { clear_steps + 1 } else { 0 };
    }
    let other = if target == Target::Wall { DVec3::ZERO } else { world.body(1).velocity() };
    Ok((world.body(0).velocity() - other).y)
}

fn bodies() -> Outcome {
    let mut checks = Vec::new();
    let sphere = || -> Result<Placed, Error> { Ok((ball(RADIUS, 1.0)?, RADIUS)) };
    for e in [0.1, 0.3, 0.5, 0.7, 0.95] {
        let mut check = |what: &str, placed: Placed, target: Target, bound: f64| {
            let measured = rebound(placed, target, e)?;
            checks.push(Check::new(format!("e, {what}"), e, measured, bound * e, ""));
            Ok::<(), Error>(())
        };
        check("particle at a wall", (particle(0.0)?, 0.0), Target::Wall, 0.02)?;
        check("sphere at a wall", sphere()?, Target::Wall, 0.02)?;
        check("sphere on a sphere", sphere()?, Target::Sphere, 0.02)?;
        check("sphere on a fixed plate", sphere()?, Target::Plate(4), 0.02)?;
        check("sphere on a box", sphere()?, Target::Box, 0.02)?;
        for divisions in 1..=4 {
            let name = format!("box of {divisions} divisions at a wall");
            check(&name, flat_box(divisions)?, Target::Wall, 0.05)?;
            let name = format!("box of {divisions} divisions on a fixed plate");
            check(&name, flat_box(divisions)?, Target::Plate(4), 0.05)?;
        }
        // the force of a few points that touch one after the other grows in jumps
        let of_balls = f64::max(0.05, 0.015 / e);
        for subdivisions in 0..=3 {
            let name = format!("ball of {subdivisions} subdivisions at a wall");
            check(&name, meshed_ball(subdivisions)?, Target::Wall, of_balls)?;
            let name = format!("ball of {subdivisions} subdivisions on a fixed plate");
            check(&name, meshed_ball(subdivisions)?, Target::Plate(4), of_balls)?;
        }
        let name = "ball of 3 subdivisions on a fine plate";
        check(name, meshed_ball(3)?, Target::Plate(20), of_balls)?;
    }
    Ok(checks)
}

fn losses() -> Outcome {
    let mut checks = Vec::new();
    for (target, name) in [(Target::Wall, "at a wall"), (Target::Plate(4), "on a plate")] {
        for (what, placed) in [("box", flat_box(3)?), ("ball", meshed_ball(3)?)] {
            let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.7).normalize();
            let (body, _) = placed;
            let body = body.orientation(turn).angular_velocity(DVec3::new(2.0, -1.0, 3.0));
            let placed = (body.surface(Surface::Mesh), 0.25);
            let world = world_with(placed, target, 0.4)?.gravity(DVec3::Y * -9.8);
            let mut world = world.dt(5e-5).build()?;
            let scale = world.energy().kinetic;
            let (mut given, mut before, mut contact_steps) = (0.0f64, 0.0, 0u32);
            while world.time() < 1.0 {
                world.step()?;
                let lost = world.state().totals.dashpot;
                given = given.max(before - lost);
                contact_steps += u32::from(lost != before);
                before = lost;
            }
            let remark = format!("{contact_steps} steps with losses");
            let quantity = format!("energy given, {what} {name}");
            checks.push(Check::error(quantity, given / scale, 1e-9, "").remark(remark));
        }
    }
    Ok(checks)
}
