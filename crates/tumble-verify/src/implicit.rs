//! The integrator `implicit`: what is left of the physics at steps as long as an impact, and longer.

use std::f64::consts::PI;

use tumble::{DVec3, Integrator, SolverSettings, World, WorldBuilder};

use crate::check::{Case, Check, Error, Outcome};
use crate::collision::chain_velocities;
use crate::friction::slope_checks;
use crate::setup::{FLOOR, ball, material, particle, step_until};

pub(crate) const RESTITUTION: Case = Case {
    name: "implicit restitution",
    description: "A particle hits the floor at 1 m/s under `implicit`, in eight phases of the step. The largest deviation of the rebound \
            from the restitution that is asked for, for impacts that last a tenth of a step up to twelve steps. With e = 1 no energy is \
            lost at any step.",
    run: restitution,
    slow: false,
};

pub(crate) const CONVERGENCE: Case = Case {
    name: "implicit convergence",
    description: "Two balls with e = 0.5 meet off centre. The root mean square over sixteen phases of the difference in velocity between \
            `implicit` and `splitting` at dt = 1 µs, with dt and dt/4, gives the order at which the two agree: 2 without friction, and with \
            friction that sticks about 1.",
    run: convergence,
    slow: true,
};

pub(crate) const SLOPE: Case = Case {
    name: "implicit slope",
    description: "A block on a slope under `implicit`: below the angle of friction it stays, above it the acceleration is g (sin α − μ cos α).",
    run: slope,
    slow: false,
};

pub(crate) const CRADLE: Case = Case {
    name: "implicit cradle",
    description: "The cradle without gaps under `implicit`, against the chain of one-sided springs, with n steps for the impact of two balls. \
            The energy stays whatever n is.",
    run: cradle,
    slow: false,
};

/// So that what is measured is the error of the steps, not that of the iterations.
const EXACT: SolverSettings = SolverSettings { tolerance: 1e-12, max_iterations: 1000 };

fn implicit(dt: f64) -> WorldBuilder {
    World::builder().integrator(Integrator::Implicit).dt(dt)
}

fn restitution() -> Outcome {
    let k = 1e5;
    let duration = PI / f64::sqrt(k);
    let mut checks = Vec::new();
    for e in [1.0, 0.8, 0.5, 0.1] {
        for steps in [0.1, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0] {
            let dt = duration / steps;
            let mut worst: f64 = 0.0;
            for phase in 0..8 {
                // a run begins with shorter steps
                let height = (70.0 + (f64::from(phase) + 0.5) / 8.0) * dt;
                let mut world = implicit(dt)
                    .material(material(k, e, 0.0))
                    .gravity(DVec3::ZERO)
                    .wall(FLOOR)
                    .body(particle(height)?.velocity(DVec3::NEG_Y))
                    .build()?;
                // long enough also for the heaviest damping, whose contact ends late
                step_until(&mut world, (100.0 + 12.0 * steps) * dt)?;
                worst = worst.max((world.body(0).velocity().y - e).abs());
            }
            let bound = if e == 1.0 { 1e-9 } else { 0.03 * e };
            let quantity = format!("deviation of the rebound, e = {e}, {steps} steps an impact");
            checks.push(Check::error(quantity, worst, bound, "m/s"));
        }
    }
    Ok(checks)
}

/// Velocity (m/s) and angular velocity (rad/s) of the second of two balls after the first has met it off centre.
fn oblique(
    integrator: Integrator,
    friction: f64,
    dt: f64,
    phase: f64,
) -> Result<[DVec3; 2], Error> {
    let start = DVec3::X * (-0.01 * phase);
    let mut world = World::builder()
        .integrator(integrator)
        .dt(dt)
        .material(material(1e5, 0.5, friction))
        .gravity(DVec3::ZERO)
        .body(ball(0.1, 1.0)?.position(start).velocity(DVec3::X))
        .body(ball(0.1, 1.0)?.position(DVec3::new(0.2, 0.1, 0.05)))
        .build()?;
    step_until(&mut world, 0.1)?;
    Ok([world.body(1).velocity(), world.body(1).angular_velocity()])
}

fn convergence() -> Outcome {
    const PHASES: u32 = 16;
    let mut checks = Vec::new();
    let settings = [(0.0, 2.0, 0.2, [4e-4, 1e-4]), (0.5, 1.0, 0.3, [1e-4, 2.5e-5])];
    for (friction, order, bound, dts) in settings {
        let mut squares = [0.0; 2];
        for number in 0..PHASES {
            let phase = f64::from(number) / f64::from(PHASES);
            let exact = oblique(Integrator::Splitting, friction, 1e-6, phase)?;
            for (square, dt) in squares.iter_mut().zip(dts) {
                let found = oblique(Integrator::Implicit, friction, dt, phase)?;
                // ω R
                *square += (found[0] - exact[0]).length_squared()
                    + 0.01 * (found[1] - exact[1]).length_squared();
            }
        }
        let [coarse, fine] = squares.map(|square| f64::sqrt(square / f64::from(PHASES)));
        let quantity = format!("difference at dt = {} s, μ = {friction}", dts[1]);
        checks.push(Check::error(quantity, fine, 3e-4, "m/s"));
        let found = 0.5 * libm::log2(coarse / fine);
        checks.push(Check::new(format!("order, μ = {friction}"), order, found, bound, ""));
    }
    Ok(checks)
}

fn slope() -> Outcome {
    let mut checks = slope_checks(&implicit(1e-3), ", dt = 0.001 s")?;
    let exact = implicit(1.0 / 60.0).solver(EXACT);
    checks.extend(slope_checks(&exact, ", dt = 1/60 s, tolerance 1e-12")?);
    Ok(checks)
}

fn cradle() -> Outcome {
    let (k, mass, radius) = (1e6, 0.1, 0.02);
    let expected = chain_velocities(f64::sqrt(k / mass));
    let duration = PI / f64::sqrt(2.0 * k / mass);
    let mut checks = Vec::new();
    for (steps, bound) in [(3.0, 0.1), (6.0, 0.03), (24.0, 3e-3)] {
        let mut world = implicit(duration / steps)
            .solver(EXACT)
            .gravity(DVec3::ZERO)
            .material(material(k, 1.0, 0.0));
        for number in 0..5 {
            let start = if number == 0 { -0.03 } else { f64::from(number) * 2.0 * radius };
            let speed = if number == 0 { 1.0 } else { 0.0 };
            world = world
                .body(ball(radius, mass)?.position(DVec3::X * start).velocity(DVec3::X * speed));
        }
        let mut world = world.build()?;
        step_until(&mut world, 0.05)?;
        for number in [0, 3, 4] {
            let speed = world.body(number).velocity().x;
            let quantity = format!("velocity of ball {}, n = {steps}", number + 1);
            checks.push(Check::new(quantity, expected[number], speed, bound, "m/s"));
        }
        let kinetic = world.energy().kinetic;
        let quantity = format!("kinetic energy at the end, n = {steps}");
        checks.push(Check::new(quantity, 0.5 * mass, kinetic, 1e-6 * mass, "J"));
    }
    Ok(checks)
}
