//! Finely meshed bodies, not convex, in each other's way: what is remembered of their surfaces changes no bit.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use tumble::{
    Body, DQuat, DVec3, Damping, MassModel, Material, Primitive, Sampling, Shape, Surface, WallBox,
    World,
};

/// Eight knots in a narrow box, thrown at each other.
fn heap() -> World {
    let knot = Primitive::Knot { radius: 0.06, tube_radius: 0.022, segments: 12 }.mesh().unwrap();
    let knot = Arc::new(Shape::of_mesh(&knot, Sampling::Vertices, MassModel::Solid).unwrap());
    let material = Material {
        collision_stiffness: 4e3,
        damping: Damping::Restitution(0.4),
        friction_stiffness: 0.5,
        ..Material::default()
    };
    let arena = WallBox {
        min: DVec3::new(-0.3, 0.0, -0.3),
        max: DVec3::new(0.3, 4.0, 0.3),
        orientation: DQuat::IDENTITY,
        open: [false; 6],
    };
    let mut world = World::builder().dt(2e-4).material(material).walls_of_box(&arena);
    for number in 0..8 {
        let [x, y, z] = [number % 2, number / 2 % 2, number / 4].map(|i| f64::from(i) - 0.5);
        let place = DVec3::new(0.28 * x, 0.3 + 0.3 * y, 0.28 * z);
        let turn = DQuat::from_scaled_axis(DVec3::new(0.3, 0.7, 0.2) * f64::from(number));
        let body = Body::new(Arc::clone(&knot)).mass(0.5).surface(Surface::Mesh);
        let thrown = body.velocity(DVec3::new(-4.0 * x, -2.0, -3.0 * z));
        world = world.body(thrown.position(place).orientation(turn).angular_velocity(place * 9.0));
    }
    world.build().unwrap()
}

#[test]
fn patches_and_lists_that_are_kept_change_no_bit() {
    let mut kept = heap();
    let mut forgetful = kept.clone();
    let mut touched = 0;
    for step in 0..2000 {
        kept.step().unwrap();
        // also with nothing known at all
        if step % 11 == 0 || step / 100 % 4 == 3 {
            forgetful.forget_scratch();
        }
        forgetful.step().unwrap();
        touched += kept.state().pair_springs.len();
        if step % 50 == 49 {
            assert_eq!(kept.state().hash(), forgetful.state().hash(), "after step {step}");
        }
    }
    assert!(touched > 2000, "hardly a heap: {touched}");
}
