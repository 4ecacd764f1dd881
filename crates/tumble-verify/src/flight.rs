//! Flight: everything here has an exact solution, and any step must reach it.

use std::f64::consts::{FRAC_PI_2, TAU};

use tumble::{
    Body, DMat3, DQuat, DVec3, Integrator, MassModel, Mesh, Primitive, Sampling, Shape, World,
};

use crate::check::{Case, Check, Outcome};

type Error = Box<dyn std::error::Error>;

/// The steps that a flight must not mind (s).
const STEPS: [f64; 3] = [1e-3, 0.02, 0.1];

pub(crate) const FREE_FALL: Case = Case {
    name: "free fall",
    about: "a throw against the parabola x₀ + v₀ t + g t²/2",
    run: free_fall,
    slow: false,
};

pub(crate) const DRAG: Case = Case {
    name: "drag",
    about: "a throw through a medium against v(t) = g/γ + (v₀ − g/γ) e^(−γ t), the decay of L, and a \
            solid at its terminal speed",
    run: drag,
    slow: false,
};

pub(crate) const TUMBLING: Case = Case {
    name: "tumbling",
    about: "moments (1, 2, 3) kg·m², ω₀ = (0.01, 5, 0.01) rad/s for 20 s, against a Taylor series of order 40 \
            in numbers of 40 digits",
    run: tumbling,
    slow: false,
};

pub(crate) const PRECESSION: Case = Case {
    name: "symmetric top",
    about: "precession of a symmetric top about L at the rate L/I₁ and spin about its axis, in closed form",
    run: precession,
    slow: false,
};

pub(crate) const RACKET: Case = Case {
    name: "tennis racket",
    about: "the time between two turn-overs against the complete elliptic integral of Euler's equations",
    run: racket,
    slow: false,
};

pub(crate) const MOMENTUM: Case = Case {
    name: "momentum",
    about: "momentum, angular momentum and energy of a body in free flight for 10⁵ steps",
    run: momentum,
    slow: false,
};

/// A body of 1 kg with these principal moments (kg·m²) about x, y, z.
pub(crate) fn body(moments: DVec3) -> Result<Body, Error> {
    let points = [DVec3::X, -DVec3::X];
    let gyration = DMat3::from_diagonal(moments);
    let shape = Shape::of_distribution(&points, Mesh::default(), DVec3::ZERO, gyration)?;
    Ok(Body::new(shape).mass(1.0))
}

/// Steps a world until `time` (s).
pub(crate) fn run(world: &mut World, time: f64) -> Result<(), Error> {
    while world.state().step < (time / world.dt()).round() as u64 {
        world.step()?;
    }
    Ok(())
}

fn free_fall() -> Outcome {
    let (v, g) = (DVec3::new(4.0, 2.0, 3.0), DVec3::new(0.0, -9.8, 0.0));
    let mut checks = Vec::new();
    for dt in STEPS {
        let mut world = World::builder().dt(dt).body(body(DVec3::ONE)?.velocity(v)).build()?;
        run(&mut world, 2.0)?;
        let off = world.body(0).position() - (v * 2.0 + g * 2.0);
        checks.push(Check::error(
            format!("place after 2 s, dt = {dt} s"),
            off.length(),
            1e-11,
            "m",
        ));
    }
    Ok(checks)
}

fn drag() -> Outcome {
    let (v, g, time) = (DVec3::new(4.0, 2.0, 3.0), DVec3::new(0.0, -9.8, 0.0), 2.0);
    let mut checks = Vec::new();
    for (c, dt) in [(1.0, 1e-3), (1.0, 0.1), (50.0, 0.1), (1e4, 1e-3)] {
        // four particles of 1 kg: γ = c
        let points = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO];
        let body = Body::new(Shape::of_particles(&points)?).position(DVec3::ZERO).velocity(v);
        let body = body.angular_velocity(DVec3::new(1.0, 2.0, 3.0));
        let world = World::builder().dt(dt).velocity_damping_stiffness(c).body(body);
        let mut world = world.build()?;
        let start = world.body(0).angular_momentum().length();
        run(&mut world, time)?;
        let left = libm::exp(-c * time);
        let expected = g / c * time + (v - g / c) * ((1.0 - left) / c);
        let off = (world.body(0).position() - expected).length();
        let setting = format!("c = {c} N·s/m, dt = {dt} s");
        checks.push(Check::error(format!("place after 2 s, {setting}"), off, 1e-11, "m"));
        let momentum = world.body(0).angular_momentum().length() / start;
        let bound = 1e-12 * left;
        checks.push(Check::new(format!("L/L₀ after 2 s, {setting}"), left, momentum, bound, ""));
    }
    checks.push(top_in_drag()?);
    for product in [0.1, 1.0, 10.0] {
        checks.push(terminal_speed(product)?);
    }
    Ok(checks)
}

/// A symmetric top in a medium turns as one without does in the time (1 − e^(−γ t))/γ: here its mass sits
/// in four particles on a square and two above and below.
fn top_in_drag() -> Result<Check, Error> {
    let points = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z * 0.5, DVec3::Z * -0.5];
    let (across, along, c, time) = (2.5, 4.0, 0.7, 2.0);
    let omega = DVec3::new(3.0, 0.0, 11.0);
    let body = Body::new(Shape::of_particles(&points)?).angular_velocity(omega);
    let world = World::builder().gravity(DVec3::ZERO).velocity_damping_stiffness(c).dt(0.05);
    let mut world = world.body(body).build()?;
    run(&mut world, time)?;
    let free = -libm::expm1(-c * time) / c;
    let expected = closed_form_top(across, along, omega, free);
    let off = angle(world.body(0).orientation(), expected);
    Ok(Check::error("symmetric top in drag after 2 s, dt = 0.05 s", off, 1e-11, "rad"))
}

/// A solid ball falls at M g/(N c), also with a step of many times the time in which it slows down.
fn terminal_speed(product: f64) -> Result<Check, Error> {
    let ball = Primitive::Sphere { radius: 0.1, subdivisions: 1 }.mesh()?;
    let shape = Shape::of_mesh(&ball, Sampling::Vertices, MassModel::Solid)?;
    let (mass, c) = (1.0, 1.0);
    let rate = c * shape.moments().count / mass;
    let body = Body::new(shape).mass(mass).velocity(DVec3::Y * (-9.8 / rate));
    let world = World::builder().velocity_damping_stiffness(c).dt(product / rate).body(body);
    let mut world = world.build()?;
    let start = world.body(0).position().y;
    for _ in 0..100 {
        world.step()?;
    }
    let speed = (start - world.body(0).position().y) / world.time();
    let quantity = format!("terminal speed of a solid ball, step × rate = {product}");
    Ok(Check::new(quantity, 9.8 / rate, speed, 1e-12, "m/s"))
}

/// R(t) = exp(L t/I_across) exp(e_z (1/I_along − 1/I_across) L_z t).
fn closed_form_top(across: f64, along: f64, omega: DVec3, time: f64) -> DQuat {
    let momentum = DVec3::new(across, across, along) * omega;
    let about = DQuat::from_axis_angle(momentum.normalize(), momentum.length() / across * time);
    about * DQuat::from_rotation_z((1.0 / along - 1.0 / across) * momentum.z * time)
}

/// w, x, y, z after 20 s; computed with mpmath 1.3.
const TUMBLED: [f64; 4] = [
    -0.709_562_695_226_128_5,
    -0.000_671_189_134_824_091_1,
    -0.704_637_374_307_752_2,
    -0.002_549_858_281_215_700_2,
];

/// What the tumbling body looks like after 20 s.
pub(crate) struct Tumbled {
    /// Relative change of energy.
    pub energy: f64,
    /// Relative change of |L|.
    pub momentum: f64,
    /// Error of the orientation (rad).
    pub angle: f64,
}

pub(crate) fn tumble(integrator: Integrator, dt: f64) -> Result<Tumbled, Error> {
    let body = body(DVec3::new(1.0, 2.0, 3.0))?.angular_velocity(DVec3::new(0.01, 5.0, 0.01));
    let world = World::builder().integrator(integrator).gravity(DVec3::ZERO).dt(dt).body(body);
    let mut world = world.build()?;
    let (energy, momentum) = (world.energy().total(), world.body(0).angular_momentum().length());
    run(&mut world, 20.0)?;
    let [w, x, y, z] = TUMBLED;
    Ok(Tumbled {
        energy: world.energy().total() / energy - 1.0,
        momentum: world.body(0).angular_momentum().length() / momentum - 1.0,
        angle: angle(world.body(0).orientation(), DQuat::from_xyzw(x, y, z, w)),
    })
}

/// Angle between two orientations (rad).
fn angle(a: DQuat, b: DQuat) -> f64 {
    let apart = if a.dot(b) < 0.0 { a + b } else { a - b };
    4.0 * libm::asin((0.5 * apart.length()).min(1.0))
}

fn tumbling() -> Outcome {
    let mut checks = Vec::new();
    // even one step of many turns must do
    for dt in STEPS.into_iter().chain([4.0, 20.0]) {
        let Tumbled { energy, momentum, angle } = tumble(Integrator::Splitting, dt)?;
        checks.push(Check::error(format!("orientation, dt = {dt} s"), angle, 1e-11, "rad"));
        checks.push(Check::error(format!("energy, relative, dt = {dt} s"), energy, 1e-14, ""));
        checks.push(Check::error(format!("|L|, relative, dt = {dt} s"), momentum, 1e-15, ""));
    }
    // the basic system itself is known to drift, and by how much: an independent program found this
    let Tumbled { energy, momentum, angle } = tumble(Integrator::Euler, 1e-3)?;
    checks.push(Check::error("|L|, relative, euler, dt = 0.001 s", momentum, 1e-14, ""));
    checks.push(Check::new("orientation, euler, dt = 0.001 s", 1.9, angle, 0.1, "rad"));
    checks.push(Check::new("energy, relative, euler, dt = 0.001 s", 6.3e-2, energy, 1e-3, ""));
    Ok(checks)
}

fn precession() -> Outcome {
    let mut checks = Vec::new();
    for (name, across, along) in [("long", 2.0, 0.5), ("flat", 1.0, 1.9)] {
        for dt in STEPS {
            let omega = DVec3::new(3.0, 0.0, 11.0);
            let body = body(DVec3::new(across, across, along))?.angular_velocity(omega);
            let mut world = World::builder().gravity(DVec3::ZERO).dt(dt).body(body).build()?;
            run(&mut world, 10.0)?;
            let expected = closed_form_top(across, along, omega, 10.0);
            let off = angle(world.body(0).orientation(), expected);
            checks.push(Check::error(
                format!("{name} top after 10 s, dt = {dt} s"),
                off,
                1e-11,
                "rad",
            ));
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
    for pieces in [100, 10_000] {
        let dt = period / f64::from(pieces);
        let body = body(i)?.angular_velocity(omega);
        let mut world = World::builder().gravity(DVec3::ZERO).dt(dt).body(body).build()?;
        let own = |world: &World| {
            world.body(0).orientation().inverse() * world.body(0).angular_velocity()
        };
        let mut turned = 0;
        for _ in 0..pieces {
            let before = own(&world).y;
            world.step()?;
            turned += u32::from(before * own(&world).y < 0.0);
        }
        let off = (own(&world) - omega).length() / omega.length();
        let setting = format!("{pieces} steps");
        checks.push(Check::new(
            format!("turn-overs in one period, {setting}"),
            2.0,
            turned.into(),
            0.0,
            "",
        ));
        let remark = format!("period {period:.9} s");
        let check = Check::error(format!("ω after one period, relative, {setting}"), off, 1e-9, "");
        checks.push(check.remark(remark));
    }
    Ok(checks)
}

/// K(k) = ∫ dφ/√(1 − k² sin²φ) over a quarter turn, by the trapezoidal rule, which for a smooth
/// periodic function converges faster than any power; another way than the one in the program.
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
    let body = body(DVec3::new(1.0, 1.7, 2.2))?
        .velocity(DVec3::new(0.1, -0.2, 0.3))
        .angular_velocity(DVec3::new(30.0, -20.0, 10.0));
    let mut world = World::builder().gravity(DVec3::ZERO).dt(1e-3).body(body).build()?;
    let (v, l, e) =
        (world.body(0).velocity(), world.body(0).angular_momentum(), world.energy().total());
    run(&mut world, 100.0)?;
    let off = (world.body(0).velocity() - v).length();
    let spin = (world.body(0).angular_momentum() - l).length();
    Ok(vec![
        Check::error("velocity", off, 0.0, "m/s"),
        Check::error("angular momentum", spin, 0.0, "kg·m²/s"),
        Check::error("energy, relative", world.energy().total() / e - 1.0, 1e-14, ""),
    ])
}
