//! Unusual contacts between bodies: no panic, no NaN, no loss of momentum.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use tumble::{
    Body, BuildError, DMat3, DQuat, DVec3, Damping, Integrator, MassModel, Material, Mesh, Motion,
    Overlaps, Prescribed, Primitive, Sampling, Shape, Surface, WallPlane, World, WorldBuilder,
};

fn ball(radius: f64) -> Shape {
    let gyration = DMat3::IDENTITY * (0.4 * radius * radius);
    Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, gyration).unwrap()
}

fn point() -> Shape {
    Shape::from_particles(&[DVec3::ZERO]).unwrap()
}

fn solid(primitive: Primitive) -> Shape {
    Shape::from_mesh(&primitive.mesh().unwrap(), Sampling::Vertices, MassModel::Solid).unwrap()
}

fn cube(size: f64) -> Shape {
    solid(Primitive::Box { size: DVec3::splat(size), divisions: 2 })
}

fn spheres(radius: f64) -> Surface {
    Surface::Spheres { radius }
}

fn held() -> Motion {
    Motion::Prescribed(Prescribed::default())
}

fn material(stiffness: f64, e: f64, friction: f64) -> Material {
    Material {
        collision_stiffness: stiffness,
        damping: Damping::Restitution(e),
        friction_stiffness: friction,
        ..Material::default()
    }
}

fn space(material: Material, dt: f64) -> WorldBuilder {
    World::builder().gravity(DVec3::ZERO).material(material).dt(dt)
}

fn advance(world: &mut World, time: f64) {
    let end = world.time() + time - 0.5 * world.dt();
    while world.time() < end {
        world.step().unwrap();
    }
}

/// Σ M v and Σ x × M v + L, each with the sum of magnitudes as a scale.
fn momenta(world: &World) -> [(DVec3, f64); 2] {
    let mut sums = [(DVec3::ZERO, 0.0); 2];
    for body in world.bodies() {
        let p = body.velocity() * body.model().mass;
        let (orbit, spin) = (body.position().cross(p), body.angular_momentum());
        sums[0] = (sums[0].0 + p, sums[0].1 + p.length());
        sums[1] = (sums[1].0 + orbit + spin, sums[1].1 + orbit.length() + spin.length());
    }
    sums
}

#[track_caller]
fn assert_same_momenta(before: [(DVec3, f64); 2], world: &World, bound: f64) {
    for ((now, scale), (then, old_scale)) in momenta(world).into_iter().zip(before) {
        let off = (now - then).length() / scale.max(old_scale).max(1e-300);
        assert!(off < bound, "{off:e}: {then} {now}");
    }
}

#[test]
fn cached_neighbour_lists_find_contacts_exact_to_rounding() {
    let mut touched = 0;
    for seed in 0..400 {
        // spheres that approach each other, or a cube, by about one rounding per step
        let place = DVec3::new(1.3, 0.7, 2.1) * (1.0 + f64::from(seed) * 0.37);
        let way = DVec3::new(0.6, 0.64, 0.48);
        let rounding = f64::EPSILON * place.length();
        let gap = f64::from(seed % 20) * rounding;
        let other = if seed % 2 == 0 {
            Body::new(ball(0.1)).surface(spheres(0.1)).position(place - way * (0.2 + gap))
        } else {
            let turned = DQuat::from_rotation_arc(DVec3::X, way);
            let apart = place - way * (0.2 + gap);
            Body::new(cube(0.2)).surface(Surface::Mesh).position(apart).orientation(turned)
        };
        let mover = Body::new(ball(0.1)).surface(spheres(0.1)).position(place);
        let mut cached = space(material(1e4, 0.5, 0.5), 1e-4)
            .body(mover.velocity(way * (-0.7e4 * rounding)))
            .body(other)
            .build()
            .unwrap();
        let mut uncached = cached.clone();
        for _ in 0..60 {
            cached.step().unwrap();
            uncached.clear_scratch();
            uncached.step().unwrap();
        }
        assert_eq!(cached.state().hash(), uncached.state().hash(), "{seed}");
        touched += u32::from(cached.state().totals.max_depth > 0.0);
    }
    assert!(touched > 300, "{touched}");
}

#[test]
fn spheres_with_coincident_centres_are_refused() {
    let body = |x: f64| Body::new(ball(0.1)).mass(1.0).surface(spheres(0.1)).position(DVec3::X * x);
    let refused = space(material(1e4, 0.5, 0.3), 1e-4).body(body(0.0)).body(body(0.0)).build();
    let errors = refused.unwrap_err().0;
    let overlap = matches!(errors[..], [BuildError::Overlap { depth, .. }] if depth == 0.2);
    assert!(overlap, "{errors:?}");
    // a restored state may contain them
    let mut world =
        space(material(1e4, 0.5, 0.3), 1e-4).body(body(0.0)).body(body(1.0)).build().unwrap();
    let mut state = world.state().clone();
    state.bodies[1].position = DVec3::ZERO;
    world.restore(state).unwrap();
    let before = momenta(&world);
    let error = world.step().unwrap_err();
    assert_eq!(error.body_depth.unwrap().depth, 0.2);
    assert_same_momenta(before, &world, 1e-13);
}

/// A sphere that falls straight onto the middle of a face, an edge or a vertex rebounds straight.
#[test]
fn a_sphere_rebounds_straight_from_a_face_an_edge_and_a_vertex() {
    for (e, direction) in [
        (1.0, DVec3::Y),
        (1.0, DVec3::new(1.0, 1.0, 0.0)),
        (1.0, DVec3::ONE),
        (0.5, DVec3::new(0.0, 1.0, 1.0)),
    ] {
        let way = direction.normalize();
        let foot = direction * 0.1;
        for radius in [0.05, 0.0] {
            let surface = if radius > 0.0 { spheres(radius) } else { Surface::None };
            let mover = Body::new(if radius > 0.0 { ball(radius) } else { point() })
                .mass(0.3)
                .surface(surface)
                .position(foot + way * (radius + 0.01))
                .velocity(way * -1.0);
            let mut world = space(material(1e5, e, 0.3), 1e-5)
                .body(Body::new(cube(0.2)).surface(Surface::Mesh).motion(held()))
                .body(mover)
                .build()
                .unwrap();
            advance(&mut world, 0.05);
            let v = world.body(1).velocity();
            // a particle that enters beside an edge is pushed out by one of the faces
            assert!(
                v.length() <= 1.0 + 1e-6 && (radius == 0.0 || (v - way * e).length() < 1e-2),
                "{direction} r = {radius} e = {e}: {v}"
            );
        }
    }
}

/// The centre of a sphere, or a particle, exactly on the surface, or where two faces are equally near.
#[test]
fn a_centre_exactly_on_a_feature_conserves_momentum_and_energy() {
    let places = [
        DVec3::Y * 0.1,
        DVec3::new(0.1, 0.1, 0.0),
        DVec3::splat(0.1),
        DVec3::new(0.05, 0.05, 0.0),
        DVec3::ZERO,
    ];
    for place in places {
        for surface in [Surface::None, spheres(0.02)] {
            let mut world = space(material(1e4, 0.5, 0.3), 1e-5)
                .body(Body::new(cube(0.2)).mass(2.0).surface(Surface::Mesh))
                .body(Body::new(ball(0.02)).mass(0.1).surface(surface).position(DVec3::X))
                .build()
                .unwrap();
            let mut state = world.state().clone();
            state.bodies[1].position = place;
            world.restore(state).unwrap();
            let start = world.energy().total();
            if place == DVec3::ZERO {
                // in the middle, as deep as possible
                assert!(world.step().unwrap_err().body_depth.is_some());
                continue;
            }
            advance(&mut world, 0.2);
            for (sum, scale) in momenta(&world) {
                assert!(sum.length() < 1e-12 * scale + 1e-12, "{place}: {sum}");
            }
            let energy = world.energy();
            assert!(energy.total().is_finite());
            assert!(
                (energy.total() - start).abs() < 2e-2 * start.max(1e-9),
                "{place} {start} {energy:?}"
            );
        }
    }
}

#[test]
fn points_needles_and_unequal_masses_conserve_momenta() {
    let needle: Vec<_> = (0..20).map(|i| DVec3::X * (f64::from(i) * 0.01)).collect();
    let needle = Arc::new(Shape::from_particles(&needle).unwrap());
    for integrator in [Integrator::Splitting, Integrator::Euler] {
        for (light, heavy) in [(1.0, 1.0), (1e-6, 1e6)] {
            let k = 1e4 * light;
            let mut world = space(material(k, 0.6, 0.4), 1e-5)
                .integrator(integrator)
                .velocity_damping_stiffness(0.0)
                .body(
                    Body::new(Arc::clone(&needle))
                        .mass(light)
                        .surface(spheres(0.01))
                        .position(DVec3::ZERO),
                )
                .body(
                    Body::new(point())
                        .mass(heavy)
                        .surface(spheres(0.03))
                        .position(DVec3::new(0.05, 0.06, 0.001))
                        .velocity(DVec3::Y * -1.0),
                )
                .body(
                    Body::new(cube(0.1))
                        .mass(heavy)
                        .surface(Surface::Mesh)
                        .position(DVec3::new(0.0, -0.1, 0.0)),
                )
                .body(
                    Body::new(point())
                        .mass(light)
                        .position(DVec3::new(0.02, 0.5, 0.0))
                        .velocity(DVec3::Y * -2.0),
                )
                .build()
                .unwrap();
            let before = momenta(&world);
            let start = world.energy().total();
            let depth = |world: &World| world.state().totals.max_depth;
            let result = (0..50_000).try_for_each(|_| world.step());
            assert!(depth(&world) > 0.0);
            match result {
                Ok(()) => {
                    let bound = if integrator == Integrator::Euler { 1e-4 } else { 1e-10 };
                    assert_same_momenta(before, &world, bound);
                    let off = (world.energy().total() - start) / start;
                    println!("{integrator:?} {light:e} {off:e}");
                }
                Err(error) => panic!("{integrator:?} {light:e} {heavy:e}: {error}"),
            }
        }
    }
}

/// Three bodies that collide, in scaled units.
fn collision(length: f64, mass: f64, time: f64) -> World {
    let k = 1e5 * mass / time / time;
    let speed = length / time;
    let clump: Vec<_> =
        [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * (0.1 * length)).to_vec();
    let clump = Arc::new(Shape::from_particles(&clump).unwrap());
    space(material(k, 0.5, 0.4), 0.0001220703125 * time)
        .body(Body::new(Arc::clone(&clump)).mass(2.0 * mass).surface(spheres(0.06 * length)))
        .body(
            Body::new(clump)
                .mass(1.0 * mass)
                .surface(spheres(0.06 * length))
                .position(DVec3::new(0.4, 0.02, 0.0) * length)
                .velocity(DVec3::X * (-2.0 * speed))
                .angular_velocity(DVec3::new(1.0, 4.0, -2.0) / time),
        )
        .body(
            Body::new(cube(0.25 * length))
                .mass(4.0 * mass)
                .surface(Surface::Mesh)
                .position(DVec3::new(-0.4, 0.05, 0.03) * length)
                .velocity(DVec3::X * speed),
        )
        .build()
        .unwrap()
}

#[test]
fn scaling_units_by_powers_of_two_does_not_change_any_bit() {
    let mut plain = collision(1.0, 1.0, 1.0);
    let steps = 6000;
    (0..steps).for_each(|_| plain.step().unwrap());
    assert!(plain.state().totals.max_depth > 1e-3 && plain.state().totals.slip > 0.0);
    let big = 1048576.0;
    for (length, mass, time) in
        [(1.0, big, 1.0), (big, 1.0, big), (1.0 / big, 1.0 / big, 1.0 / 1024.0)]
    {
        let mut scaled = collision(length, mass, time);
        (0..steps).for_each(|_| scaled.step().unwrap());
        for (a, b) in plain.state().bodies.iter().zip(&scaled.state().bodies) {
            assert_eq!(a.position * length, b.position, "{length} {mass} {time}");
            assert_eq!(a.velocity * (length / time), b.velocity);
            assert_eq!(a.orientation, b.orientation);
        }
        let (a, b) = (plain.state().totals, scaled.state().totals);
        assert_eq!(a.slip * (mass * length * length / time / time), b.slip);
        assert_eq!(a.max_depth * length, b.max_depth);
    }
}

/// A closed box with a cavity: an outer and an inner surface.
fn hollow(outer: f64, inner: f64) -> Shape {
    let skin =
        |size: f64| Primitive::Box { size: DVec3::splat(size), divisions: 2 }.mesh().unwrap();
    let mut mesh = skin(outer);
    let within = skin(inner);
    let start = mesh.vertices.len() as u32;
    mesh.vertices.extend(within.vertices);
    mesh.triangles
        .extend(within.triangles.iter().map(|[a, b, c]| [a + start, c + start, b + start]));
    Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap()
}

#[test]
fn bodies_stay_in_a_rotating_drum_and_the_ledger_has_its_work() {
    for first in [true, false] {
        let drum = Body::new(hollow(0.6, 0.5))
            .surface(Surface::Mesh)
            .motion(held())
            .position(DVec3::ZERO)
            .angular_velocity(DVec3::Z * 3.0);
        let mut world = World::builder().material(material(2e4, 0.3, 0.5)).dt(5e-5);
        if first {
            world = world.body(drum.clone());
        }
        let inside = [Surface::None, spheres(0.03), Surface::Mesh];
        for (x, surface) in [-0.12, 0.0, 0.12].into_iter().zip(inside) {
            let shape = if surface == Surface::Mesh { cube(0.08) } else { ball(0.03) };
            world = world.body(Body::new(shape).mass(0.5).surface(surface).position(DVec3::X * x));
        }
        if !first {
            world = world.body(drum);
        }
        let mut world = world.build().unwrap();
        let start = world.energy();
        advance(&mut world, 2.0);
        let energy = world.energy();
        for body in world.bodies().filter(|body| body.model().is_free()) {
            let place = body.position();
            assert!(place.length() < 0.25 * 1.7321, "{} left: {place}", body.name());
        }
        let in_play = energy.work.abs() + energy.dashpot + energy.slip;
        let off = (energy.total() - start.total()).abs() / in_play;
        println!("drum first {first}: {off:e} {energy:?}");
        assert!(energy.work > 0.0 && off < 1e-2, "{off:e} {energy:?}");
    }
}

#[test]
fn many_coincident_bodies_are_refused_quickly() {
    let shape = Arc::new(cube(0.1));
    let body = Arc::new(ball(0.1));
    for surface in [Surface::Mesh, spheres(0.1)] {
        let shape = if surface == Surface::Mesh { &shape } else { &body };
        let many =
            (0..2000).map(|_| Body::new(Arc::clone(shape)).surface(surface).position(DVec3::ONE));
        let begun = std::time::Instant::now();
        let world = many.fold(space(material(1e4, 0.5, 0.0), 1e-4), WorldBuilder::body);
        // they cannot be pushed apart either
        world.clone().overlaps(Overlaps::Push).build().unwrap_err();
        let errors = world.build().unwrap_err();
        println!("{surface:?}: {} errors, {:?}", errors.0.len(), begun.elapsed());
        assert!(errors.0.iter().all(|error| matches!(error, BuildError::Overlap { .. })));
        assert!(begun.elapsed().as_secs() < 60);
    }
}

#[test]
fn an_error_for_a_fast_body_names_both_bodies_and_a_step_that_works() {
    for (mover, target) in [
        (
            Body::new(ball(0.02)).surface(spheres(0.02)),
            Body::new(ball(0.02)).surface(spheres(0.02)),
        ),
        (Body::new(ball(0.02)).surface(spheres(0.02)), Body::new(cube(0.1)).surface(Surface::Mesh)),
        (Body::new(cube(0.1)).surface(Surface::Mesh), Body::new(cube(0.1)).surface(Surface::Mesh)),
    ] {
        let build = |dt: f64| {
            let mover = mover.clone().name("bullet").mass(1.0).position(DVec3::X * -20.0);
            space(material(1e4, 0.5, 0.0), dt)
                .body(mover.velocity(DVec3::X * 3000.0))
                .body(target.clone().name("target").mass(1.0).position(DVec3::ZERO))
                .build()
                .unwrap()
        };
        let mut world = build(1e-3);
        let error = (0..100).find_map(|_| world.step().err()).unwrap();
        let told = error.to_string();
        assert!(told.contains("\"bullet\"") && told.contains("\"target\""), "{told}");
        // the text rounds it to two digits
        let dt: f64 = format!("{:.1e}", error.dt.unwrap()).parse().unwrap();
        let mut world = build(dt);
        let end = 30.0 / 3000.0;
        while world.time() < end {
            // the springs are too soft for it, which is another error
            if let Err(error) = world.step() {
                assert!(error.body_depth.is_some(), "{error}");
                break;
            }
        }
        assert!(world.state().totals.max_depth > 0.0, "{told}: passed through");
    }
}

#[test]
fn bodies_that_fly_far_apart_stay_finite_and_conserve_momenta() {
    let mut world = space(material(1e4, 1.0, 0.3), 1e-2);
    for number in 0..50 {
        let way = DVec3::new(f64::from(number % 5) - 2.0, f64::from(number / 5) - 4.5, 1.0);
        let body = Body::new(ball(0.1)).mass(100.0).surface(spheres(0.1)).position(way);
        world = world.body(body.velocity(way * 1e8).angular_velocity(DVec3::Y));
    }
    let mut world = world.build().unwrap();
    let mut state = world.state().clone();
    state.bodies.iter_mut().for_each(|body| body.position *= 1e7);
    world.restore(state).unwrap();
    let before = momenta(&world);
    advance(&mut world, 10.0);
    assert_same_momenta(before, &world, 1e-12);
    assert!(world.body(0).position().length() > 1e9);
}

#[test]
fn a_prescribed_body_may_be_first_or_second() {
    let fall = |first: bool, integrator: Integrator, surface: Surface| {
        let floor =
            Body::new(solid(Primitive::Box { size: DVec3::new(2.0, 0.2, 2.0), divisions: 1 }))
                .name("floor")
                .position(DVec3::Y * -0.1)
                .surface(Surface::Mesh)
                .motion(held());
        let shape = if surface == Surface::Mesh { cube(0.1) } else { ball(0.05) };
        let body = Body::new(shape)
            .name("faller")
            .mass(0.7)
            .surface(surface)
            .position(DVec3::new(0.01, 0.2, 0.02))
            .velocity(DVec3::new(0.5, 0.0, 0.1));
        let world =
            World::builder().material(material(2e4, 0.5, 0.4)).dt(1e-4).integrator(integrator);
        let bodies = if first { [floor, body] } else { [body, floor] };
        let mut world = bodies.into_iter().fold(world, WorldBuilder::body).build().unwrap();
        advance(&mut world, 0.6);
        let body = world.body(usize::from(first));
        assert_eq!(body.name(), "faller");
        (body.position(), body.velocity(), world.state().totals)
    };
    for integrator in [Integrator::Splitting, Integrator::Euler] {
        for surface in [Surface::Mesh, spheres(0.05), Surface::None] {
            let (a, b) = (fall(true, integrator, surface), fall(false, integrator, surface));
            assert!(a.2.max_depth > 1e-3);
            let apart = (a.0 - b.0).length() + (a.1 - b.1).length();
            println!("{integrator:?} {surface:?} {apart:e}");
            assert!(apart < 1e-9, "{integrator:?} {surface:?}: {apart:e}");
            assert!((a.2.slip - b.2.slip).abs() < 1e-9 && (a.2.dashpot - b.2.dashpot).abs() < 1e-9);
            assert_eq!(a.2.work.abs().max(b.2.work.abs()), 0.0);
        }
    }
}

/// Without friction a sphere keeps its spin; without damping two bodies keep their energy.
#[test]
fn frictionless_contact_conserves_spin_and_elastic_contact_energy() {
    let body = |x: f64, y: f64| {
        Body::new(ball(0.1)).mass(1.0).surface(spheres(0.1)).position(DVec3::new(x, y, 0.0))
    };
    let mut world = space(material(1e5, 1.0, 0.0), 1e-5)
        .body(body(-0.3, 0.07).velocity(DVec3::X * 2.0).angular_velocity(DVec3::new(1.0, 2.0, 3.0)))
        .body(body(0.0, 0.0))
        .build()
        .unwrap();
    let (start, spin) = (world.energy(), world.body(0).angular_momentum());
    advance(&mut world, 0.5);
    let end = world.energy();
    assert!((world.body(0).angular_momentum() - spin).length() < 1e-15);
    assert!(world.body(1).angular_momentum().length() < 1e-15);
    assert_eq!((end.slip, end.dashpot), (0.0, 0.0));
    assert!((end.total() / start.total() - 1.0).abs() < 1e-6);
    assert!(world.body(1).velocity().length() > 1.0);
}

/// Drag of the medium, contact between bodies and a wall together.
#[test]
fn the_residual_is_small_with_drag_and_contact_together() {
    for integrator in [Integrator::Splitting, Integrator::Euler] {
        let body =
            |y: f64| Body::new(ball(0.1)).mass(1.0).surface(spheres(0.1)).position(DVec3::Y * y);
        let mut world = World::builder()
            .material(material(1e5, 0.7, 0.4))
            .dt(1e-5)
            .integrator(integrator)
            .velocity_damping_stiffness(0.3)
            .wall(WallPlane { normal: DVec3::Y, offset: 0.0 })
            .body(body(0.4).velocity(DVec3::X * 0.1))
            .body(body(0.8))
            .body(
                Body::new(cube(0.15))
                    .mass(0.5)
                    .surface(Surface::Mesh)
                    .position(DVec3::new(0.02, 1.3, 0.01)),
            )
            .build()
            .unwrap();
        let start = world.energy().total();
        advance(&mut world, 1.0);
        let energy = world.energy();
        let off = (energy.total() - start).abs() / start;
        println!("{integrator:?} {off:e} {energy:?}");
        assert!(energy.drag > 0.01 && energy.slip > 0.0 && off < 1e-3, "{off:e} {energy:?}");
    }
}

/// Two cubes with nearly the same centre, one rotated: no vertex of one need be inside the other.
#[test]
fn overlapping_bodies_without_a_particle_inside_the_other_are_refused() {
    let quarter = std::f64::consts::FRAC_PI_4;
    for turn in
        [DQuat::IDENTITY, DQuat::from_rotation_y(quarter), DQuat::from_rotation_x(2.0 * quarter)]
    {
        let body = |name| Body::new(cube(0.2)).surface(Surface::Mesh).name(name);
        let world = space(material(1e4, 0.5, 0.0), 1e-4)
            .body(body("a").position(DVec3::ONE))
            .body(body("b").position(DVec3::ONE + DVec3::X * 1e-3).orientation(turn));
        let errors = world.build().unwrap_err().0;
        assert!(
            matches!(errors[..], [BuildError::Overlap { depth, .. }] if depth > 0.09),
            "{errors:?}"
        );
    }
}

/// Regression: many bodies of random orientation nearly at one position must not take much memory.
#[test]
fn many_bodies_nearly_at_one_position_are_refused_quickly() {
    let mut builder = World::builder().dt(1e-4);
    let clump =
        std::sync::Arc::new(Shape::from_particles(&[DVec3::X * 0.05, DVec3::X * -0.05]).unwrap());
    for index in 0..20_000 {
        let turn = DQuat::from_rotation_y(f64::from(index) * 0.1);
        let body = Body::new(clump.clone()).surface(Surface::Spheres { radius: 0.05 });
        let at = DVec3::X * (f64::from(index) * 1e-9);
        builder = builder.body(body.orientation(turn).position(at));
    }
    let errors = builder.build().unwrap_err();
    assert!(errors.to_string().contains("start"), "{errors}");
}

/// Regression: the dashpot between a particle and a sphere must not depend on the order of the bodies.
#[test]
fn the_result_does_not_depend_on_the_order_of_the_bodies() {
    let throw = |swap: bool| {
        let cube: Vec<_> = (0..8)
            .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 0.1)
            .collect();
        let cube = Body::new(Shape::from_particles(&cube).unwrap()).name("cube").mass(1.0);
        let ball = Shape::from_particles(&[DVec3::ZERO]).unwrap();
        let ball = Body::new(ball).name("ball").mass(1.0);
        let ball = ball.surface(Surface::Spheres { radius: 0.05 });
        let ball = ball.position(DVec3::new(-0.2, 0.01, 0.02)).velocity(DVec3::X * 2.0);
        let material = Material {
            damping: Damping::Restitution(0.5),
            friction_stiffness: 0.3,
            ..Material::default()
        };
        let world = World::builder().dt(1e-4).gravity(DVec3::ZERO).material(material);
        let world = if swap { world.body(ball).body(cube) } else { world.body(cube).body(ball) };
        let mut world = world.build().unwrap();
        while world.time() < 0.3 {
            world.step().unwrap();
        }
        assert!(world.state().totals.max_depth > 0.0);
        world.bodies().find(|body| body.name() == "ball").map(|body| body.velocity()).unwrap()
    };
    let apart = (throw(false) - throw(true)).length();
    assert!(apart < 1e-12, "{apart:e}");
}
