//! Bodies with prescribed motion.

#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use tumble::{
    Body, DVec3, Integrator, Motion, MouseSpring, Oscillation, Prescribed, Shape, WallPlane, World,
};

#[test]
fn an_oscillation_is_added_to_the_uniform_motion() {
    let amplitude = DVec3::new(0.0, 0.003, 0.001);
    let (frequency, phase) = (15.0, 0.4);
    let swing = Oscillation { amplitude, frequency, phase };
    let given = Prescribed { oscillation: Some(swing), ..Prescribed::default() };
    let shape = Shape::from_particles(&[DVec3::ZERO, DVec3::X]).unwrap();
    let drift = DVec3::new(0.5, 0.0, 0.0);
    let body = Body::new(shape).velocity(drift).motion(Motion::Prescribed(given));
    let mut world = World::builder().dt(1e-3).body(body).build().unwrap();
    let start = world.bodies().next().unwrap().position();
    for _ in 0..2000 {
        let time = world.time();
        let body = world.bodies().next().unwrap();
        let angle = TAU * frequency * time + phase;
        let place = drift * time + amplitude * (angle.sin() - phase.sin());
        let velocity = drift + amplitude * (TAU * frequency * angle.cos());
        assert!((body.position() - start - place).length() < 1e-12, "place at {time}");
        assert!((body.velocity() - velocity).length() < 1e-11, "velocity at {time}");
        world.step().unwrap();
    }
}

/// Also without any collision surface, and with refined steps.
#[test]
fn a_prescribed_body_ignores_walls_gravity_and_the_mouse_spring() {
    for tolerance in [None, Some(1e-6)] {
        for integrator in [Integrator::Splitting, Integrator::Euler] {
            if tolerance.is_some() && integrator == Integrator::Euler {
                continue;
            }
            let shape = Shape::from_particles(&[DVec3::ZERO, DVec3::X, DVec3::Z]).unwrap();
            let body = Body::new(shape).position(DVec3::Y * 0.1).velocity(DVec3::NEG_Y);
            let held = body.motion(Motion::Prescribed(Prescribed::default()));
            let mut world = World::builder()
                .dt(1e-3)
                .integrator(integrator)
                .energy_tolerance(tolerance)
                .wall(WallPlane { normal: DVec3::Y, offset: 0.0 })
                .body(held)
                .build()
                .unwrap();
            let start = world.energy().total();
            assert!(!world.set_mouse_spring(Some(MouseSpring {
                body: 0,
                particle: 0,
                target: DVec3::ONE
            })));
            for _ in 0..500 {
                world.step().unwrap();
            }
            assert!((world.body(0).position().y + 0.4).abs() < 1e-12);
            assert_eq!(world.body(0).velocity(), DVec3::NEG_Y);
            assert_eq!(world.energy().total(), start);
        }
    }
}

#[test]
fn impossible_prescribed_motions_are_refused() {
    let held = |places: &[DVec3], swing: Option<Oscillation>| {
        let given = Prescribed { oscillation: swing, ..Prescribed::default() };
        let body = Body::new(Shape::from_particles(places).unwrap());
        body.motion(Motion::Prescribed(given)).angular_velocity(DVec3::X * 3.0)
    };
    let refusal = |body: Body| {
        let world = World::builder().dt(1e-3).body(body).build();
        world.err().map(|errors| errors.to_string()).unwrap_or_default()
    };
    let swing = |frequency| Some(Oscillation { amplitude: DVec3::Y * 1e-3, frequency, phase: 0.0 });
    // a needle along its axis has no inertia to turn by
    assert!(refusal(held(&[DVec3::ZERO, DVec3::X], None)).contains("has inertia"));
    let square = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
    assert!(refusal(held(&square, swing(1000.0))).contains("ten steps"));
    assert_eq!(refusal(held(&square, swing(50.0))), "");
}
