//! Pendulums.

use std::f64::consts::{PI, TAU};

use tumble::{CentralGravity, DVec3, Joint, Motion, Oscillation, Prescribed, World};

use super::{G, bar, point, richardson, rigid, world};
use crate::check::{Case, Check, Error, Outcome};
use crate::runge_kutta::integrate;
use crate::setup::step_until;

pub(crate) const PENDULUM: Case = Case {
    name: "pendulum",
    description: "A physical pendulum, a bar on a hinge, swings from 150°. Its period is 4 K(sin 75°) √(L/g) with L = I/(m l), by the \
            arithmetic-geometric mean. The error is of second order; extrapolated from dt = 1 ms and 0.5 ms it is far smaller.",
    run: pendulum,
    slow: false,
};

pub(crate) const DOUBLE: Case = Case {
    name: "double pendulum",
    description: "Two point masses on rods of 1 m, released at 90° and 60°, for 10 s, against the Runge–Kutta method for both angles. The \
            deviation of the lower mass is of second order.",
    run: double,
    slow: true,
};

pub(crate) const SPHERICAL: Case = Case {
    name: "spherical pendulum",
    description: "A point mass on a rod of 1 m, released at 60° with a sideways velocity, for 10 s, against the Runge–Kutta method for its \
            coordinates. The angular momentum about the vertical is conserved.",
    run: spherical,
    slow: false,
};

pub(crate) const KAPITZA: Case = Case {
    name: "Kapitza's pendulum",
    description: "A bar of 0.2 m on a support that shakes with 15 mm at 40 Hz, upside down, against the Runge–Kutta method for its angle. It \
            stays within its first angle, although it would fall without the shaking.",
    run: kapitza,
    slow: false,
};

pub(crate) const FOUCAULT: Case = Case {
    name: "Foucault's pendulum",
    description: "A pendulum of 1 m at a latitude of 30° on a planet of radius 1 km with g = 9.81 m/s², which turns at 0.01 rad/s and carries the \
            support (a prescribed motion). Its plane of oscillation turns by −Ω t sin 30° relative to the ground.",
    run: foucault,
    slow: true,
};

/// Where the bar begins (rad).
const START: f64 = 5.0 / 6.0 * PI;

/// The time (s) at which the bar passes its lowest point for the first time, in steps of `period/4/steps`.
fn quarter(period: f64, steps: u64) -> Result<(f64, f64), Error> {
    let dt = 0.25 * period / steps as f64;
    let end = DVec3::new(libm::sin(START), -libm::cos(START), 0.0);
    let mut world = world(dt)
        .body(bar("bar", 1.0, DVec3::ZERO, end)?)
        .joint(Joint::hinge(["bar", "world"], DVec3::ZERO, DVec3::Z))
        .build()?;
    world.steps(steps)?;
    // the rest is so short that the velocity is constant
    let body = world.body(0);
    let time = world.time() - body.position().x / body.velocity().x;
    Ok((time, world.constraint_error()))
}

fn pendulum() -> Outcome {
    let (mut a, mut b) = (1.0f64, libm::cos(0.5 * START));
    while (a - b).abs() > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    // I/(m l) of a bar of 1 m, with the little inertia about its own axis
    let period = TAU / (a * (G / (2.0 / 3.0)).sqrt());
    let steps = (0.25 * period / 1e-3).round() as u64;
    let (coarse, _) = quarter(period, steps)?;
    let (fine, error) = quarter(period, 2 * steps)?;
    let relative = |time: f64| 4.0 * time / period - 1.0;
    let order = libm::log2((relative(coarse) / relative(fine)).abs());
    let extrapolated = relative(richardson(coarse, fine));
    Ok(vec![
        Check::error("deviation of the period at dt = 1 ms, relative", relative(coarse), 2e-6, ""),
        Check::new("order of the deviation", 2.0, order, 0.02, ""),
        Check::error("deviation of the extrapolated period, relative", extrapolated, 1e-10, ""),
        Check::error("largest error of the hinge", error, 1e-14, "m"),
    ])
}

/// Rates of both angles from the vertical and their velocities, for two masses of 1 kg on rods of 1 m.
fn double_rates(_: f64, y: &[f64; 4]) -> [f64; 4] {
    let [a, b, u, v] = *y;
    let (sin, cos) = libm::sincos(a - b);
    let denominator = 2.0 - cos * cos;
    let (from_a, from_b) = (-v * v * sin - 2.0 * G * libm::sin(a), u * u * sin - G * libm::sin(b));
    [u, v, (from_a - cos * from_b) / denominator, (2.0 * from_b - cos * from_a) / denominator]
}

fn double_end(dt: f64) -> Result<(DVec3, World), Error> {
    let place = |angle: f64| DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0);
    let upper = place(0.5 * PI);
    let lower = upper + place(PI / 3.0);
    let mut world = world(dt)
        .body(point("upper", 1.0, upper)?)
        .body(point("lower", 1.0, lower)?)
        .joint(Joint::distance(["upper", "world"], [upper, DVec3::ZERO]))
        .joint(Joint::distance(["lower", "upper"], [lower, upper]))
        .build()?;
    step_until(&mut world, 10.0)?;
    Ok((world.body(1).position(), world))
}

fn double() -> Outcome {
    let mut y = [0.5 * PI, PI / 3.0, 0.0, 0.0];
    integrate(&mut y, (0.0, 10.0), 200_000, double_rates, |_| {});
    let exact =
        DVec3::new(libm::sin(y[0]) + libm::sin(y[1]), -libm::cos(y[0]) - libm::cos(y[1]), 0.0);
    let [(coarse, _), (fine, world)] = [double_end(2e-4)?, double_end(1e-4)?];
    let [coarse, fine] = [coarse, fine].map(|found| (found - exact).length());
    let energy = world.energy();
    let start = -G * (2.0 * 0.0 + 0.5);
    Ok(vec![
        Check::error("deviation of the lower mass after 10 s at dt = 0.1 ms", fine, 1e-3, "m"),
        Check::new("order of the deviation", 2.0, libm::log2(coarse / fine), 0.1, ""),
        Check::new("energy", start, energy.total(), 1e-6, "J"),
    ])
}

fn spherical() -> Outcome {
    let start = DVec3::new(libm::sin(PI / 3.0), -0.5, 0.0);
    let velocity = DVec3::Z * 1.5;
    let rate = |_: f64, y: &[f64; 6]| {
        let (x, v) = (DVec3::new(y[0], y[1], y[2]), DVec3::new(y[3], y[4], y[5]));
        let gravity = DVec3::NEG_Y * G;
        let a = gravity - x * ((v.length_squared() + gravity.dot(x)) / x.length_squared());
        [v.x, v.y, v.z, a.x, a.y, a.z]
    };
    let mut y = [start.x, start.y, start.z, velocity.x, velocity.y, velocity.z];
    integrate(&mut y, (0.0, 10.0), 100_000, rate, |_| {});
    let exact = DVec3::new(y[0], y[1], y[2]);
    let run = |dt: f64| -> Result<World, Error> {
        let mut world = world(dt)
            .body(point("bob", 1.0, start)?.velocity(velocity))
            .joint(Joint::distance(["bob", "world"], [start, DVec3::ZERO]))
            .build()?;
        step_until(&mut world, 10.0)?;
        Ok(world)
    };
    let [coarse, fine] = [run(2e-3)?, run(1e-3)?];
    let deviation = |world: &World| (world.body(0).position() - exact).length();
    let momentum = fine.body(0).position().cross(fine.body(0).velocity()).y;
    let order = libm::log2(deviation(&coarse) / deviation(&fine));
    Ok(vec![
        Check::error("deviation after 10 s at dt = 1 ms", deviation(&fine), 1e-4, "m"),
        Check::new("order of the deviation", 2.0, order, 0.05, ""),
        Check::new("angular momentum about y", start.cross(velocity).y, momentum, 1e-10, "kg·m²/s"),
    ])
}

fn kapitza() -> Outcome {
    let (amplitude, frequency, length, first) = (0.015, 40.0, 0.2, 0.2);
    let (rate, phase) = (TAU * frequency, 0.5 * PI);
    // upright is 0; the angle grows with x
    let equation = |t: f64, y: &[f64; 2]| {
        let support = -amplitude * rate * rate * libm::sin(rate * t + phase);
        [y[1], 1.5 / length * (G + support) * libm::sin(y[0])]
    };
    // the support begins at its highest place, without velocity
    let mut y = [first, 0.0];
    integrate(&mut y, (0.0, 2.0), 200_000, equation, |_| {});
    let run = |dt: f64| -> Result<[f64; 2], Error> {
        let oscillation = Some(Oscillation { amplitude: DVec3::Y * amplitude, frequency, phase });
        let support = Prescribed { oscillation, ..Prescribed::default() };
        let top = length * DVec3::new(libm::sin(first), libm::cos(first), 0.0);
        let mut world = world(dt)
            .body(point("support", 1.0, DVec3::ZERO)?.motion(Motion::Prescribed(support)))
            .body(bar("bar", 0.1, DVec3::ZERO, top)?)
            .joint(Joint::hinge(["bar", "support"], DVec3::ZERO, DVec3::NEG_Z))
            .build()?;
        let mut largest = 0.0f64;
        while world.time() < 2.0 - 0.5 * dt {
            world.step()?;
            largest = largest.max((first + world.joint(0).coordinate).abs());
        }
        Ok([first + world.joint(0).coordinate, largest])
    };
    let [[coarse, _], [fine, largest]] = [run(1e-4)?, run(5e-5)?];
    let (coarse, fine) = ((coarse - y[0]).abs(), (fine - y[0]).abs());
    Ok(vec![
        Check::error("deviation of the angle after 2 s at dt = 0.05 ms", fine, 1e-4, "rad"),
        Check::new("order of the deviation", 2.0, libm::log2(coarse / fine), 0.1, ""),
        Check::new("largest angle from the upright", 0.5 * first, largest, 0.75 * first, "rad"),
    ])
}

/// Angle (rad) of the direction of oscillation relative to the ground at the end, from north.
fn foucault() -> Outcome {
    let (radius, rotation, latitude, duration) = (1000.0, 0.01, PI / 6.0, 60.0);
    let (dt, length, amplitude) = (2e-3, 1.0, 0.02);
    // the axis of the planet is y
    let up = DVec3::new(libm::cos(latitude), libm::sin(latitude), 0.0);
    let omega = DVec3::Y * rotation;
    let pivot = up * radius;
    // plumb line: gravity and centrifugal force
    let gravity = up * -G;
    let plumb = (gravity - omega.cross(omega.cross(pivot))).normalize();
    let east = omega.cross(up).normalize();
    let north = east.cross(plumb);
    let start = pivot + (plumb + north * amplitude).normalize() * length;
    let planet = rigid("planet", 1.0, DVec3::ONE, DVec3::ZERO)?
        .angular_velocity(omega)
        .motion(Motion::Prescribed(Prescribed::default()));
    let mut world = World::builder()
        .dt(dt)
        .gravity(DVec3::ZERO)
        .central_gravity(CentralGravity { gm: G * radius * radius, at: DVec3::ZERO })
        .body(planet)
        .body(point("bob", 1.0, start)?.velocity(omega.cross(start)))
        .joint(Joint::distance(["bob", "planet"], [start, pivot]))
        .build()?;
    // the direction of oscillation is the principal axis of the places of the last few swings
    let mut moments = [0.0; 3];
    while world.time() < duration {
        world.step()?;
        let t = world.time();
        if t < duration - 6.0 {
            continue;
        }
        let back = tumble::DQuat::from_axis_angle(DVec3::Y, -rotation * t);
        let place = back * world.body(1).position() - pivot;
        let (e, n) = (place.dot(east), place.dot(north));
        moments[0] += e * e;
        moments[1] += e * n;
        moments[2] += n * n;
    }
    // from north towards east
    let angle = 0.5 * libm::atan2(2.0 * moments[1], moments[2] - moments[0]);
    let expected = rotation * libm::sin(latitude) * (duration - 3.0);
    Ok(vec![Check::new(
        "angle of the plane from north, clockwise",
        expected,
        angle,
        0.01 * expected,
        "rad",
    )])
}
