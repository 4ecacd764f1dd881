//! Bodies that meet each other: what their impacts conserve, and what the pencil says of them.

use std::f64::consts::PI;

use tumble::{
    Body, DMat3, DQuat, DVec3, Damping, Integrator, MassModel, Material, Mesh, Primitive, Sampling,
    Shape, Surface, World, WorldBuilder,
};

use crate::check::{Case, Check, Outcome};
use crate::flight::run;

type Error = Box<dyn std::error::Error>;

pub(crate) const COLLISION: Case = Case {
    name: "collision",
    about: "a knot, a box and a clump collide in free space, rough and damped: momentum, angular momentum, and in each step \
            the sum of all contact forces and torques about the origin, each as a part of what is summed",
    run: collision,
    slow: false,
};

pub(crate) const LEDGER: Case = Case {
    name: "collision ledger",
    about: "the same collision: the energy that is unaccounted for at the end, as a part of that at the start, with dt, dt/4 \
            and dt/16",
    run: ledger,
    slow: false,
};

pub(crate) const ORDER: Case = Case {
    name: "meeting order",
    about: "two balls of unequal mass, pressed together and let go, against the harmonic motion, with dt and dt/2",
    run: order,
    slow: false,
};

pub(crate) const CRADLE: Case = Case {
    name: "cradle",
    about: "Newton's cradle: one of five equal elastic balls hits the others. With gaps each impact is one of two balls, and the last \
            one gets all; without, five masses on one-sided springs in a row, integrated by Runge and Kutta's method",
    run: cradle,
    slow: false,
};

pub(crate) const UNEQUAL: Case = Case {
    name: "two balls",
    about: "two unequal balls, head on: they part at e times the speed at which they met, and share it as momentum has it",
    run: unequal,
    slow: false,
};

pub(crate) const OBLIQUE: Case = Case {
    name: "oblique impact",
    about: "two rough balls of 2/5 m R². Sliding throughout, the tangential impulse is μ times the normal one; sticking without loss, \
            the slip u turns into u cos(π √(7/2 k_t/k)): a super ball where k_t = 2/7 k",
    run: oblique,
    slow: false,
};

/// A solid ball of one sphere.
pub(crate) fn ball(radius: f64, mass: f64) -> Result<Body, Error> {
    let gyration = DMat3::IDENTITY * (0.4 * radius * radius);
    let shape = Shape::of_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, gyration)?;
    Ok(Body::new(shape).mass(mass).surface(Surface::Spheres { radius }))
}

/// A body of a mesh.
pub(crate) fn solid(primitive: Primitive) -> Result<Body, Error> {
    let shape = Shape::of_mesh(&primitive.mesh()?, Sampling::Vertices, MassModel::Solid)?;
    Ok(Body::new(shape).surface(Surface::Mesh))
}

/// A material of this stiffness (N/m), restitution and friction.
pub(crate) fn material(k: f64, e: f64, friction: f64) -> Material {
    Material {
        collision_stiffness: k,
        damping: Damping::Restitution(e),
        friction_stiffness: friction,
        ..Material::default()
    }
}

fn space(material: Material, dt: f64) -> WorldBuilder {
    World::builder().gravity(DVec3::ZERO).material(material).dt(dt)
}

/// Three odd bodies on their way to each other.
fn odd_bodies(integrator: Integrator, dt: f64) -> Result<World, Error> {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.4, 0.9)];
    let clump = Shape::of_particles(&corners.map(|corner| corner * 0.1))?;
    let clump = Body::new(clump).mass(1.5).surface(Surface::Spheres { radius: 0.05 });
    let knot = solid(Primitive::Knot { radius: 0.08, tube_radius: 0.025, segments: 12 })?;
    let cuboid = solid(Primitive::Box { size: DVec3::new(0.2, 0.1, 0.15), divisions: 4 })?;
    let turned = DQuat::from_xyzw(0.3, -0.2, 0.5, 0.8);
    let world = space(material(1e5, 0.5, 0.4), dt)
        .integrator(integrator)
        .body(clump.position(DVec3::new(-0.35, 0.03, 0.0)).velocity(DVec3::X * 2.0))
        .body(
            cuboid
                .mass(2.0)
                .orientation(turned)
                .position(DVec3::new(0.0, 0.0, 0.02))
                .angular_velocity(DVec3::new(3.0, -7.0, 2.0)),
        )
        .body(knot.mass(1.0).position(DVec3::new(0.4, 0.06, 0.0)).velocity(DVec3::X * -3.0));
    Ok(world.build()?)
}

/// Vectors that should cancel, or stay: their sum, and how long they are together.
#[derive(Clone, Copy, Default)]
struct Sum {
    vector: DVec3,
    length: f64,
}

impl Sum {
    fn add(&mut self, vector: DVec3) {
        self.vector += vector;
        self.length += vector.length();
    }

    /// How far it is from another, as a part of what is summed.
    fn off(&self, other: &Self) -> f64 {
        (self.vector - other.vector).length() / self.length.max(other.length)
    }
}

/// Σ M v, and Σ x × M v + L.
fn momenta(world: &World) -> [Sum; 2] {
    let mut sums = [Sum::default(); 2];
    for body in world.bodies() {
        let momentum = body.velocity() * body.model().mass;
        sums[0].add(momentum);
        sums[1].add(body.position().cross(momentum));
        sums[1].add(body.angular_momentum());
    }
    sums
}

/// Σ F and Σ x × F + τ of the latest step, as parts of what is summed, if there is anything.
fn unbalanced(world: &World, places: &[DVec3]) -> Option<[f64; 2]> {
    let (mut force, mut torque) = (Sum::default(), Sum::default());
    for (index, place) in places.iter().enumerate() {
        let wrench = world.contact_wrench(index);
        force.add(wrench.force);
        torque.add(place.cross(wrench.force));
        torque.add(wrench.torque);
    }
    let none = Sum::default();
    (force.length > 0.0).then(|| [force.off(&none), torque.off(&none)])
}

fn collision() -> Outcome {
    let mut checks = Vec::new();
    for integrator in [Integrator::Splitting, Integrator::Euler] {
        let mut world = odd_bodies(integrator, 5e-5)?;
        let start = momenta(&world);
        let (mut worst, mut touched) = ([0.0f64; 2], 0u32);
        while world.time() < 0.2 {
            let before: Vec<_> = world.bodies().map(|body| body.position()).collect();
            world.step()?;
            // forces act where the bodies are in the middle of a step, or at its start
            let half = 0.5 * world.dt();
            let middle = |(body, before): (tumble::BodyView, &DVec3)| match integrator {
                Integrator::Splitting => body.position() - body.velocity() * half,
                Integrator::Euler => *before,
            };
            let places: Vec<_> = world.bodies().zip(&before).map(middle).collect();
            if let Some(off) = unbalanced(&world, &places) {
                touched += 1;
                worst = [worst[0].max(off[0]), worst[1].max(off[1])];
            }
        }
        let end = momenta(&world);
        let name = integrator.name();
        let steps = format!("{touched} of {} steps in contact", world.state().step);
        let mut add = |quantity: &str, off: f64, bound: f64| {
            let quantity = format!("{quantity}, {name}");
            checks.push(Check::error(quantity, off, bound, "").remark(steps.clone()));
        };
        add("momentum", end[0].off(&start[0]), 1e-14);
        // places are rounded in each of 4,000 steps
        add("angular momentum", end[1].off(&start[1]), 5e-13);
        add("sum of forces", worst[0], 1e-14);
        add("sum of torques", worst[1], 1e-13);
    }
    Ok(checks)
}

fn ledger() -> Outcome {
    let mut checks = Vec::new();
    for (integrator, bound) in [(Integrator::Splitting, 1e-4), (Integrator::Euler, 2e-3)] {
        let residual = |dt: f64| -> Result<f64, Error> {
            let mut world = odd_bodies(integrator, dt)?;
            let start = world.energy().total();
            run(&mut world, 0.4)?;
            Ok((world.energy().total() / start - 1.0).abs())
        };
        let found = [residual(8e-5)?, residual(2e-5)?, residual(5e-6)?];
        let order = 0.25 * libm::log2(found[0] / found[2]);
        let [a, b, c] = found;
        let remark = format!("{a:.1e}, {b:.1e}, {c:.1e}: order {order:.2} or so");
        let quantity = format!("residual with dt = 5e-6 s, {}", integrator.name());
        checks.push(Check::error(quantity, c, bound, "").remark(remark));
    }
    Ok(checks)
}

fn order() -> Outcome {
    let (k, radius, depth) = (1e4, 0.1, 0.005);
    let (light, heavy) = (0.2, 0.7);
    let omega = f64::sqrt(k * (1.0 / light + 1.0 / heavy));
    // a fifth of the time in which they part
    let time = 0.2 * PI / omega;
    let mut checks = Vec::new();
    for (integrator, expected) in [(Integrator::Euler, 1.0), (Integrator::Splitting, 2.0)] {
        let off = |steps: u32| -> Result<f64, Error> {
            let apart = DVec3::X * (2.0 * radius - depth);
            let mut world = space(material(k, 1.0, 0.0), time / f64::from(steps))
                .integrator(integrator)
                .body(ball(radius, light)?)
                .body(ball(radius, heavy)?.position(apart))
                .build()?;
            (0..steps).try_for_each(|_| world.step())?;
            let apart = world.body(1).position().x - world.body(0).position().x;
            let speed = world.body(1).velocity().x - world.body(0).velocity().x;
            let (sin, cos) = libm::sincos(omega * time);
            let (x, v) = (apart - 2.0 * radius + depth * cos, speed - depth * omega * sin);
            Ok(libm::hypot(x, v / omega))
        };
        let found = libm::log2(off(50)? / off(100)?);
        let quantity = format!("order of {}", integrator.name());
        checks.push(Check::new(quantity, expected, found, 0.1, ""));
    }
    Ok(checks)
}

/// Speeds of five equal masses in a row after the first has hit them at 1 m/s, without gaps between them: springs of k/m = ω² that
/// push and never pull, by the classical Runge–Kutta method.
fn row_of_springs(omega: f64) -> [f64; 5] {
    type Row = [f64; 10];
    let rate = |row: &Row| {
        let mut rate: Row = [0.0; 10];
        rate[..5].copy_from_slice(&row[5..]);
        for i in 0..4 {
            let push = omega * omega * (row[i] - row[i + 1]).max(0.0);
            rate[5 + i] -= push;
            rate[6 + i] += push;
        }
        rate
    };
    let after = |row: &Row, rate: &Row, h: f64| {
        let mut next = *row;
        next.iter_mut().zip(rate).for_each(|(x, rate)| *x += h * rate);
        next
    };
    let mut row: Row = [0.0; 10];
    row[5] = 1.0;
    let h = 1e-3 / omega;
    // they are all apart after some ten times 1/ω
    for _ in 0..40_000 {
        let a = rate(&row);
        let b = rate(&after(&row, &a, 0.5 * h));
        let c = rate(&after(&row, &b, 0.5 * h));
        let d = rate(&after(&row, &c, h));
        let mut mean: Row = [0.0; 10];
        for i in 0..10 {
            mean[i] = (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0;
        }
        row = after(&row, &mean, h);
    }
    [row[5], row[6], row[7], row[8], row[9]]
}

fn cradle() -> Outcome {
    let (k, mass, radius) = (1e6, 0.1, 0.02);
    let omega = f64::sqrt(k / mass);
    let mut checks = Vec::new();
    // with gaps wider than the way of a ball during an impact, and without
    for (gap, expected) in [(1e-3, [0.0, 0.0, 0.0, 0.0, 1.0]), (0.0, row_of_springs(omega))] {
        let mut world = space(material(k, 1.0, 0.0), 1e-6);
        for number in 0..5 {
            let place = f64::from(number) * (2.0 * radius + gap);
            let start = if number == 0 { -0.01 } else { place };
            let speed = if number == 0 { 1.0 } else { 0.0 };
            world = world
                .body(ball(radius, mass)?.position(DVec3::X * start).velocity(DVec3::X * speed));
        }
        let mut world = world.build()?;
        run(&mut world, 0.03)?;
        let name = if gap > 0.0 { "with gaps" } else { "without gaps" };
        for number in [0, 3, 4] {
            let speed = world.body(number).velocity().x;
            let quantity = format!("speed of ball {} {name}", number + 1);
            checks.push(Check::new(quantity, expected[number], speed, 1e-3, "m/s"));
        }
    }
    Ok(checks)
}

fn unequal() -> Outcome {
    let (k, radius, light, heavy) = (1e5, 0.05, 0.2, 0.7);
    let mut checks = Vec::new();
    for e in [0.2, 0.5, 0.9] {
        let mut world = space(material(k, e, 0.3), 2e-6)
            .body(ball(radius, light)?.position(DVec3::X * -0.06).velocity(DVec3::X))
            .body(ball(0.5 * radius, heavy)?.position(DVec3::X * 0.02))
            .build()?;
        run(&mut world, 0.05)?;
        let [a, b] = [0, 1].map(|index| world.body(index).velocity().x);
        checks.push(Check::new(format!("speed apart, e = {e}"), e, b - a, 0.01 * e, "m/s"));
        let shared = (1.0 + e) * light / (light + heavy);
        let quantity = format!("speed of the ball that was hit, e = {e}");
        checks.push(Check::new(quantity, shared, b, 0.01 * shared, "m/s"));
    }
    Ok(checks)
}

/// Two equal balls that touch along y, the upper one coming down at 1 m/s and going along x at `along` (m/s): the speed of the one along the
/// other at their contact, and the upper one's spin about z, afterwards.
fn glance(material: Material, along: f64) -> Result<[f64; 2], Error> {
    let (radius, mass) = (0.05, 0.1);
    let velocity = DVec3::new(along, -1.0, 0.0);
    // so that they touch when the one is above the other
    let early = 1e-3;
    let above = DVec3::Y * (2.0 * radius) - velocity * early;
    let mut world = space(material, 1e-7)
        .body(ball(radius, mass)?)
        .body(ball(radius, mass)?.position(above).velocity(velocity))
        .build()?;
    run(&mut world, 2.0 * early)?;
    let [lower, upper] = [world.body(0), world.body(1)];
    let (a, b) = (lower.angular_velocity().z, upper.angular_velocity().z);
    let slip = upper.velocity().x - lower.velocity().x + radius * (a + b);
    Ok([slip, radius * b])
}

fn oblique() -> Outcome {
    let k = 1e8;
    let mut checks = Vec::new();
    // with J = (1 + e) M v/2 for equal balls, friction μ J turns each by 5/2 μ J/(M R)
    for (e, friction, along) in [(0.9, 0.2, 4.0), (0.5, 0.1, -2.0)] {
        let [slip, spin] = glance(material(k, e, friction), along)?;
        let push = friction * (1.0 + e) * f64::signum(along);
        let name = format!("μ = {friction}, e = {e}, sliding at {along} m/s");
        let bound = 0.01 * push.abs() * 3.5;
        checks.push(Check::new(
            format!("slip left, {name}"),
            along - 3.5 * push,
            slip,
            bound,
            "m/s",
        ));
        let bound = 0.01 * push.abs();
        checks.push(Check::new(format!("ω R, {name}"), -1.25 * push, spin, bound, "m/s"));
    }
    for part in [2.0 / 7.0, 1.0 / 7.0] {
        let spring = Material {
            friction_spring: Some(part * k),
            friction_damping: Some(0.0),
            ..material(k, 1.0, 5.0)
        };
        let along = 0.5;
        let [slip, _] = glance(spring, along)?;
        let expected = along * libm::cos(PI * f64::sqrt(3.5 * part));
        let quantity = format!("slip left, sticking, k_t = {part:.3} k");
        checks.push(Check::new(quantity, expected, slip, 0.01 * along, "m/s"));
    }
    Ok(checks)
}
