//! Collisions between free bodies: conservation laws, and impacts with a closed form.

use std::f64::consts::PI;

use tumble::{
    Body, DQuat, DVec3, Integrator, Material, Primitive, Shape, Surface, World, WorldBuilder,
};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{ball, material, mesh_body, step_until};

pub(crate) const COLLISION: Case = Case {
    name: "collision",
    description: "A knot, a box and a clump collide in free space, with friction and dashpots. Total momentum and angular momentum are \
            constant, and in each step the contact forces, and their torques about the origin, sum to zero. Errors are \
            relative to the sum of the magnitudes.",
    run: collision,
    slow: false,
};

pub(crate) const LEDGER: Case = Case {
    name: "collision ledger",
    description: "The same collision. The residual of the energy ledger at the end, relative to the energy at the start, with dt, dt/4 \
            and dt/16.",
    run: ledger,
    slow: false,
};

pub(crate) const ORDER: Case = Case {
    name: "meeting order",
    description: "Two balls of unequal mass are released from a compressed contact. Their error against the harmonic motion, with dt and \
            dt/2, gives the order of the integrator.",
    run: order,
    slow: false,
};

pub(crate) const CRADLE: Case = Case {
    name: "cradle",
    description: "Newton's cradle: one of five equal elastic balls hits the other four. With gaps the impacts are between two balls at a \
            time, and the last ball leaves with the full speed. Without gaps the reference is a chain of masses and one-sided springs, \
            integrated with the classical Runge–Kutta method.",
    run: cradle,
    slow: false,
};

pub(crate) const UNEQUAL: Case = Case {
    name: "two balls",
    description: "Two unequal balls collide head on. They separate at e times the approach speed, and momentum conservation gives the speed \
            of each.",
    run: unequal,
    slow: false,
};

pub(crate) const OBLIQUE: Case = Case {
    name: "oblique impact",
    description: "Oblique impact of two solid balls with friction. If they slide throughout, the tangential impulse is μ times the normal \
            impulse. If they stick without loss, the relative tangential velocity u becomes u cos(π √(7/2 k_t/k)), which is −u for \
            k_t = 2/7 k.",
    run: oblique,
    slow: false,
};

/// A world without gravity and walls.
fn free_space(material: Material, dt: f64) -> WorldBuilder {
    World::builder().gravity(DVec3::ZERO).material(material).dt(dt)
}

/// A clump, a box and a knot that are about to collide.
fn three_bodies(integrator: Integrator, dt: f64) -> Result<World, Error> {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.4, 0.9)];
    let clump = Shape::from_particles(&corners.map(|corner| corner * 0.1))?;
    let clump = Body::new(clump).mass(1.5).surface(Surface::Spheres { radius: 0.05 });
    let knot = mesh_body(Primitive::Knot { radius: 0.08, tube_radius: 0.025, segments: 12 })?;
    let cuboid = mesh_body(Primitive::Box { size: DVec3::new(0.2, 0.1, 0.15), divisions: 4 })?;
    let orientation = DQuat::from_xyzw(0.3, -0.2, 0.5, 0.8);
    let world = free_space(material(1e5, 0.5, 0.4), dt)
        .integrator(integrator)
        .body(clump.position(DVec3::new(-0.35, 0.03, 0.0)).velocity(DVec3::X * 2.0))
        .body(
            cuboid
                .mass(2.0)
                .orientation(orientation)
                .position(DVec3::new(0.0, 0.0, 0.02))
                .angular_velocity(DVec3::new(3.0, -7.0, 2.0)),
        )
        .body(knot.mass(1.0).position(DVec3::new(0.4, 0.06, 0.0)).velocity(DVec3::X * -3.0));
    Ok(world.build()?)
}

/// A sum of vectors, with the sum of their magnitudes as its scale.
#[derive(Clone, Copy, Default)]
struct Sum {
    vector: DVec3,
    magnitudes: f64,
}

impl Sum {
    fn add(&mut self, vector: DVec3) {
        self.vector += vector;
        self.magnitudes += vector.length();
    }

    /// The difference from another sum, relative to the larger scale.
    fn relative_difference(&self, other: &Self) -> f64 {
        (self.vector - other.vector).length() / self.magnitudes.max(other.magnitudes)
    }
}

/// Total momentum Σ M v and angular momentum about the origin Σ x × M v + L.
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

/// The sums Σ F and Σ x × F + τ over the contact wrenches of the latest step, relative to their scales.
///
/// `positions` are the centres of mass where the wrenches acted. `None` if no bodies were in contact.
fn net_wrench(world: &World, positions: &[DVec3]) -> Option<[f64; 2]> {
    let (mut force, mut torque) = (Sum::default(), Sum::default());
    for (index, position) in positions.iter().enumerate() {
        let wrench = world.contact_wrench(index);
        force.add(wrench.force);
        torque.add(position.cross(wrench.force));
        torque.add(wrench.torque);
    }
    let zero = Sum::default();
    (force.magnitudes > 0.0)
        .then(|| [force.relative_difference(&zero), torque.relative_difference(&zero)])
}

fn collision() -> Outcome {
    let mut checks = Vec::new();
    for integrator in [Integrator::Splitting, Integrator::Euler] {
        let mut world = three_bodies(integrator, 5e-5)?;
        let start = momenta(&world);
        let (mut worst, mut contact_steps) = ([0.0f64; 2], 0u32);
        while world.time() < 0.2 {
            let before: Vec<_> = world.bodies().map(|body| body.position()).collect();
            world.step()?;
            // `splitting` evaluates forces in the middle of a step, `euler` at its start
            let half = 0.5 * world.dt();
            let position = |(body, before): (tumble::BodyView, &DVec3)| match integrator {
                Integrator::Splitting | Integrator::Implicit => {
                    body.position() - body.velocity() * half
                }
                Integrator::Euler => *before,
            };
            let positions: Vec<_> = world.bodies().zip(&before).map(position).collect();
            if let Some(net) = net_wrench(&world, &positions) {
                contact_steps += 1;
                worst = [worst[0].max(net[0]), worst[1].max(net[1])];
            }
        }
        let end = momenta(&world);
        let name = integrator.name();
        let remark = format!("{contact_steps} of {} steps in contact", world.state().step);
        let mut add = |quantity: &str, error: f64, bound: f64| {
            let quantity = format!("{quantity}, {name}");
            checks.push(Check::error(quantity, error, bound, "").remark(remark.clone()));
        };
        add("change of momentum", end[0].relative_difference(&start[0]), 1e-14);
        // positions are rounded in each of 4,000 steps
        add("change of angular momentum", end[1].relative_difference(&start[1]), 5e-13);
        add("sum of forces", worst[0], 1e-14);
        add("sum of torques", worst[1], 1e-13);
    }
    Ok(checks)
}

fn ledger() -> Outcome {
    let mut checks = Vec::new();
    for (integrator, bound) in [(Integrator::Splitting, 1e-4), (Integrator::Euler, 2e-3)] {
        let residual = |dt: f64| -> Result<f64, Error> {
            let mut world = three_bodies(integrator, dt)?;
            let start = world.energy().total();
            step_until(&mut world, 0.4)?;
            Ok((world.energy().total() / start - 1.0).abs())
        };
        let [a, b, c] = [residual(8e-5)?, residual(2e-5)?, residual(5e-6)?];
        let order = 0.25 * libm::log2(a / c);
        let remark = format!("{a:.1e}, {b:.1e}, {c:.1e}: order about {order:.2}");
        let quantity = format!("residual with dt = 5e-6 s, {}", integrator.name());
        checks.push(Check::error(quantity, c, bound, "").remark(remark));
    }
    Ok(checks)
}

fn order() -> Outcome {
    let (k, radius, depth) = (1e4, 0.1, 0.005);
    let (light, heavy) = (0.2, 0.7);
    let omega = f64::sqrt(k * (1.0 / light + 1.0 / heavy));
    // short of their separation
    let time = 0.2 * PI / omega;
    let mut checks = Vec::new();
    let orders =
        [(Integrator::Euler, 1.0), (Integrator::Splitting, 2.0), (Integrator::Implicit, 2.0)];
    for (integrator, expected) in orders {
        let error = |step_count: u32| -> Result<f64, Error> {
            let distance = 2.0 * radius - depth;
            let mut world = free_space(material(k, 1.0, 0.0), time / f64::from(step_count))
                .integrator(integrator)
                .body(ball(radius, light)?)
                .body(ball(radius, heavy)?.position(DVec3::X * distance))
                .build()?;
            (0..step_count).try_for_each(|_| world.step())?;
            let distance = world.body(1).position().x - world.body(0).position().x;
            let speed = world.body(1).velocity().x - world.body(0).velocity().x;
            let (sin, cos) = libm::sincos(omega * time);
            let dx = distance - 2.0 * radius + depth * cos;
            let dv = speed - depth * omega * sin;
            Ok(libm::hypot(dx, dv / omega))
        };
        let order = libm::log2(error(50)? / error(100)?);
        let quantity = format!("order of {}", integrator.name());
        checks.push(Check::new(quantity, expected, order, 0.1, ""));
    }
    Ok(checks)
}

/// Final velocities (m/s) of a chain of five equal masses without gaps that the first one hits at 1 m/s.
///
/// Neighbours are joined by springs with k/m = ω² that push but never pull. The equations of motion are
/// integrated with the classical Runge–Kutta method.
pub(crate) fn chain_velocities(omega: f64) -> [f64; 5] {
    // five positions, then five velocities
    type Chain = [f64; 10];
    let derivative = |chain: &Chain| {
        let mut rate: Chain = [0.0; 10];
        rate[..5].copy_from_slice(&chain[5..]);
        for i in 0..4 {
            let push = omega * omega * (chain[i] - chain[i + 1]).max(0.0);
            rate[5 + i] -= push;
            rate[6 + i] += push;
        }
        rate
    };
    let advance = |chain: &Chain, rate: &Chain, h: f64| {
        let mut next = *chain;
        next.iter_mut().zip(rate).for_each(|(x, rate)| *x += h * rate);
        next
    };
    let mut chain: Chain = [0.0; 10];
    chain[5] = 1.0;
    let h = 1e-3 / omega;
    // 40/ω; all masses have separated after about 10/ω
    for _ in 0..40_000 {
        let a = derivative(&chain);
        let b = derivative(&advance(&chain, &a, 0.5 * h));
        let c = derivative(&advance(&chain, &b, 0.5 * h));
        let d = derivative(&advance(&chain, &c, h));
        let mut mean: Chain = [0.0; 10];
        for i in 0..10 {
            mean[i] = (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0;
        }
        chain = advance(&chain, &mean, h);
    }
    [chain[5], chain[6], chain[7], chain[8], chain[9]]
}

fn cradle() -> Outcome {
    let (k, mass, radius) = (1e6, 0.1, 0.02);
    let omega = f64::sqrt(k / mass);
    let mut checks = Vec::new();
    // the gaps are wider than the displacement of a ball during an impact
    for (gap, expected) in [(1e-3, [0.0, 0.0, 0.0, 0.0, 1.0]), (0.0, chain_velocities(omega))] {
        let mut world = free_space(material(k, 1.0, 0.0), 1e-6);
        for number in 0..5 {
            let position = f64::from(number) * (2.0 * radius + gap);
            let start = if number == 0 { -0.01 } else { position };
            let speed = if number == 0 { 1.0 } else { 0.0 };
            world = world
                .body(ball(radius, mass)?.position(DVec3::X * start).velocity(DVec3::X * speed));
        }
        let mut world = world.build()?;
        step_until(&mut world, 0.03)?;
        let name = if gap > 0.0 { "with gaps" } else { "without gaps" };
        for number in [0, 3, 4] {
            let speed = world.body(number).velocity().x;
            let quantity = format!("velocity of ball {} {name}", number + 1);
            checks.push(Check::new(quantity, expected[number], speed, 1e-3, "m/s"));
        }
    }
    Ok(checks)
}

fn unequal() -> Outcome {
    let (k, radius, light, heavy) = (1e5, 0.05, 0.2, 0.7);
    let mut checks = Vec::new();
    for e in [0.2, 0.5, 0.9] {
        let mut world = free_space(material(k, e, 0.3), 2e-6)
            .body(ball(radius, light)?.position(DVec3::X * -0.06).velocity(DVec3::X))
            .body(ball(0.5 * radius, heavy)?.position(DVec3::X * 0.02))
            .build()?;
        step_until(&mut world, 0.05)?;
        let [a, b] = [0, 1].map(|index| world.body(index).velocity().x);
        let quantity = format!("separation speed, e = {e}");
        checks.push(Check::new(quantity, e, b - a, 0.01 * e, "m/s"));
        let expected = (1.0 + e) * light / (light + heavy);
        let quantity = format!("speed of the ball that was at rest, e = {e}");
        checks.push(Check::new(quantity, expected, b, 0.01 * expected, "m/s"));
    }
    Ok(checks)
}

/// Simulates the oblique impact of an upper ball on an equal ball at rest below it.
///
/// The upper ball falls along −y at 1 m/s and moves along x at `tangential` (m/s). The result is the
/// tangential velocity of the upper ball relative to the lower one at their contact, and ω R of the upper
/// ball about z, both after the impact (m/s).
fn oblique_impact(material: Material, tangential: f64) -> Result<[f64; 2], Error> {
    let (radius, mass) = (0.05, 0.1);
    let velocity = DVec3::new(tangential, -1.0, 0.0);
    // at the impact the upper ball is exactly above the lower one
    let time_to_impact = 1e-3;
    let start = DVec3::Y * (2.0 * radius) - velocity * time_to_impact;
    let mut world = free_space(material, 1e-7)
        .body(ball(radius, mass)?)
        .body(ball(radius, mass)?.position(start).velocity(velocity))
        .build()?;
    step_until(&mut world, 2.0 * time_to_impact)?;
    let [lower, upper] = [world.body(0), world.body(1)];
    let (a, b) = (lower.angular_velocity().z, upper.angular_velocity().z);
    let slip = upper.velocity().x - lower.velocity().x + radius * (a + b);
    Ok([slip, radius * b])
}

fn oblique() -> Outcome {
    let k = 1e8;
    let mut checks = Vec::new();
    // The normal impulse of equal balls is J = (1 + e) M v/2. The friction impulse μ J changes the angular
    // velocity of each ball by 5/2 μ J/(M R).
    for (e, friction, tangential) in [(0.9, 0.2, 4.0), (0.5, 0.1, -2.0)] {
        let [slip, spin] = oblique_impact(material(k, e, friction), tangential)?;
        // 2 μ J/M for v = 1 m/s
        let impulse = friction * (1.0 + e) * f64::signum(tangential);
        let setting = format!("μ = {friction}, e = {e}, initially {tangential} m/s");
        let quantity = format!("tangential velocity, sliding, {setting}");
        let bound = 0.01 * impulse.abs() * 3.5;
        checks.push(Check::new(quantity, tangential - 3.5 * impulse, slip, bound, "m/s"));
        let quantity = format!("ω R, sliding, {setting}");
        let bound = 0.01 * impulse.abs();
        checks.push(Check::new(quantity, -1.25 * impulse, spin, bound, "m/s"));
    }
    for ratio in [2.0 / 7.0, 1.0 / 7.0] {
        let sticking = Material {
            friction_spring: Some(ratio * k),
            friction_damping: Some(0.0),
            ..material(k, 1.0, 5.0)
        };
        let tangential = 0.5;
        let [slip, _] = oblique_impact(sticking, tangential)?;
        let expected = tangential * libm::cos(PI * f64::sqrt(3.5 * ratio));
        let quantity = format!(
            "tangential velocity, sticking, k_t = {ratio:.3} k, initially {tangential} m/s"
        );
        checks.push(Check::new(quantity, expected, slip, 0.01 * tangential, "m/s"));
    }
    Ok(checks)
}
