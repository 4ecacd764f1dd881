//! Steps do not allocate once the contact lists have reached their size.
#![allow(clippy::unwrap_used)]

use tumble::{Body, DVec3, Damping, Material, Primitive, Shape, WallBox, World};

/// A spinning sphere of 2,562 particles pressed into a corner of the arena.
fn heavy_contact(friction: f64, energy_tolerance: Option<f64>) -> World {
    let mesh = Primitive::Sphere { radius: 0.3, subdivisions: 4 }.mesh().unwrap();
    let shape = Shape::with_surface(&mesh.vertices, mesh.clone()).unwrap();
    let material = Material {
        collision_stiffness: 1e3,
        damping: Damping::Dashpot(1.0),
        friction_stiffness: friction,
        ..Material::default()
    };
    let mut builder = World::builder()
        .dt(1e-3)
        .gravity(DVec3::new(-5.0, -9.8, -5.0))
        .material(material)
        .box_walls(&WallBox::arena())
        .body(
            Body::new(shape)
                .position(DVec3::splat(-0.72))
                .angular_velocity(DVec3::new(1.0, 4.0, 2.0)),
        );
    if let Some(tolerance) = energy_tolerance {
        builder = builder.energy_tolerance(tolerance);
    }
    builder.build().unwrap()
}

fn allocations_of_a_thousand_steps(mut world: World) -> u64 {
    for _ in 0..1000 {
        world.step().unwrap();
    }
    let counted = allocation_counter::measure(|| {
        for _ in 0..1000 {
            world.step().unwrap();
        }
    });
    assert!(world.energy().elastic > 0.0, "the ball is in contact");
    counted.count_total
}

#[test]
fn steps_in_heavy_contact_do_not_allocate() {
    for friction in [0.0, 0.5] {
        assert_eq!(allocations_of_a_thousand_steps(heavy_contact(friction, None)), 0);
    }
}

#[test]
fn refined_steps_do_not_allocate() {
    assert_eq!(allocations_of_a_thousand_steps(heavy_contact(0.5, Some(1e-4))), 0);
}
