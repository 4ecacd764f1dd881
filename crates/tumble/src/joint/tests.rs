#![allow(clippy::unwrap_used)]

use glam::DVec3;

use crate::{Body, Joint, JointKind, Load, Motor, Shape, World, WorldBuilder};

const G: f64 = 9.81;

fn world(dt: f64) -> WorldBuilder {
    World::builder().dt(dt).gravity(DVec3::new(0.0, -G, 0.0))
}

/// A point mass of 1 kg.
fn point(name: &str, at: DVec3) -> Body {
    Body::new(Shape::from_particles(&[DVec3::ZERO]).unwrap()).name(name).mass(1.0).position(at)
}

/// A solid box of 1 kg.
fn solid(name: &str, at: DVec3, size: DVec3) -> Body {
    let inertia = DVec3::new(
        size.y * size.y + size.z * size.z,
        size.x * size.x + size.z * size.z,
        size.x * size.x + size.y * size.y,
    ) / 12.0;
    let shape = Shape::from_distribution(
        &[DVec3::ZERO],
        crate::Mesh::default(),
        DVec3::ZERO,
        glam::DMat3::from_diagonal(inertia),
    );
    Body::new(shape.unwrap()).name(name).mass(1.0).position(at)
}

/// Where the swings begin (rad).
const ANGLE: f64 = 1.5;

/// Time of a quarter of a swing from rest of a pendulum of this length: its period is 4 K(sin ANGLE/2)/√(g/length).
fn quarter(length: f64) -> f64 {
    let (mut a, mut b) = (1.0f64, libm::cos(0.5 * ANGLE));
    while (a - b).abs() > 1e-15 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * std::f64::consts::PI / (a * (G / length).sqrt())
}

/// The world after a quarter of a swing about the origin in so many steps. The centre of mass is 1 m from it.
fn swing(body: fn(&str, DVec3) -> Body, kind: JointKind, length: f64, steps: u64) -> World {
    let at = DVec3::new(libm::sin(ANGLE), -libm::cos(ANGLE), 0.0);
    let mut joint = Joint { axis: DVec3::Z, ..Joint::new(kind, ["bob", "world"], DVec3::ZERO) };
    if kind.has_length() {
        joint.at[0] = at;
    }
    let dt = quarter(length) / steps as f64;
    let mut world = world(dt).body(body("bob", at)).joint(joint).build().unwrap();
    world.steps(steps).unwrap();
    world
}

#[test]
fn a_pendulum_swings_in_the_time_of_the_elliptic_integral_with_an_error_of_second_order() {
    let cube: fn(&str, DVec3) -> Body = |name, at| solid(name, at, DVec3::ONE);
    let compound = 1.0 + 1.0 / 6.0;
    for (body, kind, length) in [
        (point as fn(&str, DVec3) -> Body, JointKind::Distance, 1.0),
        (point, JointKind::Rope, 1.0),
        (cube, JointKind::Ball, compound),
        (cube, JointKind::Hinge, compound),
    ] {
        let worlds: Vec<_> =
            [100, 200, 400].iter().map(|&steps| swing(body, kind, length, steps)).collect();
        let errors: Vec<f64> = worlds.iter().map(|world| world.body(0).position().x).collect();
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1] - 4.0).abs() < 0.1, "{kind:?} {errors:?}");
        }
        for world in worlds {
            assert!(world.constraint_error() < 1e-14, "{kind:?} {}", world.constraint_error());
            assert!(world.energy().joint_friction.abs() < 1e-12);
            // the tension at the bottom: weight and centripetal force
            let energy = -G * libm::cos(ANGLE);
            let tension = G + 2.0 * (energy + G) / length;
            let found = world.joint(0).wrench.force.y;
            assert!((found - tension).abs() < 0.02 * tension, "{kind:?} {found} {tension}");
        }
    }
}

#[test]
fn a_chain_of_hinges_keeps_its_energy_and_its_joints() {
    let mut builder = world(1e-3);
    for link in 0..10 {
        let x = f64::from(link) + 0.5;
        builder = builder.body(solid(&format!("{link}"), DVec3::X * x, DVec3::new(1.0, 0.1, 0.1)));
        let before = if link == 0 { "world".to_owned() } else { format!("{}", link - 1) };
        let between = [format!("{link}"), before];
        let between = [between[0].as_str(), between[1].as_str()];
        builder = builder.joint(Joint::hinge(between, DVec3::X * f64::from(link), DVec3::Z));
    }
    let mut world = builder.build().unwrap();
    let start = world.energy().total();
    let mut worst = 0.0f64;
    for _ in 0..2000 {
        world.step().unwrap();
        worst = worst.max(world.constraint_error());
    }
    let energy = world.energy();
    assert!(worst < 1e-13, "{worst:e}");
    assert!(energy.kinetic > 1.0);
    assert!(
        (energy.total() - start).abs() < 1e-3 * energy.kinetic,
        "{} {energy:?}",
        energy.total() - start
    );
}

/// In world axes: x is free.
fn slider(between: [&str; 2]) -> Joint {
    Joint::slider(between, DVec3::ZERO, DVec3::X)
}

#[test]
fn a_spring_oscillates_with_its_period_and_conserves_energy_at_any_step() {
    for dt in [1e-3, 0.05, 3.0] {
        let joint = slider(["cart", "world"]).spring_back(100.0, 0.0);
        let cart = solid("cart", DVec3::ZERO, DVec3::ONE).velocity(DVec3::X);
        let mut world = world(dt).body(cart).joint(joint).build().unwrap();
        let start = world.energy().total();
        world.steps(1000).unwrap();
        let energy = world.energy();
        assert!((energy.total() - start).abs() < 1e-9 * start.abs(), "{dt} {energy:?}");
        if dt == 1e-3 {
            // ω = 10 rad/s
            let x = world.body(0).position().x;
            assert!((x - 0.1 * libm::sin(10.0)).abs() < 1e-5, "{x}");
        }
    }
}

#[test]
fn a_damped_spring_decays_as_theory_says_and_the_ledger_closes() {
    let joint = slider(["cart", "world"]).spring_back(100.0, 2.0);
    let cart = solid("cart", DVec3::ZERO, DVec3::ONE).velocity(DVec3::X);
    let mut world = world(1e-3).body(cart).joint(joint).build().unwrap();
    let start = world.energy().total();
    world.steps(1000).unwrap();
    let omega = (100.0f64 - 1.0).sqrt();
    let x = libm::exp(-1.0) * libm::sin(omega) / omega;
    assert!((world.body(0).position().x - x).abs() < 1e-5);
    assert!((world.energy().total() - start).abs() < 1e-9);
    assert!(world.energy().joint_friction > 0.1);
}

#[test]
fn friction_of_a_slider_stops_it_where_coulomb_says_and_holds_it() {
    let joint = slider(["cart", "world"]).friction(2.0);
    // it stops within a step
    let speed = 1.000_37;
    let cart = solid("cart", DVec3::ZERO, DVec3::ONE).velocity(DVec3::X * speed);
    // a force below the friction does not move it
    let load = Load::force("cart", DVec3::X * 1.0);
    let mut world = world(1e-3).body(cart).joint(joint).load(load).build().unwrap();
    let start = world.energy().total();
    world.steps(5000).unwrap();
    // v²/(2 a) with a = 2 − 1
    let path = 0.5 * speed * speed;
    assert!((world.body(0).position().x - path).abs() < 1e-6, "{}", world.body(0).position().x);
    assert!(world.body(0).velocity().length() < 1e-13, "{}", world.body(0).velocity());
    let energy = world.energy();
    assert!((energy.joint_friction - 2.0 * path).abs() < 1e-6, "{energy:?}");
    assert!(
        (energy.work - path).abs() < 1e-6 && (energy.total() - start).abs() < 1e-11,
        "{energy:?}"
    );
}

#[test]
fn a_motor_turns_at_its_speed_or_with_its_effort() {
    let motor = Motor::Speed { speed: 3.0, effort: 10.0 };
    for (effort, rate, torque) in [(10.0, 3.0, 0.0), (0.1, 0.6, 0.1)] {
        let motor = match motor {
            Motor::Speed { speed, .. } => Motor::Speed { speed, effort },
            other => other,
        };
        let joint = Joint::hinge(["wheel", "world"], DVec3::ZERO, DVec3::Z).motor(motor);
        let wheel = solid("wheel", DVec3::ZERO, DVec3::ONE);
        let mut world = world(1e-3).body(wheel).joint(joint).build().unwrap();
        let start = world.energy().total();
        world.steps(1000).unwrap();
        let found = world.joint(0);
        assert!((found.rate - rate).abs() < 2e-3, "{found:?}");
        assert!((found.wrench.torque.z - torque).abs() < 1e-9, "{found:?}");
        let energy = world.energy();
        assert!((energy.motor - 0.5 * found.rate * found.rate / 6.0).abs() < 1e-3);
        assert!((energy.total() - start).abs() < 1e-12, "{energy:?}");
    }
}

/// From step to step, though the wheel does not begin at the speed of the motor.
#[test]
fn a_motor_under_a_load_has_a_smooth_torque() {
    let motor = Motor::Speed { speed: 6.0, effort: 50.0 };
    let arm = solid("arm", DVec3::X * 0.3, DVec3::new(0.6, 0.1, 0.1));
    let joint = Joint::hinge(["arm", "world"], DVec3::ZERO, DVec3::Z).motor(motor);
    let mut world = world(1e-3).body(arm).joint(joint).build().unwrap();
    world.steps(500).unwrap();
    let mut before = world.joint(0);
    for _ in 0..1000 {
        world.step().unwrap();
        let now = world.joint(0);
        assert!((now.rate - 6.0).abs() < 1e-4, "{now:?}");
        assert!((now.wrench.torque.z - before.wrench.torque.z).abs() < 0.03, "{now:?} {before:?}");
        before = now;
    }
}

#[test]
fn a_motor_holds_a_target_against_gravity_where_its_spring_balances() {
    let motor =
        Motor::Position { target: 0.5, stiffness: 200.0, damping: 20.0, effort: f64::INFINITY };
    let arm = solid("arm", DVec3::X, DVec3::new(2.0, 0.1, 0.1));
    let joint = Joint::hinge(["arm", "world"], DVec3::ZERO, DVec3::Z).motor(motor);
    let mut world = world(1e-3).body(arm).joint(joint).build().unwrap();
    world.steps(10_000).unwrap();
    let found = world.joint(0);
    let balance = 200.0 * (0.5 - found.coordinate) - G * libm::cos(found.coordinate);
    assert!(balance.abs() < 1e-5 && found.rate.abs() < 1e-9, "{balance} {found:?}");
}

#[test]
fn a_limit_stops_a_hinge_and_its_loss_is_counted() {
    let arm = solid("arm", DVec3::X, DVec3::new(2.0, 0.1, 0.1));
    let joint = Joint::hinge(["arm", "world"], DVec3::ZERO, DVec3::Z).limits([-0.7, 0.0]);
    let mut world = world(1e-3).body(arm).joint(joint).build().unwrap();
    let start = world.energy().total();
    world.steps(3000).unwrap();
    let found = world.joint(0);
    assert!((found.coordinate + 0.7).abs() < 1e-12 && found.rate.abs() < 1e-12, "{found:?}");
    let lost = G * libm::sin(0.7);
    let energy = world.energy();
    assert!((energy.joint_friction - lost).abs() < 1e-2 * lost, "{energy:?} {lost}");
    assert!((energy.total() - start).abs() < 1e-2 * lost);
    // it carries the torque of the weight
    let torque = G * libm::cos(0.7);
    assert!((found.wrench.torque.z - torque).abs() < 1e-9, "{found:?}");
}

#[test]
fn four_bars_with_redundant_hinges_close_their_loop() {
    let bar = |name: &str, from: DVec3, to: DVec3| {
        let size = DVec3::new((to - from).length(), 0.1, 0.1);
        let turn = glam::DQuat::from_rotation_arc(DVec3::X, (to - from).normalize());
        solid(name, 0.5 * (from + to), size).orientation(turn)
    };
    let corners = [DVec3::ZERO, DVec3::Y, DVec3::new(2.0, 1.5, 0.0), DVec3::X * 2.5];
    let hinge = |between, at| Joint::hinge(between, at, DVec3::Z);
    let mut world = world(1e-3)
        .body(bar("crank", corners[0], corners[1]).angular_velocity(DVec3::Z * -5.0))
        .body(bar("coupler", corners[1], corners[2]))
        .body(bar("rocker", corners[2], corners[3]))
        .joint(hinge(["crank", "world"], corners[0]))
        .joint(hinge(["coupler", "crank"], corners[1]))
        .joint(hinge(["rocker", "coupler"], corners[2]))
        .joint(hinge(["rocker", "world"], corners[3]))
        .build()
        .unwrap();
    assert_eq!(world.redundant_constraints(), 3);
    assert!((world.body(0).angular_velocity().z + 5.0).abs() < 1e-12);
    let start = world.energy().total();
    let mut worst = 0.0f64;
    for _ in 0..5000 {
        world.step().unwrap();
        worst = worst.max(world.constraint_error());
    }
    let energy = world.energy();
    assert!(worst < 1e-12, "{worst:e}");
    assert!((energy.total() - start).abs() < 1e-3 * energy.kinetic, "{energy:?}");
}

#[test]
fn the_ledger_of_an_orbit_closes_and_energy_tolerance_is_refused() {
    let orbit = || {
        let gravity = crate::CentralGravity { gm: 1.0, at: DVec3::ZERO };
        let planet = point("planet", DVec3::X * 0.5).velocity(DVec3::Y * 3f64.sqrt());
        World::builder().dt(1e-3).gravity(DVec3::ZERO).central_gravity(gravity).body(planet)
    };
    let mut world = orbit().build().unwrap();
    let mut worst = 0.0f64;
    for _ in 0..7000 {
        world.step().unwrap();
        let energy = world.energy();
        worst = worst.max((energy.total() + 0.5).abs());
        assert!(energy.work == 0.0);
    }
    assert!(worst < 1e-5, "{worst:e}");
    let refused = orbit().energy_tolerance(1e-6).build().map(drop).unwrap_err().to_string();
    assert!(refused.contains("joints or loads"), "{refused}");
}

/// A hinge in the centre of a body at the origin, with another body on it.
#[test]
fn a_joint_at_the_origin_converges() {
    let arm = solid("arm", DVec3::new(0.01, -0.5, 0.0), DVec3::new(0.02, 1.0, 0.02));
    let mut world = world(1e-3)
        .body(solid("shaft", DVec3::ZERO, DVec3::new(0.1, 1.0, 0.1)))
        .body(arm)
        .joint(Joint::hinge(["shaft", "world"], DVec3::ZERO, DVec3::Y))
        .joint(Joint::hinge(["arm", "shaft"], DVec3::ZERO, DVec3::Z))
        .build()
        .unwrap();
    world.steps(2000).unwrap();
    assert!(world.constraint_error() < 1e-14);
}

/// Its bodies are not in one plane, so that half way of an iteration its dependent constraints seem independent.
#[test]
fn a_slider_crank_out_of_its_plane_converges() {
    let motor = Motor::Speed { speed: 6.0, effort: 20.0 };
    let pins = [DVec3::ZERO, DVec3::new(0.3, 0.0, 0.025), DVec3::new(1.1, 0.0, 0.025)];
    let mut world = world(2e-3)
        .body(solid("crank", DVec3::X * 0.15, DVec3::new(0.3, 0.06, 0.04)))
        .body(solid("rod", DVec3::new(0.7, 0.0, 0.05), DVec3::new(0.8, 0.05, 0.04)))
        .body(solid("piston", DVec3::X * 1.1, DVec3::new(0.16, 0.2, 0.2)))
        .joint(Joint::hinge(["crank", "world"], pins[0], DVec3::Z).motor(motor))
        .joint(Joint::hinge(["rod", "crank"], pins[1], DVec3::Z))
        .joint(Joint::hinge(["rod", "piston"], pins[2], DVec3::Z))
        .joint(Joint::slider(["piston", "world"], DVec3::X * 1.1, DVec3::X))
        .build()
        .unwrap();
    world.steps(2500).unwrap();
    assert!(world.constraint_error() < 1e-12, "{:e}", world.constraint_error());
}
