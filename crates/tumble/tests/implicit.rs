//! The integrator `implicit`: big steps with the materials of the scene.

#![allow(clippy::unwrap_used)]

use tumble::{
    Body, DVec3, Damping, Integrator, MassModel, Material, Mesh, Primitive, Sampling, Shape,
    Surface, WallPlane, World, WorldBuilder,
};

const FLOOR: WallPlane = WallPlane { normal: DVec3::Y, offset: 0.0 };

fn material(restitution: f64) -> Material {
    Material {
        collision_stiffness: 1e5,
        damping: Damping::Restitution(restitution),
        friction_stiffness: 0.5,
        ..Material::default()
    }
}

fn implicit(dt: f64) -> WorldBuilder {
    World::builder().integrator(Integrator::Implicit).dt(dt).material(material(0.5))
}

fn cube() -> Body {
    let mesh = Primitive::Box { size: DVec3::splat(0.2), divisions: 1 }.mesh().unwrap();
    let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap();
    Body::new(shape).mass(8.0).surface(Surface::Mesh)
}

fn particle() -> Body {
    Body::new(Shape::from_particles(&[DVec3::ZERO]).unwrap()).mass(1.0)
}

fn ball(radius: f64) -> Body {
    let inertia = tumble::DMat3::IDENTITY * (0.4 * radius * radius);
    let shape = Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, inertia);
    Body::new(shape.unwrap()).mass(1.0).surface(Surface::Spheres { radius })
}

fn run(world: &mut World, until: f64) {
    while world.time() < until - 1e-9 {
        world.step().unwrap();
    }
}

/// g at a slope of `ratio` times the angle of friction.
fn gravity_on_slope(ratio: f64) -> (DVec3, f64) {
    let angle = (0.5 * ratio).atan();
    let (sin, cos) = angle.sin_cos();
    (DVec3::new(9.8 * sin, -9.8 * cos, 0.0), 9.8 * (sin - 0.5 * cos))
}

#[test]
fn a_block_on_a_slope_stays_below_the_angle_of_friction_and_slides_above_it() {
    for dt in [1e-3, 5e-3] {
        for ratio in [0.9, 1.1] {
            let (gravity, expected) = gravity_on_slope(ratio);
            let body = cube().position(DVec3::Y * 0.0999);
            let mut world = implicit(dt).gravity(gravity).wall(FLOOR).body(body).build().unwrap();
            run(&mut world, 2.0);
            let (x, v) = (world.body(0).position().x, world.body(0).velocity().x);
            run(&mut world, 3.0);
            let (creep, acceleration) =
                (world.body(0).position().x - x, world.body(0).velocity().x - v);
            if ratio < 1.0 {
                assert!(creep.abs() < 1e-12, "creep {creep:e} m/s at dt = {dt}");
            } else {
                let error = acceleration / expected - 1.0;
                assert!(error.abs() < 1e-6, "acceleration off by {error:e} at dt = {dt}");
            }
        }
    }
}

#[test]
fn impacts_shorter_than_the_step_have_the_restitution_that_is_asked_for() {
    for restitution in [0.1, 0.5, 0.9] {
        for dt in [1.0 / 60.0, 1.0 / 30.0] {
            for phase in [0.1, 0.4, 0.8] {
                let body =
                    particle().position(DVec3::Y * (0.02 + phase * dt)).velocity(DVec3::NEG_Y);
                let world = implicit(dt).material(material(restitution)).gravity(DVec3::ZERO);
                let mut world = world.wall(FLOOR).body(body).build().unwrap();
                run(&mut world, 0.2);
                let found = world.body(0).velocity().y;
                assert!((found - restitution).abs() < 0.03, "{restitution}: {found}, {dt} {phase}");
                let energy = world.energy();
                assert!((energy.total() - 0.5).abs() < 1e-12, "{energy:?}");
            }
        }
    }
}

/// Two balls that meet off centre, with friction.
fn two_balls(dt: f64, restitution: f64) -> World {
    let first = ball(0.1).velocity(DVec3::new(1.0, 0.0, 0.0));
    let second = ball(0.1).position(DVec3::new(0.3, 0.1, 0.05));
    let world = implicit(dt).material(material(restitution)).gravity(DVec3::ZERO);
    world.body(first).body(second).build().unwrap()
}

#[test]
fn momentum_is_conserved_to_rounding_at_any_step() {
    for dt in [1e-4, 1e-3, 1.0 / 60.0] {
        let mut world = two_balls(dt, 0.5);
        let momenta = |world: &World| {
            world.bodies().fold((DVec3::ZERO, DVec3::ZERO), |(p, l), body| {
                let momentum = body.velocity() * body.model().mass;
                (p + momentum, l + body.angular_momentum() + body.position().cross(momentum))
            })
        };
        let (p, l) = momenta(&world);
        run(&mut world, 0.6);
        assert!(world.body(1).velocity().length() > 0.1);
        let (p_end, l_end) = momenta(&world);
        assert!((p_end - p).length() < 1e-14 && (l_end - l).length() < 1e-14);
    }
}

#[test]
fn small_steps_lead_to_the_motion_of_splitting() {
    let smooth = Material { friction_stiffness: 0.0, ..material(0.5) };
    let end = |integrator: Integrator, dt: f64| {
        let first = ball(0.1).velocity(DVec3::new(1.0, 0.0, 0.0));
        let second = ball(0.1).position(DVec3::new(0.3, 0.1, 0.05));
        let world = implicit(dt).integrator(integrator).material(smooth).gravity(DVec3::ZERO);
        let mut world = world.body(first).body(second).build().unwrap();
        run(&mut world, 0.5);
        world.body(1).velocity()
    };
    let exact = end(Integrator::Splitting, 2e-6);
    let errors = [2e-4, 5e-5].map(|dt| (end(Integrator::Implicit, dt) - exact).length());
    assert!(errors[0] < 3e-4 && errors[1] < errors[0] / 8.0, "{errors:?}");
}

fn stack(dt: f64, count: usize) -> World {
    let boxes = (0..count).map(|i| cube().position(DVec3::Y * (0.1 + 0.2 * i as f64)));
    let material = Material { collision_stiffness_per_area: Some(1e8), ..material(0.3) };
    let world = boxes.fold(implicit(dt).material(material).wall(FLOOR), WorldBuilder::body);
    world.build().unwrap()
}

#[test]
fn stacks_of_boxes_stand_in_long_steps_and_their_ledger_closes() {
    for (dt, count) in [(1.0 / 240.0, 2), (1.0 / 60.0, 4)] {
        let mut world = stack(dt, count);
        let start = world.energy().total();
        run(&mut world, 2.0);
        for (index, body) in world.bodies().enumerate() {
            let place = DVec3::Y * (0.1 + 0.2 * index as f64);
            assert!(body.position().distance(place) < 2e-4, "{index}: {}", body.position());
        }
        let energy = world.energy();
        assert!(energy.kinetic < 1e-3 && (energy.total() - start).abs() < 1e-4, "{energy:?}");
        assert_eq!(world.state().totals.not_converged, 0);
    }
}

#[test]
fn a_restored_state_leads_to_the_same_bits() {
    let mut world = stack(1.0 / 120.0, 3);
    run(&mut world, 0.1);
    let middle = world.state().clone();
    run(&mut world, 0.3);
    let mut again = stack(1.0 / 120.0, 3);
    again.restore(middle).unwrap();
    run(&mut again, 0.3);
    assert_eq!(world.state().hash(), again.state().hash());
    let mut threads = stack(1.0 / 120.0, 3);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    pool.install(|| run(&mut threads, 0.3));
    assert_eq!(world.state().hash(), threads.state().hash());
}

/// A block of balls that fall on the floor, with enough contacts for several threads.
fn block_of_balls() -> World {
    let places = (0..720).map(|i| DVec3::new((i % 9) as f64, (i / 81) as f64, (i / 9 % 9) as f64));
    let balls = places.map(|place| ball(0.1).position(DVec3::Y * 0.099 + place * 0.199));
    balls.fold(implicit(2e-3).wall(FLOOR), WorldBuilder::body).build().unwrap()
}

#[test]
fn any_number_of_threads_leads_to_the_same_bits() {
    let hash = |threads: usize| {
        let mut world = block_of_balls();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| world.steps(1)).unwrap();
        let contacts = world.state().pair_impulses.len();
        assert!(contacts > 1000, "{contacts} contacts are too few for several threads");
        pool.install(|| world.steps(19)).unwrap();
        assert!(world.state().totals.iterations > 20, "nothing to solve");
        world.state().hash()
    };
    let alone = hash(1);
    for threads in [2, 3, 8] {
        assert_eq!(hash(threads), alone, "{threads} threads");
    }
}

/// A row of balls that touch, hit by one at 1 m/s.
#[test]
fn an_elastic_impact_of_many_balls_conserves_energy_in_few_steps() {
    let free = implicit(2e-3).material(material(1.0)).gravity(DVec3::ZERO);
    let solver = tumble::SolverSettings { tolerance: 1e-12, max_iterations: 1000 };
    let first = ball(0.1).position(DVec3::X * -0.5).velocity(DVec3::X);
    let row = (0..4).map(|i| ball(0.1).position(DVec3::X * (0.2 * f64::from(i))));
    let mut world = row.fold(free.solver(solver).body(first), WorldBuilder::body).build().unwrap();
    run(&mut world, 1.0);
    assert!(world.body(4).velocity().x > 0.7, "{}", world.body(4).velocity());
    assert!((world.energy().kinetic - 0.5).abs() < 1e-12, "{:?}", world.energy());
}

#[test]
fn the_first_touch_of_falling_bodies_is_found() {
    let sphere = Primitive::Sphere { radius: 0.3, subdivisions: 1 }.mesh().unwrap();
    let sphere = Shape::from_mesh(&sphere, Sampling::Vertices, MassModel::Solid).unwrap();
    let sphere = Body::new(sphere).mass(8.0).surface(Surface::Mesh);
    let sphere = sphere.position(DVec3::Y * 0.6).velocity(DVec3::NEG_Y * 2.0);
    let mut world = implicit(2e-3).body(cube()).body(sphere).build().unwrap();
    let start = world.energy().total();
    run(&mut world, 0.3);
    let energy = world.energy();
    assert!((energy.total() - start).abs() < 1e-2, "{energy:?}");
    assert!(world.body(0).velocity().y < -9.8 * 0.3 - 0.5);
}
