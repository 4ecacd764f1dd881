//! Linkages and chains.

use tumble::{DVec3, Joint, World};

use super::{G, bar, rigid, world};
use crate::check::{Case, Check, Error, Outcome};
use crate::setup::step_until;

pub(crate) const SLIDER_CRANK: Case = Case {
    name: "slider-crank",
    description: "A crank of 0.3 m drives a piston by a rod of 0.8 m, without gravity. The place of the piston is that of geometry, \
            r cos θ + √(l² − r² sin² θ), and the rate of the crank that of its constant energy.",
    run: slider_crank,
    slow: false,
};

pub(crate) const FOUR_BAR: Case = Case {
    name: "four-bar linkage",
    description: "A crank of 0.3 m, a coupler of 0.9 m and a rocker of 0.7 m on a ground of 0.8 m, in a plane, with four hinges: three of \
            their twenty constraints follow from the others. The loop stays closed, and the pin between coupler and rocker is where both circles meet.",
    run: four_bar,
    slow: false,
};

pub(crate) const CHAIN: Case = Case {
    name: "chain of hinges",
    description: "A chain of a hundred bars of 0.1 m on hinges swings from the horizontal without losses. Energy is relative to the potential energy \
            that is released.",
    run: chain,
    slow: true,
};

fn hinge(between: [&str; 2], at: DVec3) -> Joint {
    Joint::hinge(between, at, DVec3::Z)
}

fn slider_crank() -> Outcome {
    let (r, l) = (0.3, 0.8);
    let (pin, wrist) = (DVec3::X * r, DVec3::X * (r + l));
    let piston = rigid("piston", 2.0, DVec3::splat(0.01), wrist)?;
    let mut world = world(1e-4)
        .gravity(DVec3::ZERO)
        .body(bar("crank", 1.0, DVec3::ZERO, pin)?.angular_velocity(DVec3::Z * 10.0))
        .body(bar("rod", 0.5, pin, wrist)?)
        .body(piston)
        .joint(hinge(["crank", "world"], DVec3::ZERO))
        .joint(hinge(["rod", "crank"], pin))
        .joint(hinge(["rod", "piston"], wrist))
        .joint(Joint::slider(["piston", "world"], wrist, DVec3::X))
        .build()?;
    // twice the kinetic energy for a crank at 1 rad/s
    let inertia = |theta: f64| {
        let (sin, cos) = libm::sincos(theta);
        let across = (l * l - r * r * sin * sin).sqrt();
        let rod = -r * cos / across;
        let piston = -r * sin + r * sin * rod;
        let middle = DVec3::new(piston - 0.5 * r * sin * rod, 0.5 * r * cos, 0.0);
        r * r / 3.0
            + 0.5 * middle.length_squared()
            + 0.5 * l * l / 12.0 * rod * rod
            + 2.0 * piston * piston
    };
    let (mut place, mut rate) = (0.0f64, 0.0f64);
    while world.time() < 2.0 {
        world.step()?;
        let theta = world.joint(0).coordinate;
        let (sin, cos) = libm::sincos(theta);
        let expected = r * cos + (l * l - r * r * sin * sin).sqrt();
        place = place.max((world.body(2).position().x - expected).abs());
        let expected = 10.0 * (inertia(0.0) / inertia(theta)).sqrt();
        rate = rate.max((world.joint(0).rate / expected - 1.0).abs());
    }
    Ok(vec![
        Check::error("largest deviation of the piston from geometry", place, 1e-13, "m"),
        Check::error("largest deviation of the rate of the crank, relative", rate, 1e-5, ""),
        Check::new("redundant constraints", 3.0, world.redundant_constraints() as f64, 0.0, ""),
    ])
}

fn four_bar() -> Outcome {
    let corners = [DVec3::ZERO, DVec3::Y * 0.3, DVec3::new(0.8, 0.7, 0.0), DVec3::X * 0.8];
    let coupler = (corners[2] - corners[1]).length();
    let mut world = world(1e-3)
        .body(bar("crank", 1.0, corners[0], corners[1])?.angular_velocity(DVec3::Z * 8.0))
        .body(bar("coupler", 1.0, corners[1], corners[2])?)
        .body(bar("rocker", 1.0, corners[2], corners[3])?)
        .joint(hinge(["crank", "world"], corners[0]))
        .joint(hinge(["coupler", "crank"], corners[1]))
        .joint(hinge(["rocker", "coupler"], corners[2]))
        .joint(hinge(["rocker", "world"], corners[3]))
        .build()?;
    let redundant = world.redundant_constraints() as f64;
    let start = world.energy();
    let (mut closure, mut circles, mut energy) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..10_000 {
        world.step()?;
        closure = closure.max(world.constraint_error());
        energy = energy.max((world.energy().total() - start.total()).abs());
        let end = |body: usize, at: f64| {
            let body = world.body(body);
            body.position() + body.orientation() * DVec3::X * at
        };
        let (pin, rocker) = (end(0, 0.15), end(2, -0.35));
        circles = circles.max(((rocker - pin).length() - coupler).abs());
    }
    Ok(vec![
        Check::new("redundant constraints", 3.0, redundant, 0.0, ""),
        Check::error("largest error of any hinge in 10,000 steps", closure, 1e-12, "m"),
        Check::error("largest error of the length of the coupler", circles, 1e-12, "m"),
        Check::error(
            "largest residual, relative to the kinetic energy at the start",
            energy / start.kinetic,
            2e-4,
            "",
        ),
    ])
}

fn chain_world(dt: f64) -> Result<World, Error> {
    let count = 100;
    let mut builder = world(dt);
    for link in 0..count {
        let [from, to] = [link, link + 1].map(|end| DVec3::X * (0.1 * f64::from(end)));
        builder = builder.body(bar(&format!("{link}"), 0.1, from, to)?);
        let before = if link == 0 { "world".to_owned() } else { format!("{}", link - 1) };
        builder = builder.joint(hinge([&format!("{link}"), &before], from));
    }
    Ok(builder.build()?)
}

fn chain() -> Outcome {
    let mut checks = Vec::new();
    // what is released when it hangs
    let released = 10.0 * G * 5.0;
    for (dt, bound) in [(4e-4, 2e-6), (1e-4, 2e-7)] {
        let mut world = chain_world(dt)?;
        let start = world.energy().total();
        let (mut energy, mut error) = (0.0f64, 0.0f64);
        for _ in 0..30 {
            let next = world.time() + 0.1;
            step_until(&mut world, next)?;
            energy = energy.max((world.energy().total() - start).abs());
            error = error.max(world.constraint_error());
        }
        checks.push(Check::error(
            format!("largest residual in 3 s at dt = {dt} s, relative"),
            energy / released,
            bound,
            "",
        ));
        checks.push(Check::error(
            format!("largest error of a hinge at dt = {dt} s"),
            error,
            1e-12,
            "m",
        ));
    }
    Ok(checks)
}
