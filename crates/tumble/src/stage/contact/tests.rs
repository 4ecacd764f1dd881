//! Contacts in registers of any width.

use glam::{DQuat, DVec3};

use super::*;
use crate::lanes::levels;
use crate::{Body, Damping, Material, Shape, WallBox, World};

/// A cloud of particles that is pushed, slipping and turning, into a corner.
fn in_a_corner(friction: f64) -> World {
    let places: Vec<DVec3> = (0..500)
        .map(|i| {
            let spread = |factor: f64| 0.6 * (f64::from(i) * factor).fract() - 0.3;
            DVec3::new(spread(0.819_172_5), spread(0.671_043_6), spread(0.549_700_4))
        })
        .collect();
    let material = Material {
        damping: Damping::Dashpot(3.0),
        friction_stiffness: friction,
        ..Material::default()
    };
    let body = Body::new(Shape::of_particles(&places).unwrap())
        .position(DVec3::splat(-0.75))
        .orientation(DQuat::from_rotation_y(0.4))
        .velocity(DVec3::new(-1.0, -2.0, 0.5))
        .angular_velocity(DVec3::new(3.0, 1.0, -2.0));
    World::builder().material(material).walls_of_box(&WallBox::arena()).body(body).build().unwrap()
}

#[test]
fn contact_has_the_same_bits_at_every_level() {
    for friction in [0.0, 0.3] {
        let mut world = in_a_corner(friction);
        for _ in 0..20 {
            world.step().unwrap();
        }
        let (model, state) = (world.model(), world.state());
        assert_eq!(state.springs[0].len() > 50, friction > 0.0);
        let evaluate = |level| {
            let mut place = Placed::new(&model.bodies[0], &state.bodies[0]);
            place.level = level;
            let (mut forces, mut next) = (BodyForces::default(), Vec::new());
            let mut touching = Touching::default();
            let alone = normal::Springs::at(model, &place);
            touching.find(model, &place, &state.springs[0]);
            push(model, &place, &alone, &mut forces, &mut touching);
            touching.keep(&place, &mut next);
            (forces, next, place.elastic_energy(model, &state.springs[0]))
        };
        let best = evaluate(levels()[0]);
        assert!(best.0.max_depth > 0.01 && best.0.dashpot.force.length() > 1.0);
        for level in levels() {
            assert_eq!(evaluate(level), best, "{level:?}");
        }
    }
}
