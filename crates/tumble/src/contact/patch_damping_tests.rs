//! Restitution against its definition, and its order in the time step.

use glam::{DQuat, DVec3};

use super::*;
use crate::{
    Body, DMat3, Damping, MassModel, Material, Mesh, Primitive, Sampling, Shape, Surface,
    WallPlane, World, damping_ratio,
};

const FLOOR: WallPlane = WallPlane { normal: DVec3::Y, offset: 0.0 };

fn material(k: f64, e: f64, friction: f64) -> Material {
    Material {
        collision_stiffness: k,
        damping: Damping::Restitution(e),
        friction_stiffness: friction,
        ..Material::default()
    }
}

fn solid(primitive: Primitive) -> Body {
    let mesh = primitive.mesh().unwrap();
    Body::new(Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap()).mass(1.0)
}

#[test]
fn a_patch_of_one_particle_has_its_dashpots() {
    let (k, mass) = (2e4, 0.7);
    let law = material(k, 0.3, 0.5).law();
    let patch = Patch {
        stiffness: k,
        friction_spring: law.friction_spring,
        force: k * 1e-3,
        max_depth: 1e-3,
        inverse_mass: 1.0 / mass,
    };
    let times = patch.damping_times(&law);
    let alone = law.of_single_particle(mass);
    assert!((k * times.normal / alone.damping - 1.0).abs() < 1e-14);
    let tangential = law.friction_spring * times.tangential;
    assert!((tangential / alone.friction_damping - 1.0).abs() < 1e-14);
    assert!((alone.damping - 2.0 * damping_ratio(0.3) * (k * mass).sqrt()).abs() < 1e-12);
}

#[test]
fn a_patch_without_stiffness_has_no_dashpots() {
    let times = Patch::default().damping_times(&material(0.0, 0.3, 0.5).law());
    assert_eq!(times, DampingTimes::default());
}

/// The bodies that touch at one point: a particle at a wall, without and with friction, a sphere at a wall, two spheres.
#[derive(Clone, Copy, Debug)]
enum Single {
    Particle,
    ParticleWithFriction,
    Sphere,
    TwoSpheres,
}

/// Speed after an impact at 1 m/s that is `phase` steps away.
fn rebound(single: Single, e: f64, dt: f64, phase: f64) -> f64 {
    let point = Shape::from_distribution(
        &[DVec3::ZERO],
        Mesh::default(),
        DVec3::ZERO,
        DMat3::IDENTITY * 1e-3,
    );
    let friction = if matches!(single, Single::ParticleWithFriction) { 0.4 } else { 0.0 };
    let down = -DVec3::Y;
    let body = Body::new(point.unwrap()).mass(1.0).velocity(down);
    let at = DVec3::Y * (phase * dt);
    let ball = || body.clone().surface(Surface::Spheres { radius: 0.1 });
    let world = World::builder().gravity(DVec3::ZERO).dt(dt).material(material(1e5, e, friction));
    let world = match single {
        Single::Particle | Single::ParticleWithFriction => {
            world.wall(FLOOR).body(body.position(at))
        }
        Single::Sphere => world.wall(FLOOR).body(ball().position(at + DVec3::Y * 0.1)),
        // half of the speed each, with the reduced mass of one particle
        Single::TwoSpheres => world
            .body(ball().mass(2.0).position(at + DVec3::Y * 0.1).velocity(down * 0.5))
            .body(ball().mass(2.0).position(DVec3::Y * -0.1).velocity(DVec3::Y * 0.5)),
    };
    let mut world = world.force(true).build().unwrap();
    for _ in 0..(0.03 / dt) as u32 {
        world.step().unwrap();
    }
    let velocity = |index: usize| world.body(index).velocity().y;
    if matches!(single, Single::TwoSpheres) { velocity(0) - velocity(1) } else { velocity(0) }
}

/// Root mean square of the error of e over the phases of the touch within a step.
fn error(single: Single, e: f64, dt: f64) -> f64 {
    let phases = 16;
    let sum: f64 = (0..phases)
        .map(|i| {
            let phase = 1.0 + f64::from(i) / f64::from(phases);
            (rebound(single, e, dt, phase) - e).powi(2)
        })
        .sum();
    (sum / f64::from(phases)).sqrt()
}

#[test]
fn the_rebound_of_one_point_is_of_second_order_in_the_time_step() {
    for single in
        [Single::Particle, Single::ParticleWithFriction, Single::Sphere, Single::TwoSpheres]
    {
        for e in [0.3f64, 0.5, 0.8] {
            // the duration of the contact: e = exp(−ζ ω t)
            let contact_time = -libm::log(e) / (damping_ratio(e) * 1e5f64.sqrt());
            let tenth = contact_time / 10.0;
            let [coarse, fine] = [tenth, 0.25 * tenth].map(|dt| error(single, e, dt));
            let order = 0.5 * libm::log2(coarse / fine);
            println!("{single:?} {e}: {coarse:.2e} {fine:.2e}, order {order:.2}");
            assert!(coarse < 0.01, "{single:?} {e}: {coarse}");
            assert!(order > 1.75, "{single:?} {e}: {coarse} {fine}, order {order}");
        }
    }
}

#[test]
fn a_box_lands_flat_with_its_restitution_from_any_mesh() {
    for divisions in [1, 3] {
        for friction in [0.0, 0.4] {
            let body = solid(Primitive::Box { size: DVec3::new(0.3, 0.2, 0.1), divisions });
            let world = World::builder().gravity(DVec3::ZERO).dt(2e-5).wall(FLOOR);
            let world = world.material(material(1e4, 0.5, friction));
            let body = body.position(DVec3::Y * 0.101).velocity(-DVec3::Y);
            let mut world = world.body(body).build().unwrap();
            for _ in 0..5000 {
                world.step().unwrap();
            }
            let speed = world.body(0).velocity().y;
            assert!((speed - 0.5).abs() < 1e-4, "{divisions} {friction}: {speed}");
        }
    }
}

#[test]
fn dashpots_leave_a_stack_of_boxes_at_rest_where_the_springs_hold_it() {
    let (g, k, dt) = (9.8, 1e4, 5e-4);
    let world = World::builder().gravity(DVec3::Y * -g).dt(dt).wall(FLOOR);
    let mut world = world.material(material(k, 0.2, 0.0));
    for number in 0..2 {
        let body = solid(Primitive::Box { size: DVec3::new(0.4, 0.1, 0.4), divisions: 2 });
        let height = 0.05 + 0.0995 * f64::from(number) - 1e-4;
        world = world.body(body.surface(Surface::Mesh).position(DVec3::Y * height));
    }
    let mut world = world.build().unwrap();
    for _ in 0..4000 {
        world.step().unwrap();
    }
    // nine particles carry both boxes at the time of the kick, from which they fall for half a step
    let depth = 0.05 - (world.body(0).position().y - g * dt * dt / 8.0);
    let expected = 2.0 * g / (9.0 * k);
    assert!((depth / expected - 1.0).abs() < 1e-4, "{depth} {expected}");
}

#[test]
fn a_body_in_contact_is_stable_just_below_the_critical_step() {
    let shapes = [
        Primitive::Box { size: DVec3::new(0.3, 0.2, 0.1), divisions: 2 },
        Primitive::Box { size: DVec3::new(1.0, 0.02, 0.05), divisions: 1 },
        Primitive::Tetrahedron { size: 0.3 },
        Primitive::Sphere { radius: 0.1, subdivisions: 1 },
    ];
    for shape in shapes {
        for (e, friction) in [(0.05, 0.0), (0.3, 0.0), (0.3, 0.5), (0.9, 0.5)] {
            let world = |dt: f64| {
                let turn = DQuat::from_xyzw(0.1, 0.2, 0.05, 1.0).normalize();
                let body = solid(shape).position(DVec3::Y * 0.3).orientation(turn);
                let world = World::builder().dt(dt).material(material(1e4, e, friction));
                world.wall(FLOOR).force(true).body(body).build().unwrap()
            };
            let critical = crate::critical_dt(world(1e-3).model()).unwrap().dt;
            let mut world = world(0.95 * critical);
            let start = world.energy().total();
            for _ in 0..4000 {
                world.step().unwrap();
                let body = world.body(0);
                assert!(body.position().y < 0.6, "{shape:?} {e} {friction}");
            }
            assert!(world.energy().kinetic < 0.1 * start, "{shape:?} {e} {friction}");
        }
    }
}
