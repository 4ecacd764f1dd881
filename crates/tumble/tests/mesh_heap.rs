//! A heap of non-convex bodies with fine meshes: cached patches and lists do not change any bit.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use tumble::{
    Body, DQuat, DVec3, Damping, MassModel, Material, Primitive, Sampling, Shape, Surface, WallBox,
    World,
};

/// Eight knots thrown at each other in a narrow box.
fn heap() -> World {
    let knot = Primitive::Knot { radius: 0.06, tube_radius: 0.022, segments: 12 }.mesh().unwrap();
    let knot = Arc::new(Shape::from_mesh(&knot, Sampling::Vertices, MassModel::Solid).unwrap());
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
    let mut world = World::builder().dt(2e-4).material(material).box_walls(&arena);
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
fn cached_patches_and_lists_do_not_change_any_bit() {
    let mut cached = heap();
    let mut uncached = cached.clone();
    let mut touched = 0;
    for step in 0..2000 {
        cached.step().unwrap();
        // at times in every step, so that nothing is ever cached
        if step % 11 == 0 || step / 100 % 4 == 3 {
            uncached.clear_scratch();
        }
        uncached.step().unwrap();
        touched += cached.state().pair_springs.len();
        if step % 50 == 49 {
            assert_eq!(cached.state().hash(), uncached.state().hash(), "after step {step}");
        }
    }
    assert!(touched > 2000, "hardly a heap: {touched}");
}
