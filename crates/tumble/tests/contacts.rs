//! The contacts of a step one by one: their wrenches add up to those of the bodies.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use tumble::{
    Body, ContactPartner, DMat3, DQuat, DVec3, Damping, Integrator, MassModel, Material, Mesh,
    Motion, Prescribed, Primitive, Sampling, Shape, Surface, WallBox, World, WorldBuilder, Wrench,
};

fn box_mesh(divisions: u32) -> Mesh {
    Primitive::Box { size: DVec3::new(0.3, 0.2, 0.25), divisions }.mesh().unwrap()
}

fn solid(mesh: &Mesh) -> Shape {
    Shape::from_mesh(mesh, Sampling::Vertices, MassModel::Solid).unwrap()
}

fn material(friction: f64, damping: Damping) -> Material {
    Material { friction_stiffness: friction, damping, ..Material::default() }
}

fn room() -> WorldBuilder {
    World::builder().box_walls(&WallBox { min: -DVec3::ONE, max: DVec3::ONE, ..WallBox::arena() })
}

fn place(index: usize) -> DVec3 {
    let i = index as f64;
    DVec3::new(-0.75 + 0.06 * i, -0.75 + 0.4 * i, -0.75 + 0.04 * i)
}

/// A body that falls into a corner.
fn thrown(shape: Shape, index: usize) -> Body {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.2, 0.1, 0.3) * (1.0 + index as f64));
    Body::new(shape)
        .mass(1.0)
        .position(place(index))
        .orientation(turn)
        .velocity(DVec3::new(-1.0, -2.0, -0.5))
        .angular_velocity(DVec3::new(1.0, -2.0, 0.5))
}

/// Runs a world and compares; returns how many contacts there were with walls and with bodies.
fn check(mut world: World, steps: u64) -> [usize; 2] {
    world.keep_contacts(true);
    let mut counts = [0; 2];
    for step in 0..steps {
        world.step().unwrap();
        if step % 7 != 0 {
            continue;
        }
        let contacts = world.contacts();
        for body in 0..world.body_count() {
            let wrench = world.contact_wrench(body);
            let sum = |size: fn(Wrench) -> f64| -> f64 {
                contacts.iter().map(|contact| size(contact.wrench_on(body))).sum()
            };
            let (force, torque) = (sum(|w| w.force.length()), sum(|w| w.torque.length()));
            let of_all = contacts.iter().fold(Wrench::default(), |all, c| all + c.wrench_on(body));
            let difference = of_all - wrench;
            assert!(difference.force.length() <= 1e-9 * force, "{step} {of_all:?} {wrench:?}");
            assert!(difference.torque.length() <= 1e-9 * torque, "{step} {of_all:?} {wrench:?}");
        }
        for contact in &contacts {
            assert!((contact.normal.length() - 1.0).abs() < 1e-9);
            assert!(contact.depth >= 0.0 && contact.force.is_finite());
            let is_wall = matches!(contact.other, ContactPartner::Wall(_));
            counts[usize::from(!is_wall)] += 1;
            let ContactPartner::Wall(wall) = contact.other else { continue };
            assert_eq!(contact.normal, world.model().walls[wall].normal);
            assert!(contact.force.dot(contact.normal) >= 0.0);
        }
        let order: Vec<_> = contacts.iter().map(|c| (c.body, c.other)).collect();
        assert!(order.is_sorted());
        // the same again
        assert_eq!(contacts, world.contacts());
    }
    counts
}

#[test]
fn particles_at_walls_add_up() {
    for integrator in [Integrator::Splitting, Integrator::Euler, Integrator::Implicit] {
        for friction in [0.0, 0.4] {
            for damping in [Damping::Dashpot(0.0), Damping::Dashpot(5.0), Damping::Restitution(0.5)]
            {
                let material = material(friction, damping);
                let builder = room().integrator(integrator).dt(2e-4).material(material);
                let world = builder.body(thrown(solid(&box_mesh(3)), 0)).build().unwrap();
                let [at_walls, _] = check(world, 1500);
                assert!(at_walls > 50, "{integrator:?} {friction} {damping:?} {at_walls}");
            }
        }
    }
}

#[test]
fn particles_with_area_weights_at_walls_add_up() {
    for friction in [0.0, 0.4] {
        let material = Material {
            collision_stiffness_per_area: Some(1e6),
            ..material(friction, Damping::Restitution(0.5))
        };
        let builder = room().dt(1e-4).material(material).body(thrown(solid(&box_mesh(2)), 0));
        assert!(check(builder.build().unwrap(), 2000)[0] > 50);
    }
}

#[test]
fn clumps_add_up() {
    let places = [DVec3::ZERO, DVec3::X * 0.08, DVec3::Y * 0.07];
    for (integrator, dt) in
        [(Integrator::Splitting, 2e-4), (Integrator::Euler, 2e-4), (Integrator::Implicit, 2e-3)]
    {
        let clump = |index| {
            let shape = Shape::from_particles(&places).unwrap();
            thrown(shape, index).surface(Surface::Spheres { radius: 0.06 })
        };
        let builder = room().integrator(integrator).dt(dt);
        let builder = builder.material(material(0.3, Damping::Restitution(0.6)));
        let world = (0..4).map(clump).fold(builder, WorldBuilder::body).build().unwrap();
        let [at_walls, between] = check(world, (0.5 / dt) as u64);
        assert!(at_walls > 20 && between > 5, "{integrator:?} {at_walls} {between}");
    }
}

#[test]
fn meshes_add_up() {
    for (integrator, dt) in [(Integrator::Splitting, 2e-4), (Integrator::Implicit, 1e-3)] {
        for friction in [0.0, 0.4] {
            let builder = room().integrator(integrator).dt(dt);
            let builder = builder.material(material(friction, Damping::Restitution(0.5)));
            let body = |index| thrown(solid(&box_mesh(1)), index).surface(Surface::Mesh);
            let world = (0..3).map(body).fold(builder, WorldBuilder::body).build().unwrap();
            let [at_walls, between] = check(world, (0.5 / dt) as u64);
            assert!(at_walls > 20 && between > 5, "{integrator:?} {at_walls} {between}");
        }
    }
}

/// More bodies than the step works on at a time, on a conveyor belt.
#[test]
fn many_bodies_on_a_belt_add_up() {
    for (integrator, dt) in [(Integrator::Splitting, 2e-4), (Integrator::Implicit, 2e-3)] {
        let belt = Prescribed { oscillation: None, surface_velocity: DVec3::X * 0.5 };
        let plate = Primitive::Box { size: DVec3::new(1.8, 0.1, 1.8), divisions: 1 };
        let plate = Body::new(solid(&plate.mesh().unwrap()))
            .position(DVec3::Y * -0.9)
            .surface(Surface::Mesh)
            .motion(Motion::Prescribed(belt));
        let ball = Arc::new(Shape::from_particles(&[DVec3::ZERO, DVec3::X * 0.02]).unwrap());
        let ball = |index: usize| {
            let of = |n: usize| n as f64 * 0.15;
            let place = DVec3::new(of(index % 5), of(index / 25), of(index / 5 % 5));
            Body::new(ball.clone())
                .position(place - DVec3::new(0.3, 0.78, 0.3))
                .surface(Surface::Spheres { radius: 0.06 })
                .velocity(DVec3::Y * (0.1 * (index % 3) as f64 - 0.5))
        };
        let material = material(0.4, Damping::Restitution(0.5));
        let builder = room().integrator(integrator).dt(dt).material(material).body(plate);
        let world = (0..100).map(ball).fold(builder, WorldBuilder::body).build().unwrap();
        let [_, between] = check(world, (0.25 / dt) as u64);
        assert!(between > 100, "{integrator:?} {between}");
    }
}

#[test]
fn a_body_with_a_given_centre_of_mass_has_its_contacts_about_it() {
    let shape = solid(&box_mesh(2));
    let gyration = shape.gyration() + DMat3::IDENTITY * 0.01;
    let loaded = shape.with_distribution(DVec3::new(0.05, -0.02, 0.03), gyration).unwrap();
    let builder = room().dt(2e-4).material(material(0.4, Damping::Restitution(0.5)));
    assert!(check(builder.body(thrown(loaded, 0)).build().unwrap(), 1500)[0] > 50);
}

#[test]
fn contacts_are_known_only_where_they_are_kept() {
    let world = room().dt(1e-3).body(thrown(solid(&box_mesh(2)), 0)).build().unwrap();
    let (mut kept, mut plain) = (world.clone(), world);
    kept.keep_contacts(true);
    assert_eq!(kept.contacts(), []);
    let mut seen = 0;
    for _ in 0..20 {
        kept.steps(25).unwrap();
        plain.steps(25).unwrap();
        seen += kept.contacts().len();
        assert_eq!(plain.contacts(), []);
    }
    assert!(seen > 0);
    // that they are kept changes nothing
    assert_eq!(kept.state().hash(), plain.state().hash());
    kept.clear_scratch();
    assert_eq!(kept.contacts(), []);
}
