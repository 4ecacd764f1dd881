//! Bodies whose motion is given.

#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use tumble::{Body, DVec3, Motion, Oscillation, Prescribed, Shape, World};

#[test]
fn an_oscillation_swings_about_the_path_it_is_laid_over() {
    let amplitude = DVec3::new(0.0, 0.003, 0.001);
    let (frequency, phase) = (15.0, 0.4);
    let swing = Oscillation { amplitude, frequency, phase };
    let given = Prescribed { oscillation: Some(swing), ..Prescribed::default() };
    let shape = Shape::of_particles(&[DVec3::ZERO, DVec3::X]).unwrap();
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
