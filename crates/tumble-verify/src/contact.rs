//! The normal force of wall contacts: springs and dashpots.

use std::f64::consts::PI;

use tumble::{DVec3, Damping, Integrator, Material, critical_dt};
use tumble_io::scene::{LoadOptions, Source, load_text};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{G, particle, step_until, world_with_floor};

pub(crate) const ORDER: Case = Case {
    name: "order",
    description: "A particle oscillates on its contact spring without leaving the wall. Its error against the harmonic motion, with \
            dt and dt/2, gives the order of the integrator.",
    run: order,
    slow: false,
};

pub(crate) const BOUNCE: Case = Case {
    name: "bounce",
    description: "A particle of 1 kg falls 1 m onto an undamped contact spring of 1e5 N/m and bounces ten times, dt = 1e-3 s. Its \
            energy is constant, and the closed form of parabola and spring gives the time of its tenth apex.",
    run: bounce,
    slow: false,
};

pub(crate) const RESTITUTION: Case = Case {
    name: "restitution",
    description: "A particle thrown at a wall rebounds with the coefficient of restitution e that the scene sets.",
    run: restitution,
    slow: false,
};

pub(crate) const CAT: Case = Case {
    name: "cat",
    description: "A cat of 3,890 particles bounces in a closed box for 60 s without losses, dt = 1e-3 s. Its energy is constant.",
    run: cat,
    slow: true,
};

/// A material with contact springs of stiffness `k` (N/m), without losses.
fn spring(k: f64) -> Material {
    Material { collision_stiffness: k, ..Material::default() }
}

fn order() -> Outcome {
    let (k, time) = (1000.0, 2.0);
    let omega = f64::sqrt(k);
    let mut checks = Vec::new();
    for (integrator, expected) in [(Integrator::Euler, 1.0), (Integrator::Splitting, 2.0)] {
        let error = |dt: f64| -> Result<f64, Error> {
            let rest_depth = G / k;
            let world = world_with_floor(spring(k)).integrator(integrator).dt(dt);
            let mut world = world.body(particle(-0.5 * rest_depth)?).build()?;
            step_until(&mut world, time)?;
            let position = -rest_depth + 0.5 * rest_depth * libm::cos(omega * time);
            let velocity = -0.5 * rest_depth * omega * libm::sin(omega * time);
            let body = world.body(0);
            let (dx, dv) = (body.position().y - position, body.velocity().y - velocity);
            Ok(libm::hypot(dx, dv / omega))
        };
        let (coarse, fine) = (error(5e-4)?, error(2.5e-4)?);
        let order = libm::log2(coarse / fine);
        let quantity = format!("order of {}", integrator.name());
        checks.push(Check::new(quantity, expected, order, 0.1, ""));
    }
    Ok(checks)
}

fn bounce() -> Outcome {
    let (k, dt): (f64, f64) = (1e5, 1e-3);
    // The fall from 1 m takes √(2/g). The contact ends when the depth is zero again, where tan(ω t/2) = −v ω/g.
    let (fall_time, speed, omega) = ((2.0 / G).sqrt(), (2.0 * G).sqrt(), k.sqrt());
    let contact_time = 2.0 / omega * (PI - libm::atan(speed * omega / G));
    let tenth_apex = 10.0 * (2.0 * fall_time + contact_time);
    let mut checks = Vec::new();
    for (tolerance, energy_bound, time_bound) in
        [(None, 2e-2, 2e-2), (Some(1e-6), 1e-6, 1e-6), (Some(1e-9), 1e-8, 1e-7)]
    {
        let mut world = world_with_floor(spring(k))
            .dt(dt)
            .energy_tolerance(tolerance)
            .body(particle(1.0)?)
            .build()?;
        let start = world.energy().total();
        let mut worst = 0.0f64;
        while world.state().step < (tenth_apex / dt).round() as u64 {
            world.step()?;
            if world.energy().elastic == 0.0 {
                worst = worst.max((world.energy().total() / start - 1.0).abs());
            }
        }
        let setting = match tolerance {
            Some(tolerance) => format!("energy_tolerance = {tolerance:e}"),
            None => "fixed step".to_owned(),
        };
        let remark = format!("{} force evaluations", world.state().totals.evaluations);
        let quantity = format!("change of energy in flight, relative, {setting}");
        checks.push(Check::error(quantity, worst, energy_bound, "").remark(remark));
        // near the apex v = −g (t − t_apex)
        let apex = world.time() + world.body(0).velocity().y / G;
        let quantity = format!("time of the tenth apex, {setting}");
        checks.push(Check::new(quantity, tenth_apex, apex, time_bound, "s"));
    }
    Ok(checks)
}

fn restitution() -> Outcome {
    let mut checks = Vec::new();
    for k in [1e3, 1e4, 1e5, 1e6] {
        for e in [0.1, 0.3, 0.5, 0.7, 0.9, 0.95] {
            let material = Material { damping: Damping::Restitution(e), ..spring(k) };
            let thrown = particle(1e-3)?.velocity(DVec3::new(0.0, -1.0, 0.0));
            let world = world_with_floor(material).gravity(DVec3::ZERO).dt(1e-9).body(thrown);
            let critical = critical_dt(world.clone().build()?.model()).map_or(1e-3, |c| c.dt);
            let mut world = world.dt(critical / 100.0).build()?;
            while world.body(0).position().y <= 1e-3 || world.body(0).velocity().y < 0.0 {
                world.step()?;
            }
            // it arrives at 1 m/s, so its speed after the rebound is e
            let rebound = world.body(0).velocity().y;
            checks.push(Check::new(format!("e for k = {k:e} N/m"), e, rebound, 0.01 * e, ""));
        }
    }
    Ok(checks)
}

/// The cat of the scene `task1-cat`, thrown into a closed box with less spin, with the default integrator.
const CAT_SCENE: &str = r#"
dt = 1e-3
[collision]
collision_stiffness = 1e4
[box]
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[[body]]
shape = "cat"
scale = 0.3
initial_velocity = [4.0, 2.0, 3.0]
initial_angular_velocity = [1.0, 5.0, 2.0]
"#;

fn cat() -> Outcome {
    let mut checks = Vec::new();
    for (tolerance, bound) in [(None, 1e-3), (Some("1e-6"), 1e-6)] {
        let source = Source { name: "cat".to_owned(), text: CAT_SCENE.to_owned() };
        let sets = tolerance.map(|t| format!("energy_tolerance={t}")).into_iter().collect();
        let options = LoadOptions { sets, force: false };
        let mut world = load_text("cat", source, std::path::Path::new("."), &options)?.world;
        let start = world.energy().total();
        let mut worst = 0.0f64;
        while world.time() < 60.0 - 0.5 * world.dt() {
            world.step()?;
            if world.state().step.is_multiple_of(100) {
                worst = worst.max((world.energy().total() - start).abs() / start);
            }
        }
        let setting =
            tolerance.map_or("fixed step".to_owned(), |t| format!("energy_tolerance = {t}"));
        let remark = format!("{} force evaluations", world.state().totals.evaluations);
        let quantity = format!("change of energy over 60 s, relative, {setting}");
        checks.push(Check::error(quantity, worst, bound, "").remark(remark));
    }
    Ok(checks)
}
