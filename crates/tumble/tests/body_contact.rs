//! Contact between bodies.
#![allow(clippy::unwrap_used)]

use tumble::{
    Body, DQuat, DVec3, Damping, Integrator, MassModel, Material, Mesh, Motion, Overlaps,
    Prescribed, Primitive, Sampling, Shape, Surface, WallPlane, World, WorldBuilder,
};

fn ball(radius: f64) -> Shape {
    let gyration = tumble::DMat3::IDENTITY * (0.4 * radius * radius);
    Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, gyration).unwrap()
}

fn clump() -> Shape {
    let corner =
        |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5;
    let corners: Vec<_> = (0..8).map(|i| corner(i) * 0.1).collect();
    Shape::from_particles(&corners).unwrap()
}

fn solid(primitive: Primitive) -> Shape {
    Shape::from_mesh(&primitive.mesh().unwrap(), Sampling::Vertices, MassModel::Solid).unwrap()
}

fn space() -> WorldBuilder {
    World::builder().gravity(DVec3::ZERO)
}

fn material(stiffness: f64, damping: Damping, friction: f64) -> Material {
    Material {
        collision_stiffness: stiffness,
        damping,
        friction_stiffness: friction,
        ..Material::default()
    }
}

fn rough() -> Material {
    material(1e5, Damping::Restitution(0.5), 0.4)
}

/// Σ M v and Σ x × M v + L.
fn momenta(world: &World) -> (DVec3, DVec3) {
    world.bodies().fold((DVec3::ZERO, DVec3::ZERO), |(p, l), body| {
        let momentum = body.velocity() * body.model().mass;
        (p + momentum, l + body.position().cross(momentum) + body.angular_momentum())
    })
}

/// Three bodies that collide off centre.
fn collision(shape: Shape, surface: Surface, dt: f64) -> World {
    let shape = std::sync::Arc::new(shape);
    let body = || Body::new(shape.clone()).mass(2.0).surface(surface);
    let turned = DQuat::from_xyzw(0.3, -0.2, 0.5, 0.8);
    space()
        .dt(dt)
        .material(rough())
        .body(body().position(DVec3::new(-0.3, 0.02, 0.0)).velocity(DVec3::X * 2.0))
        .body(
            body()
                .position(DVec3::new(0.1, 0.0, 0.03))
                .orientation(turned)
                .angular_velocity(DVec3::new(3.0, -7.0, 2.0)),
        )
        .body(body().position(DVec3::new(0.35, 0.1, 0.0)).velocity(DVec3::X * -3.0))
        .build()
        .unwrap()
}

#[test]
fn momentum_and_angular_momentum_are_conserved_to_rounding() {
    let knot = Primitive::Knot { radius: 0.06, tube_radius: 0.02, segments: 24 };
    for (shape, surface) in [
        (clump(), Surface::Spheres { radius: 0.05 }),
        (solid(knot), Surface::Mesh),
        (solid(Primitive::Box { size: DVec3::new(0.2, 0.1, 0.15), divisions: 4 }), Surface::Mesh),
    ] {
        let mut world = collision(shape, surface, 5e-5);
        let (p, l) = momenta(&world);
        while world.time() < 0.3 {
            world.step().unwrap();
        }
        let (p_end, l_end) = momenta(&world);
        assert!(world.state().totals.max_depth > 1e-4, "{surface:?}: no contact");
        assert!((p_end - p).length() < 1e-12, "{surface:?} {}", (p_end - p).length());
        assert!((l_end - l).length() < 1e-12, "{surface:?} {}", (l_end - l).length());
    }
}

#[test]
fn the_residual_of_the_energy_ledger_is_small() {
    for (shape, surface) in [
        (clump(), Surface::Spheres { radius: 0.05 }),
        (solid(Primitive::Box { size: DVec3::new(0.2, 0.1, 0.15), divisions: 4 }), Surface::Mesh),
    ] {
        let mut world = collision(shape, surface, 1e-5);
        let start = world.energy().total();
        while world.time() < 0.3 {
            world.step().unwrap();
        }
        let energy = world.energy();
        assert!(energy.dashpot > 0.05 * start && energy.slip > 0.0, "{energy:?}");
        let residual = (energy.total() - start).abs() / start;
        assert!(residual < 5e-4, "{surface:?}: residual {residual:e}, {energy:?}");
    }
}

#[test]
fn dropping_cached_data_does_not_change_any_bit() {
    let make = || collision(clump(), Surface::Spheres { radius: 0.05 }, 1e-4);
    let (mut kept, mut forgotten) = (make(), make());
    for _ in 0..2000 {
        kept.step().unwrap();
        forgotten.clear_scratch();
        forgotten.step().unwrap();
    }
    assert!(kept.state().totals.max_depth > 0.0);
    assert_eq!(kept.state().hash(), forgotten.state().hash());
}

/// A head-on collision of two equal spheres: momentum is conserved, and the relative speed is multiplied by e.
#[test]
fn spheres_rebound_with_their_coefficient_of_restitution() {
    for e in [0.2, 0.5, 0.9, 1.0] {
        for integrator in [Integrator::Splitting, Integrator::Euler] {
            let body = |x: f64| {
                let body =
                    Body::new(ball(0.05)).mass(0.5).surface(Surface::Spheres { radius: 0.05 });
                body.position(DVec3::X * x)
            };
            let mut world = space()
                .dt(1e-5)
                .integrator(integrator)
                .material(material(1e5, Damping::Restitution(e), 0.0))
                .body(body(-0.1).velocity(DVec3::X))
                .body(body(0.1))
                .build()
                .unwrap();
            while world.time() < 0.2 {
                world.step().unwrap();
            }
            let (a, b) = (world.body(0).velocity().x, world.body(1).velocity().x);
            assert!((a + b - 1.0).abs() < 1e-13);
            assert!((b - a - e).abs() < 5e-3, "{integrator:?} e = {e}: {a} {b}");
        }
    }
}

/// A sphere on a slope with μ ≥ 2/7 tan θ rolls: a = 5/7 g sin θ.
#[test]
fn a_sphere_rolls_down_a_slope_without_slipping() {
    let angle = 0.3f64;
    let normal = DVec3::new(angle.sin(), angle.cos(), 0.0);
    let down = DVec3::new(angle.cos(), -angle.sin(), 0.0);
    let (g, mass, k) = (9.8, 0.5, 1e5);
    let sag = mass * g * angle.cos() / k;
    let body = Body::new(ball(0.05)).mass(mass).surface(Surface::Spheres { radius: 0.05 });
    let mut world = World::builder()
        .gravity(DVec3::NEG_Y * g)
        .dt(1e-4)
        .material(material(k, Damping::Restitution(0.3), 0.5))
        .wall(WallPlane { normal, offset: 0.0 })
        .body(body.position(normal * (0.05 - sag)))
        .build()
        .unwrap();
    while world.time() < 1.0 {
        world.step().unwrap();
    }
    let speed = world.body(0).velocity().dot(down);
    let expected = 5.0 / 7.0 * g * angle.sin() * world.time();
    assert!((speed / expected - 1.0).abs() < 1e-3, "{speed} {expected}");
    let spin = world.body(0).angular_velocity().length() * 0.05;
    assert!((spin / speed - 1.0).abs() < 1e-3);
    assert!(world.energy().slip < 1e-6 * world.energy().kinetic);
}

/// A wall and the face of a large static box have the same effect on a body of particles.
#[test]
fn a_static_box_acts_like_a_wall() {
    let slab = Primitive::Box { size: DVec3::new(4.0, 1.0, 4.0), divisions: 1 };
    let cube = Primitive::Box { size: DVec3::splat(0.2), divisions: 3 };
    for (e, friction, dt, bound) in
        [(1.0, 0.0, 1e-4, 1e-11), (0.5, 0.0, 1e-4, 1e-9), (0.5, 0.3, 1e-5, 1e-3)]
    {
        let fall = |with_wall: bool| {
            let floor = Body::new(solid(slab))
                .position(DVec3::Y * -0.5)
                .surface(Surface::Mesh)
                .motion(Motion::Prescribed(Prescribed::default()));
            let body = Body::new(solid(cube))
                .mass(1.0)
                .position(DVec3::new(0.0, 0.4, 0.0))
                .orientation(DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9))
                .velocity(DVec3::new(0.3, 0.0, 0.1));
            let world =
                World::builder().dt(dt).material(material(1e4, Damping::Restitution(e), friction));
            let mut world = if with_wall {
                let plane = WallPlane { normal: DVec3::Y, offset: 0.0 };
                world.wall(plane).body(body).build().unwrap()
            } else {
                world.body(body).body(floor).build().unwrap()
            };
            while world.time() < 0.6 {
                world.step().unwrap();
            }
            assert!(world.state().totals.max_depth > 1e-3);
            (world.body(0).position(), world.body(0).velocity())
        };
        let ((x, v), (y, u)) = (fall(true), fall(false));
        let apart = (x - y).length() + (v - u).length();
        assert!(apart < bound, "e = {e}, μ = {friction}: {apart:e}");
    }
}

fn nested() -> WorldBuilder {
    let cube = Primitive::Box { size: DVec3::splat(0.2), divisions: 4 };
    let shape = std::sync::Arc::new(solid(cube));
    let body = |name: &str, x: f64| {
        let body = Body::new(shape.clone()).name(name).mass(1.0).surface(Surface::Mesh);
        body.position(DVec3::new(x, 0.0, 0.0))
    };
    space().dt(1e-4).body(body("left", 0.0)).body(body("right", 0.12)).body(body("far", 0.5))
}

#[test]
fn bodies_that_overlap_initially_are_refused_by_name() {
    let errors = nested().build().unwrap_err();
    let text = errors.to_string();
    assert!(text.contains("\"left\" and \"right\" start"), "{text}");
    assert!(!text.contains("far"), "{text}");
}

#[test]
fn bodies_that_overlap_initially_are_pushed_apart_on_request() {
    let mut world = nested().overlaps(Overlaps::Push).build().unwrap();
    let apart = world.body(1).position().x - world.body(0).position().x;
    assert!((0.199..0.21).contains(&apart), "{apart}");
    assert_eq!(world.body(2).position(), DVec3::new(0.5, 0.0, 0.0));
    world.step().unwrap();
    assert!(world.body(0).velocity().length() < 0.1);
}

#[test]
fn an_error_names_bodies_that_could_pass_through_each_other() {
    let plate = Primitive::Box { size: DVec3::new(1.0, 0.02, 1.0), divisions: 2 };
    let fall = |dt: f64| {
        let plate = Body::new(solid(plate)).name("plate").surface(Surface::Mesh);
        let stone = Body::new(ball(0.005)).name("stone").mass(0.001);
        let mut world = space()
            .dt(dt)
            .force(true)
            .material(material(1e6, Damping::Restitution(0.5), 0.0))
            .body(plate.motion(Motion::Prescribed(Prescribed::default())))
            .body(stone.position(DVec3::new(0.1, 0.3, 0.2)).velocity(DVec3::NEG_Y * 100.0))
            .build()
            .unwrap();
        while world.time() < 0.01 {
            world.step()?;
        }
        Ok(world.body(1).position().y)
    };
    let error: tumble::StepError = fall(5e-4).unwrap_err();
    assert_eq!((error.body.as_str(), error.other.as_deref()), ("stone", Some("plate")));
    let text = error.to_string();
    assert!(text.contains("through which it could pass"), "{text}");
    // the suggested step works
    assert!(fall(error.dt.unwrap()).unwrap() > 0.0);
}
