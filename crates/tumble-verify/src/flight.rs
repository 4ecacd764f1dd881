//! Motion without contact. Every case has an exact solution, which must be met with any time step.

use std::f64::consts::{FRAC_PI_2, TAU};

use tumble::{Body, DQuat, DVec3, Integrator, MassModel, Primitive, Sampling, Shape, World};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{G, body_with_moments, step_until};

/// Time steps (s); the error must not depend on them.
const STEPS: [f64; 3] = [1e-3, 0.02, 0.1];

pub(crate) const FREE_FALL: Case = Case {
    name: "free fall",
    description: "A body thrown in vacuum follows the parabola x₀ + v₀ t + g t²/2.",
    run: free_fall,
    slow: false,
};

pub(crate) const DRAG: Case = Case {
    name: "drag",
    description: "A body thrown through a medium has the velocity v(t) = g/γ + (v₀ − g/γ) e^(−γ t), and its angular momentum L \
            decays as e^(−γ t). A symmetric top in the medium follows a closed form. A solid ball keeps its terminal speed.",
    run: drag,
    slow: false,
};

pub(crate) const TUMBLING: Case = Case {
    name: "tumbling",
    description: "A body with the moments of inertia (1, 2, 3) kg·m² and ω₀ = (0.01, 5, 0.01) rad/s rotates freely for 20 s. The \
            reference orientation is a Taylor series of order 40, computed with 40 digits.",
    run: tumbling,
    slow: false,
};

pub(crate) const PRECESSION: Case = Case {
    name: "symmetric top",
    description: "A symmetric top precesses about L at the rate L/I₁ and spins about its axis, in closed form.",
    run: precession,
    slow: false,
};

pub(crate) const RACKET: Case = Case {
    name: "tennis racket",
    description: "A body that spins close to its intermediate axis turns over twice a period. The complete elliptic integral of \
            Euler's equations gives the period.",
    run: racket,
    slow: false,
};

pub(crate) const MOMENTUM: Case = Case {
    name: "momentum",
    description: "A body without gravity, drag or contact keeps its momentum, angular momentum and energy for 10⁵ steps.",
    run: momentum,
    slow: false,
};

fn free_fall() -> Outcome {
    let (v, g) = (DVec3::new(4.0, 2.0, 3.0), DVec3::new(0.0, -G, 0.0));
    let mut checks = Vec::new();
    for dt in STEPS {
        let body = body_with_moments(DVec3::ONE)?.velocity(v);
        let mut world = World::builder().dt(dt).body(body).build()?;
        step_until(&mut world, 2.0)?;
        let error = (world.body(0).position() - (v * 2.0 + g * 2.0)).length();
        checks.push(Check::error(
            format!("position error after 2 s, dt = {dt} s"),
            error,
            1e-11,
            "m",
        ));
    }
    Ok(checks)
}

fn drag() -> Outcome {
    let (v, g, time) = (DVec3::new(4.0, 2.0, 3.0), DVec3::new(0.0, -G, 0.0), 2.0);
    let mut checks = Vec::new();
    for (c, dt) in [(1.0, 1e-3), (1.0, 0.1), (50.0, 0.1), (1e4, 1e-3)] {
        // four particles of 1 kg: γ = c
        let points = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO];
        let body = Body::new(Shape::from_particles(&points)?).position(DVec3::ZERO).velocity(v);
        let body = body.angular_velocity(DVec3::new(1.0, 2.0, 3.0));
        let world = World::builder().dt(dt).velocity_damping_stiffness(c).body(body);
        let mut world = world.build()?;
        let start = world.body(0).angular_momentum().length();
        step_until(&mut world, time)?;
        let decay = libm::exp(-c * time);
        let expected = g / c * time + (v - g / c) * ((1.0 - decay) / c);
        let error = (world.body(0).position() - expected).length();
        let setting = format!("c = {c} N·s/m, dt = {dt} s");
        let quantity = format!("position error after 2 s, {setting}");
        checks.push(Check::error(quantity, error, 1e-11, "m"));
        let momentum = world.body(0).angular_momentum().length() / start;
        let quantity = format!("L/L₀ after 2 s, {setting}");
        checks.push(Check::new(quantity, decay, momentum, 1e-12 * decay, ""));
    }
    checks.push(top_in_drag()?);
    for product in [0.1, 1.0, 10.0] {
        checks.push(terminal_speed(product)?);
    }
    Ok(checks)
}

/// A symmetric top of six particles, four on a square and two on its axis, in a medium.
///
/// Its orientation after the time t is that of a top without drag after the time (1 − e^(−γ t))/γ.
fn top_in_drag() -> Result<Check, Error> {
    let points = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z * 0.5, DVec3::Z * -0.5];
    let (across, along, c, time) = (2.5, 4.0, 0.7, 2.0);
    let omega = DVec3::new(3.0, 0.0, 11.0);
    let body = Body::new(Shape::from_particles(&points)?).angular_velocity(omega);
    let world = World::builder().gravity(DVec3::ZERO).velocity_damping_stiffness(c).dt(0.05);
    let mut world = world.body(body).build()?;
    step_until(&mut world, time)?;
    let time_without_drag = -libm::expm1(-c * time) / c;
    let expected = closed_form_top(across, along, omega, time_without_drag);
    let error = angle(world.body(0).orientation(), expected);
    let quantity = "orientation error of a symmetric top with drag after 2 s, dt = 0.05 s";
    Ok(Check::error(quantity, error, 1e-11, "rad"))
}

/// A solid ball of N particles falls at the terminal speed M g/(N c).
///
/// `product` is the time step times the rate N c/M at which drag slows the ball; it may exceed 1.
fn terminal_speed(product: f64) -> Result<Check, Error> {
    let ball = Primitive::Sphere { radius: 0.1, subdivisions: 1 }.mesh()?;
    let shape = Shape::from_mesh(&ball, Sampling::Vertices, MassModel::Solid)?;
    let (mass, c) = (1.0, 1.0);
    let rate = c * shape.moments().count / mass;
    let body = Body::new(shape).mass(mass).velocity(DVec3::Y * (-G / rate));
    let world = World::builder().velocity_damping_stiffness(c).dt(product / rate).body(body);
    let mut world = world.build()?;
    let start = world.body(0).position().y;
    for _ in 0..100 {
        world.step()?;
    }
    let speed = (start - world.body(0).position().y) / world.time();
    let quantity = format!("terminal speed of a solid ball, dt × rate = {product}");
    Ok(Check::new(quantity, G / rate, speed, 1e-12, "m/s"))
}

/// Orientation of a free symmetric top after `time` (s), R(t) = exp(L t/I_across) exp(e_z (1/I_along − 1/I_across) L_z t).
///
/// `along` is its moment about the axis z, `across` that about x and y (kg·m²); `omega` (rad/s) is its
/// angular velocity at the start, where R = 1.
fn closed_form_top(across: f64, along: f64, omega: DVec3, time: f64) -> DQuat {
    let momentum = DVec3::new(across, across, along) * omega;
    let precession =
        DQuat::from_axis_angle(momentum.normalize(), momentum.length() / across * time);
    precession * DQuat::from_rotation_z((1.0 / along - 1.0 / across) * momentum.z * time)
}

/// Orientation (w, x, y, z) of the tumbling body after 20 s, by `bench/tumbling/reference.py` (mpmath 1.3).
const REFERENCE: [f64; 4] = [
    -0.709_562_695_226_128_5,
    -0.000_671_189_134_824_091_1,
    -0.704_637_374_307_752_2,
    -0.002_549_858_281_215_700_2,
];

/// Errors of the tumbling body after 20 s.
struct TumblingErrors {
    /// Relative change of the energy.
    energy: f64,
    /// Relative change of |L|.
    momentum: f64,
    /// Angle between the orientation and the reference (rad).
    angle: f64,
}

fn tumbling_errors(integrator: Integrator, dt: f64) -> Result<TumblingErrors, Error> {
    let body =
        body_with_moments(DVec3::new(1.0, 2.0, 3.0))?.angular_velocity(DVec3::new(0.01, 5.0, 0.01));
    let world = World::builder().integrator(integrator).gravity(DVec3::ZERO).dt(dt).body(body);
    let mut world = world.build()?;
    let (energy, momentum) = (world.energy().total(), world.body(0).angular_momentum().length());
    step_until(&mut world, 20.0)?;
    let [w, x, y, z] = REFERENCE;
    Ok(TumblingErrors {
        energy: world.energy().total() / energy - 1.0,
        momentum: world.body(0).angular_momentum().length() / momentum - 1.0,
        angle: angle(world.body(0).orientation(), DQuat::from_xyzw(x, y, z, w)),
    })
}

/// Angle between two orientations (rad).
fn angle(a: DQuat, b: DQuat) -> f64 {
    let difference = if a.dot(b) < 0.0 { a + b } else { a - b };
    4.0 * libm::asin((0.5 * difference.length()).min(1.0))
}

fn tumbling() -> Outcome {
    let mut checks = Vec::new();
    // the last two steps contain many revolutions
    for dt in STEPS.into_iter().chain([4.0, 20.0]) {
        let TumblingErrors { energy, momentum, angle } =
            tumbling_errors(Integrator::Splitting, dt)?;
        checks.push(Check::error(format!("orientation, dt = {dt} s"), angle, 1e-11, "rad"));
        checks.push(Check::error(format!("energy, relative, dt = {dt} s"), energy, 1e-14, ""));
        checks.push(Check::error(format!("|L|, relative, dt = {dt} s"), momentum, 1e-15, ""));
    }
    // Explicit Euler drifts. An independent implementation of the same equations gives these errors.
    let TumblingErrors { energy, momentum, angle } = tumbling_errors(Integrator::Euler, 1e-3)?;
    checks.push(Check::error("|L|, relative, euler, dt = 0.001 s", momentum, 1e-14, ""));
    checks.push(Check::new("orientation, euler, dt = 0.001 s", 1.9, angle, 0.1, "rad"));
    checks.push(Check::new("energy, relative, euler, dt = 0.001 s", 6.3e-2, energy, 1e-3, ""));
    Ok(checks)
}

fn precession() -> Outcome {
    let mut checks = Vec::new();
    for (name, across, along) in [("prolate", 2.0, 0.5), ("oblate", 1.0, 1.9)] {
        for dt in STEPS {
            let omega = DVec3::new(3.0, 0.0, 11.0);
            let moments = DVec3::new(across, across, along);
            let body = body_with_moments(moments)?.angular_velocity(omega);
            let mut world = World::builder().gravity(DVec3::ZERO).dt(dt).body(body).build()?;
            step_until(&mut world, 10.0)?;
            let expected = closed_form_top(across, along, omega, 10.0);
            let error = angle(world.body(0).orientation(), expected);
            let quantity = format!("orientation error of a {name} top after 10 s, dt = {dt} s");
            checks.push(Check::error(quantity, error, 1e-11, "rad"));
        }
    }
    Ok(checks)
}

fn racket() -> Outcome {
    let (i, omega) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.01, 5.0, 0.01));
    let (energy2, momentum2) = (i.dot(omega * omega), (i * omega).length_squared());
    // L. D. Landau & E. M. Lifshitz, Mechanics, § 37, for L² > 2 E I₂
    let rate = ((i.z - i.y) * (momentum2 - energy2 * i.x) / (i.x * i.y * i.z)).sqrt();
    let k2 =
        (i.y - i.x) * (energy2 * i.z - momentum2) / ((i.z - i.y) * (momentum2 - energy2 * i.x));
    let period = 4.0 * complete_elliptic(k2) / rate;
    let mut checks = Vec::new();
    for step_count in [100, 10_000] {
        let dt = period / f64::from(step_count);
        let body = body_with_moments(i)?.angular_velocity(omega);
        let mut world = World::builder().gravity(DVec3::ZERO).dt(dt).body(body).build()?;
        let body_omega = |world: &World| {
            world.body(0).orientation().inverse() * world.body(0).angular_velocity()
        };
        let mut flips = 0;
        for _ in 0..step_count {
            let before = body_omega(&world).y;
            world.step()?;
            flips += u32::from(before * body_omega(&world).y < 0.0);
        }
        let error = (body_omega(&world) - omega).length() / omega.length();
        let quantity = format!("flips in one period, {step_count} steps");
        checks.push(Check::new(quantity, 2.0, flips.into(), 0.0, ""));
        let quantity = format!("error of ω after one period, relative, {step_count} steps");
        let remark = format!("period {period:.9} s");
        checks.push(Check::error(quantity, error, 1e-9, "").remark(remark));
    }
    Ok(checks)
}

/// The complete elliptic integral K(k) = ∫ dφ/√(1 − k² sin²φ), φ from 0 to π/2.
///
/// This is the trapezoidal rule, which converges faster than any power for a smooth periodic function.
/// `tumble` uses the arithmetic-geometric mean instead, so the two are independent.
fn complete_elliptic(k2: f64) -> f64 {
    let count = 200_000;
    let sum: f64 = (0..count)
        .map(|n| {
            let s = libm::sin(TAU * (f64::from(n) + 0.5) / f64::from(count));
            1.0 / (1.0 - k2 * s * s).sqrt()
        })
        .sum();
    FRAC_PI_2 * sum / f64::from(count)
}

fn momentum() -> Outcome {
    let body = body_with_moments(DVec3::new(1.0, 1.7, 2.2))?
        .velocity(DVec3::new(0.1, -0.2, 0.3))
        .angular_velocity(DVec3::new(30.0, -20.0, 10.0));
    let mut world = World::builder().gravity(DVec3::ZERO).dt(1e-3).body(body).build()?;
    let (v, l, e) =
        (world.body(0).velocity(), world.body(0).angular_momentum(), world.energy().total());
    step_until(&mut world, 100.0)?;
    let velocity_change = (world.body(0).velocity() - v).length();
    let momentum_change = (world.body(0).angular_momentum() - l).length();
    Ok(vec![
        Check::error("change of velocity", velocity_change, 0.0, "m/s"),
        Check::error("change of angular momentum", momentum_change, 0.0, "kg·m²/s"),
        Check::error("change of energy, relative", world.energy().total() / e - 1.0, 1e-14, ""),
    ])
}
