//! The mouse spring.
#![allow(clippy::unwrap_used)]

use tumble::{Body, DVec3, MouseSpring, Shape, World};

fn world(dt: f64, gravity: f64) -> World {
    let places = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO, DVec3::new(-1.0, 0.3, 0.2)];
    let body = Body::new(Shape::from_particles(&places.map(|p| 0.3 * p)).unwrap())
        .angular_velocity(DVec3::new(1.0, 2.0, -0.5));
    World::builder().dt(dt).gravity(DVec3::Y * -gravity).body(body).build().unwrap()
}

#[test]
fn the_work_of_the_mouse_spring_equals_the_gain_of_energy() {
    let mut world = world(1e-3, 9.8);
    let start = world.energy().total();
    for step in 0..2000 {
        let target = DVec3::new(f64::from(step) * 1e-3, 1.0, 0.5);
        assert!(world.set_mouse_spring(Some(MouseSpring { body: 0, particle: 1, target })));
        world.step().unwrap();
    }
    let gained = world.energy().total() - start;
    assert!(world.mouse_spring_work() > 10.0);
    assert!(
        (gained - world.mouse_spring_work()).abs() < 1e-11 * gained,
        "{gained} {}",
        world.mouse_spring_work()
    );
}

#[test]
fn a_pulled_particle_reaches_the_target_at_any_step_size() {
    for dt in [1e-4, 1e-3, 0.02, 0.1] {
        let mut world = world(dt, 0.0);
        let target = DVec3::new(2.0, -1.0, 0.5);
        assert!(world.set_mouse_spring(Some(MouseSpring { body: 0, particle: 4, target })));
        while world.time() < 60.0 {
            world.step().unwrap();
        }
        let (place, velocity) = world.body(0).particle(4);
        // the body may still swing about the particle
        assert!((place - target).length() < 0.05, "dt {dt}: {place}");
        assert!(velocity.length() < 0.05, "dt {dt}: {velocity}");
        assert!(world.set_mouse_spring(None));
    }
}

#[test]
fn invalid_mouse_springs_are_refused() {
    let mut world = world(1e-3, 0.0);
    for (body, particle, x) in [(1, 0, 0.0), (0, 5, 0.0), (0, 0, f64::NAN)] {
        assert!(!world.set_mouse_spring(Some(MouseSpring {
            body,
            particle,
            target: DVec3::X * x
        })));
    }
    world.step().unwrap();
    assert_eq!(world.mouse_spring_work(), 0.0);
}
