//! Contact along the normal: springs and dashpots.

use std::f64::consts::PI;

use tumble::{
    Body, DVec3, Damping, Integrator, Material, Shape, WallPlane, World, WorldBuilder, critical_dt,
};
use tumble_io::scene::{LoadOptions, Source, load_text};

use crate::check::{Case, Check, Outcome};
use crate::flight::run;

type Error = Box<dyn std::error::Error>;

pub(crate) const ORDER: Case = Case {
    name: "order",
    about: "a particle that swings on its contact spring without leaving it, against the harmonic motion, \
            with dt and dt/2",
    run: order,
    slow: false,
};

pub(crate) const BOUNCE: Case = Case {
    name: "bounce",
    about: "1 kg from 1 m on a spring of 1e5 N/m, undamped, dt = 1e-3 s, ten bounces: the energy, and the time of the \
            tenth top against parabola and spring in closed form",
    run: bounce,
    slow: false,
};

pub(crate) const RESTITUTION: Case = Case {
    name: "restitution",
    about: "a particle thrown at a wall comes back with the restitution that was asked for",
    run: restitution,
    slow: false,
};

pub(crate) const CAT: Case = Case {
    name: "cat",
    about: "an undamped cat of 3,890 particles tumbling in the box for 60 s, dt = 1e-3 s: its energy",
    run: cat,
    slow: true,
};

/// A particle of 1 kg at `height` above the floor y = 0.
pub(crate) fn particle(height: f64) -> Result<Body, Error> {
    let shape = Shape::of_particles(&[DVec3::ZERO])?;
    Ok(Body::new(shape).mass(1.0).position(DVec3::Y * height))
}

/// A world with the floor y = 0 of this material.
pub(crate) fn on_floor(material: Material) -> WorldBuilder {
    let floor = WallPlane { normal: DVec3::Y, offset: 0.0 };
    World::builder().material(material).wall(floor)
}

fn spring(k: f64) -> Material {
    Material { collision_stiffness: k, ..Material::default() }
}

fn order() -> Outcome {
    let (k, g, time) = (1000.0, 9.8, 2.0);
    let omega = f64::sqrt(k);
    let mut checks = Vec::new();
    for (integrator, expected) in [(Integrator::Euler, 1.0), (Integrator::Splitting, 2.0)] {
        let off = |dt: f64| -> Result<f64, Error> {
            let sag = g / k;
            let world = on_floor(spring(k)).integrator(integrator).dt(dt);
            let mut world = world.body(particle(-0.5 * sag)?).build()?;
            run(&mut world, time)?;
            let exact = -sag + 0.5 * sag * libm::cos(omega * time);
            let speed = -0.5 * sag * omega * libm::sin(omega * time);
            let (x, v) = (world.body(0).position().y - exact, world.body(0).velocity().y - speed);
            Ok(libm::hypot(x, v / omega))
        };
        let (coarse, fine) = (off(5e-4)?, off(2.5e-4)?);
        let found = libm::log2(coarse / fine);
        checks.push(Check::new(
            format!("order of {}", integrator.name()),
            expected,
            found,
            0.1,
            "",
        ));
    }
    Ok(checks)
}

fn bounce() -> Outcome {
    let (k, g, dt): (f64, f64, f64) = (1e5, 9.8, 1e-3);
    // from 1 m to the floor, and on the spring: tan(ω t/2) = −v ω/g where the depth is back at zero
    let (fall, speed, omega) = ((2.0 / g).sqrt(), (2.0 * g).sqrt(), k.sqrt());
    let touch = 2.0 / omega * (PI - libm::atan(speed * omega / g));
    let tenth_top = 10.0 * (2.0 * fall + touch);
    let mut checks = Vec::new();
    // the tolerance, and bounds of energy and of time
    for (tolerance, energy, late) in
        [(None, 2e-2, 2e-2), (Some(1e-6), 1e-6, 1e-6), (Some(1e-9), 1e-8, 1e-7)]
    {
        let world = on_floor(spring(k)).dt(dt).energy_tolerance(tolerance).body(particle(1.0)?);
        let mut world = world.build()?;
        let start = world.energy().total();
        let mut worst = 0.0f64;
        while world.state().step < (tenth_top / dt).round() as u64 {
            world.step()?;
            if world.energy().elastic == 0.0 {
                worst = worst.max((world.energy().total() / start - 1.0).abs());
            }
        }
        let setting = match tolerance {
            Some(tolerance) => format!("energy_tolerance = {tolerance:e}"),
            None => "fixed step".to_owned(),
        };
        let cost = format!("{} force evaluations", world.state().totals.evaluations);
        let check = Check::error(format!("energy, relative, {setting}"), worst, energy, "");
        checks.push(check.remark(cost));
        // at the top v = 0, and around it v = −g (t − t_top)
        let top = world.time() + world.body(0).velocity().y / g;
        checks.push(Check::new(
            format!("time of the tenth top, {setting}"),
            tenth_top,
            top,
            late,
            "s",
        ));
    }
    Ok(checks)
}

fn restitution() -> Outcome {
    let mut checks = Vec::new();
    for k in [1e3, 1e4, 1e5, 1e6] {
        for e in [0.1, 0.3, 0.5, 0.7, 0.9, 0.95] {
            let material = Material { damping: Damping::Restitution(e), ..spring(k) };
            let thrown = particle(1e-3)?.velocity(DVec3::new(0.0, -1.0, 0.0));
            let world = on_floor(material).gravity(DVec3::ZERO).dt(1e-9).body(thrown);
            let critical = critical_dt(world.clone().build()?.model()).map_or(1e-3, |c| c.dt);
            let mut world = world.dt(critical / 100.0).build()?;
            while world.body(0).position().y <= 1e-3 || world.body(0).velocity().y < 0.0 {
                world.step()?;
            }
            let back = world.body(0).velocity().y;
            checks.push(Check::new(format!("e for k = {k:e} N/m"), e, back, 0.01 * e, ""));
        }
    }
    Ok(checks)
}

/// The cat of the first task, with the default integrator.
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
        let check =
            Check::error(format!("energy over 60 s, relative, {setting}"), worst, bound, "");
        checks
            .push(check.remark(format!("{} force evaluations", world.state().totals.evaluations)));
    }
    Ok(checks)
}
