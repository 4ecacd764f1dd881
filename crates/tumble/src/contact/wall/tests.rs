//! Wall contact gives the same bits at every SIMD level, and weights act as repeated particles.

use glam::{DQuat, DVec3};

use super::*;
use crate::contact::SinceKick;
use crate::lanes::levels;
use crate::{Body, Damping, Integrator, Material, Mesh, Shape, WallBox, World, WorldBuilder};

fn cloud(count: u32) -> Vec<DVec3> {
    let one = |i: u32| {
        let spread = |factor: f64| 0.6 * (f64::from(i) * factor).fract() - 0.3;
        DVec3::new(spread(0.819_172_5), spread(0.671_043_6), spread(0.549_700_4))
    };
    (0..count).map(one).collect()
}

/// A cloud of particles that slides and spins into a corner.
fn in_a_corner(friction: f64) -> World {
    let places = cloud(500);
    let material = Material {
        damping: Damping::Dashpot(3.0),
        friction_stiffness: friction,
        ..Material::default()
    };
    let body = Body::new(Shape::from_particles(&places).unwrap())
        .position(DVec3::splat(-0.75))
        .orientation(DQuat::from_rotation_y(0.4))
        .velocity(DVec3::new(-1.0, -2.0, 0.5))
        .angular_velocity(DVec3::new(3.0, 1.0, -2.0));
    World::builder().material(material).box_walls(&WallBox::arena()).body(body).build().unwrap()
}

#[test]
fn wall_contact_has_the_same_bits_at_every_simd_level() {
    for friction in [0.0, 0.3] {
        let mut world = in_a_corner(friction);
        for _ in 0..20 {
            world.step().unwrap();
        }
        let (model, state) = (world.model(), world.state());
        assert_eq!(state.springs[0].len() > 50, friction > 0.0);
        let evaluate_at = |level| {
            let mut kinematics = Kinematics::new(&model.bodies[0], &state.bodies[0]);
            kinematics.level = level;
            let (mut forces, mut springs) = (BodyForces::default(), Vec::new());
            let mut contacts = WallContacts::default();
            contacts.normal_springs.update(model, &kinematics, model.dt);
            let since_kick = SinceKick::none(state.time);
            let old = &state.springs[0];
            let kick = Kick { length: model.dt, since_last: &since_kick, start: None };
            contacts.friction.detect(model, &kinematics, old, kick);
            contacts.evaluate(model, &kinematics, &mut forces);
            contacts.friction.store_springs(&kinematics, &mut springs);
            (forces, springs, elastic_energy(model, &kinematics, &state.springs[0]))
        };
        let best = evaluate_at(levels()[0]);
        assert!(best.0.max_depth > 0.01 && best.0.dashpot.force.length() > 1.0);
        for level in levels() {
            assert_eq!(evaluate_at(level), best, "{level:?}");
        }
    }
}

/// How many copies of each particle the cloud has.
fn copies(index: usize) -> usize {
    [1, 3, 0, 2, 7][index % 5]
}

/// 120 particles with integer weights, or with as many copies of each: the same body up to rounding.
fn weighted_or_repeated(as_weights: bool, friction: f64, damping: f64) -> WorldBuilder {
    let places = cloud(120);
    let (centre, gyration) =
        (DVec3::new(0.01, 0.0, -0.02), glam::DMat3::from_diagonal(DVec3::new(0.03, 0.04, 0.05)));
    let shape = |places: &[DVec3]| {
        Shape::from_distribution(places, Mesh::default(), centre, gyration).unwrap()
    };
    let total: usize = (0..places.len()).map(copies).sum();
    // copies of a mean particle
    let mean = total as f64 / places.len() as f64;
    let (shape, factor) = if as_weights {
        let weights: Vec<f64> = (0..places.len()).map(|i| copies(i) as f64 / mean).collect();
        (shape(&places).weighted(&weights, 1.0), mean)
    } else {
        let all: Vec<_> =
            places.iter().enumerate().flat_map(|(i, &p)| vec![p; copies(i)]).collect();
        (shape(&all), 1.0)
    };
    let material = Material {
        collision_stiffness: 500.0 * factor,
        damping: Damping::Dashpot(damping * factor),
        friction_stiffness: friction,
        friction_spring: Some(200.0 * factor),
        friction_damping: Some(0.5 * factor),
        ..Material::default()
    };
    let body = Body::new(shape)
        .mass(5.0)
        .position(DVec3::splat(-0.68))
        .velocity(DVec3::new(-1.0, -2.0, 0.5))
        .angular_velocity(DVec3::new(3.0, 1.0, -2.0));
    World::builder().material(material).box_walls(&WallBox::arena()).body(body)
}

#[test]
fn a_weight_acts_as_that_many_particles() {
    for (friction, damping) in [(0.0, 0.0), (0.0, 2.0), (0.4, 2.0)] {
        for (integrator, tolerance) in [
            (Integrator::Splitting, None),
            (Integrator::Euler, None),
            (Integrator::Splitting, Some(1e-6)),
        ] {
            let [mut weighted, mut many] = [true, false].map(|as_weights| {
                let world =
                    weighted_or_repeated(as_weights, friction, damping).integrator(integrator);
                world.energy_tolerance(tolerance).build().unwrap()
            });
            let mut deepest = 0.0f64;
            for _ in 0..200 {
                weighted.step().unwrap();
                many.step().unwrap();
                deepest = deepest.max(weighted.energy().elastic);
            }
            assert!(deepest > 0.1, "{deepest}");
            let what = format!("{friction} {damping} {integrator:?} {tolerance:?}");
            let (a, b) = (&weighted.state().bodies[0], &many.state().bodies[0]);
            assert!((a.position - b.position).length() < 1e-10, "{what}");
            assert!((a.velocity - b.velocity).length() < 1e-9, "{what}");
            assert!((a.angular_momentum - b.angular_momentum).length() < 1e-10, "{what}");
            let (a, b) = (weighted.energy(), many.energy());
            for (a, b) in [(a.elastic, b.elastic), (a.dashpot, b.dashpot), (a.slip, b.slip)] {
                assert!((a - b).abs() < 1e-9 * (1.0 + b.abs()), "{what}: {a} {b}");
            }
            let critical =
                [&weighted, &many].map(|world| crate::critical_dt(world.model()).unwrap().dt);
            assert!((critical[0] / critical[1] - 1.0).abs() < 1e-12, "{what}: {critical:?}");
        }
    }
}
