//! Loads, springs and friction.

use std::f64::consts::{PI, TAU};

use tumble::{CentralGravity, DVec3, Joint, Load, LoadCourse, World};

use super::{point, rigid};
use crate::check::{Case, Check, Error, Outcome};
use crate::setup::step_until;

pub(crate) const DRIVEN: Case = Case {
    name: "driven oscillator",
    description: "A cart on a slider with a spring and a damper, driven by a periodic load near resonance. The amplitude is \
            F/√((k − m ω²)² + (c ω)²), the work of the load is what the damper takes.",
    run: driven,
    slow: false,
};

pub(crate) const FRICTION: Case = Case {
    name: "joint friction",
    description: "A cart on a slider with a spring and dry friction: every half swing is shorter by 2 F/k, until the cart stands where the \
            friction holds the spring.",
    run: friction,
    slow: false,
};

pub(crate) const ORBIT: Case = Case {
    name: "orbit",
    description: "Central gravity: the period of an ellipse of eccentricity 0.5 by Kepler, and small librations of a long body on a circular orbit, \
            at n √(3 (I₂ − I₁)/I₃).",
    run: orbit,
    slow: false,
};

fn world(dt: f64) -> tumble::WorldBuilder {
    World::builder().dt(dt).gravity(DVec3::ZERO)
}

fn cart() -> Result<tumble::Body, Error> {
    rigid("cart", 1.0, DVec3::ONE, DVec3::ZERO)
}

fn driven() -> Outcome {
    let (k, c, force, frequency) = (100.0f64, 2.0f64, 3.0, 1.5);
    let joint = Joint::slider(["cart", "world"], DVec3::ZERO, DVec3::X).spring_back(k, c);
    let load = Load::force("cart", DVec3::X * force)
        .course(LoadCourse::Periodic { frequency, phase: 0.0 });
    let mut world = world(1e-3).body(cart()?).joint(joint).load(load).build()?;
    // until what it began with has decayed
    step_until(&mut world, 30.0)?;
    let before = world.energy();
    let mut largest = 0.0f64;
    while world.time() < 50.0 {
        world.step()?;
        largest = largest.max(world.body(0).position().x);
    }
    let omega = TAU * frequency;
    let amplitude = force / (k - omega * omega).hypot(c * omega);
    let after = world.energy();
    let power = 0.5 * c * (amplitude * omega) * (amplitude * omega);
    Ok(vec![
        Check::new("amplitude at 1.5 Hz", amplitude, largest, 2e-4 * amplitude, "m"),
        Check::new(
            "work of the load in 20 s",
            power * 20.0,
            after.work - before.work,
            1e-3 * power * 20.0,
            "J",
        ),
        Check::error("change of the total", after.total() - before.total(), 1e-9, "J"),
    ])
}

fn friction() -> Outcome {
    let (k, force, start) = (100.0, 4.0, 0.5);
    let joint =
        Joint::slider(["cart", "world"], DVec3::ZERO, DVec3::X).spring_back(k, 0.0).friction(force);
    let joint = Joint { rest: -start, ..joint };
    let mut world = world(1e-3).body(cart()?).joint(joint).build()?;
    let begin = world.energy().total();
    let mut checks = Vec::new();
    // measured from where the spring has no force
    for half in 1..=6 {
        step_until(&mut world, f64::from(half) * PI / 10.0)?;
        let expected = (start - 2.0 * f64::from(half) * force / k) * f64::from(1 - 2 * (half % 2));
        let found = world.body(0).position().x + start;
        checks.push(Check::new(
            format!("place after {half} half swings"),
            expected,
            found,
            2e-5,
            "m",
        ));
    }
    step_until(&mut world, 20.0)?;
    let stands = world.body(0).position().x + start;
    step_until(&mut world, 40.0)?;
    let creep = world.body(0).position().x + start - stands;
    checks.push(Check::new("where it stands", 0.02, stands, 1e-4, "m"));
    checks.push(Check::error("creep in 20 s", creep, 1e-15, "m"));
    checks.push(Check::error("change of the total", world.energy().total() - begin, 1e-10, "J"));
    Ok(checks)
}

fn orbit() -> Outcome {
    let gravity = CentralGravity { gm: 1.0, at: DVec3::ZERO };
    // at the pericentre of an ellipse with a = 1 and e = 0.5
    let run = |steps: u64| -> Result<DVec3, Error> {
        let start = point("planet", 1.0, DVec3::X * 0.5)?.velocity(DVec3::NEG_Z * 3f64.sqrt());
        let builder = world(TAU / steps as f64).central_gravity(gravity).body(start);
        let mut world = builder.build()?;
        world.steps(steps)?;
        Ok(world.body(0).position() - DVec3::X * 0.5)
    };
    let [coarse, fine] = [run(20_000)?.length(), run(40_000)?.length()];
    // inertia about the radial, the tangential and the normal axis
    let moments = DVec3::new(1.0, 2.5, 2.0) * 1e-6;
    let first = 0.01;
    let body = rigid("satellite", 1.0, moments, DVec3::X)?
        .velocity(DVec3::NEG_Z)
        .orientation(tumble::DQuat::from_rotation_y(first))
        .angular_velocity(DVec3::Y);
    let mut world = world(1e-3).central_gravity(gravity).body(body).build()?;
    let expected = (3.0 * (moments.z - moments.x) / moments.y).sqrt();
    step_until(&mut world, PI / expected)?;
    let radial = libm::atan2(-world.body(0).position().z, world.body(0).position().x);
    let long = world.body(0).orientation() * DVec3::X;
    let pitch = libm::remainder(libm::atan2(-long.z, long.x) - radial, TAU);
    Ok(vec![
        Check::error("distance from the start after a period of 40,000 steps", fine, 1e-6, "m"),
        Check::new("order of the distance", 2.0, libm::log2(coarse / fine), 0.05, ""),
        Check::new("angle after half a libration", -first, pitch, 1e-3 * first, "rad"),
    ])
}
