//! Restoring a state reproduces the run bit for bit; a state that does not fit is refused.

#![allow(clippy::unwrap_used)]

use tumble::{
    Body, ContactKind, DQuat, DVec3, Damping, Integrator, MassModel, Material, Primitive, Sampling,
    Shape, State, StateError, Surface, WallPlane, World,
};

/// A box that tumbles down a slope with friction and dashpots, and one that falls beside it.
fn world(integrator: Integrator, tolerance: Option<f64>) -> World {
    let size = DVec3::new(0.3, 0.2, 0.25);
    let mesh = Primitive::Box { size, divisions: 2 }.mesh().unwrap();
    let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Particles).unwrap();
    let body = Body::new(shape)
        .position(DVec3::new(0.0, 0.3, 0.0))
        .orientation(DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9))
        .velocity(DVec3::new(1.0, -1.0, 0.3))
        .angular_velocity(DVec3::new(2.0, 5.0, -3.0));
    let material = Material {
        damping: Damping::Restitution(0.6),
        friction_stiffness: 0.5,
        ..Material::default()
    };
    World::builder()
        .dt(2e-4)
        .integrator(integrator)
        .energy_tolerance(tolerance)
        .material(material)
        .velocity_damping_stiffness(0.01)
        .wall(WallPlane::new(DVec3::new(0.3, 1.0, 0.0), 0.0).unwrap())
        .body(body.clone())
        .body(body.name("other").position(DVec3::new(0.0, 2.0, 0.0)))
        .build()
        .unwrap()
}

const INTEGRATORS: [(Integrator, Option<f64>); 3] =
    [(Integrator::Euler, None), (Integrator::Splitting, None), (Integrator::Splitting, Some(1e-6))];

fn advance(world: &mut World, steps: u64) {
    for _ in 0..steps {
        world.step().unwrap();
    }
}

#[test]
fn a_restored_world_continues_bit_for_bit() {
    for (integrator, tolerance) in INTEGRATORS {
        let mut whole = world(integrator, tolerance);
        let mut in_contact = 0;
        for _ in 0..20 {
            advance(&mut whole, 150);
            in_contact += whole.state().springs[0].len();
            let mut again = world(integrator, tolerance);
            again.restore(whole.state().clone()).unwrap();
            let mut further = whole.clone();
            advance(&mut further, 60);
            advance(&mut again, 60);
            assert_eq!(further.state().hash(), again.state().hash());
        }
        assert!(in_contact > 0, "no friction spring was ever there");
    }
}

#[test]
fn dropping_cached_data_before_every_step_does_not_change_any_bit() {
    for (integrator, tolerance) in INTEGRATORS {
        let (mut kept, mut forgot) = (world(integrator, tolerance), world(integrator, tolerance));
        for _ in 0..3000 {
            kept.step().unwrap();
            forgot.clear_scratch();
            forgot.step().unwrap();
        }
        assert_eq!(kept.state().hash(), forgot.state().hash());
    }
}

#[test]
fn a_state_that_does_not_fit_is_refused_and_changes_nothing() {
    let mut world = world(Integrator::Splitting, None);
    while world.state().springs[0].len() < 2 {
        world.step().unwrap();
    }
    let before = world.state().hash();
    let good = world.state().clone();
    let mut refuse = |spoil: &dyn Fn(&mut State), part: &str| {
        let mut state = good.clone();
        spoil(&mut state);
        let error: StateError = world.restore(state).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
        assert_eq!(world.state().hash(), before);
    };
    refuse(&|s| s.bodies.truncate(1), "1 body, but friction springs of 2");
    refuse(&|s| *s = State::default(), "of 0 bodies, the scene has 2");
    refuse(&|s| s.time += 1.0, "its steps take");
    refuse(&|s| s.time = f64::NAN, "time");
    refuse(&|s| s.bodies[1].velocity.y = f64::NAN, "`velocity` of body \"other\"");
    refuse(&|s| s.bodies[0].orientation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), "`orientation`");
    refuse(&|s| s.springs[0][0].wall = 1, "at wall 1");
    refuse(&|s| s.springs[0][0].particle = u32::MAX, "particle 4294967295");
    refuse(&|s| s.springs[0].swap(0, 1), "friction spring");
    refuse(&|s| s.springs[0][1] = s.springs[0][0], "friction spring");
    refuse(&|s| s.springs[0][0].anchor.x = f64::INFINITY, "`anchor`");
    refuse(&|s| s.totals.slip = f64::NAN, "`slip` of the state");
    world.restore(good).unwrap();
}

#[test]
fn springs_of_a_body_that_has_left_do_not_come_back() {
    // a particle that bounces with friction under `euler`, in the air from one step to the next
    let material =
        Material { collision_stiffness: 1e4, friction_stiffness: 0.5, ..Material::default() };
    let body = Body::new(Shape::from_particles(&[DVec3::ZERO]).unwrap())
        .position(DVec3::Y * 0.3)
        .velocity(DVec3::new(2.0, -1.0, 0.0));
    let mut kept = World::builder()
        .integrator(Integrator::Euler)
        .material(material)
        .wall(WallPlane { normal: DVec3::Y, offset: 0.0 })
        .body(body)
        .build()
        .unwrap();
    let mut forgotten = kept.clone();
    for _ in 0..2000 {
        kept.step().unwrap();
        forgotten.clear_scratch();
        forgotten.step().unwrap();
        assert_eq!(kept.state(), forgotten.state());
        let in_the_air = kept.body(0).position().y > 0.1;
        assert!(!in_the_air || kept.state().springs[0].is_empty());
    }
}

#[test]
fn springs_between_bodies_that_cannot_be_are_refused() {
    let clump = Shape::from_particles(&[DVec3::X * 0.05, DVec3::X * -0.05]).unwrap();
    let surface = Surface::Spheres { radius: 0.05 };
    let clump = Body::new(clump).mass(1.0).surface(surface);
    let material = Material { friction_stiffness: 0.5, ..Material::default() };
    let mut world = World::builder()
        .dt(1e-4)
        .material(material)
        .wall(WallPlane::new(DVec3::Y, 0.0).unwrap())
        .body(clump.clone().position(DVec3::Y * 0.05))
        .body(clump.position(DVec3::new(0.01, 0.15, 0.0)))
        .build()
        .unwrap();
    advance(&mut world, 1000);
    let state = world.state().clone();
    assert!(state.pair_springs.len() >= 4, "{:?}", state.pair_springs);
    assert_eq!(state.check_fits(world.model()), Ok(()));
    let spoil = |change: &dyn Fn(&mut State)| {
        let mut spoiled = state.clone();
        change(&mut spoiled);
        spoiled.check_fits(world.model())
    };
    let last = state.pair_springs.len() - 1;
    let forged: [&dyn Fn(&mut State); 7] = [
        &|s| s.pair_springs[0].second = 9,
        &|s| s.pair_springs[0].first = 9,
        &|s| s.pair_springs[last].particle = 2,
        &|s| s.pair_springs[last].other = 2,
        &|s| s.pair_springs[last].kind = ContactKind::PointMesh,
        &|s| s.pair_springs[last].stretch.x = f64::NAN,
        &|s| s.pair_springs.swap(0, last),
    ];
    for (number, change) in forged.into_iter().enumerate() {
        let found = spoil(change);
        assert!(matches!(found, Err(StateError::PairSpring { .. })), "{number}: {found:?}");
    }
    let work: &dyn Fn(&mut State) = &|s| s.totals.work = f64::NAN;
    assert!(spoil(work).is_err());
}
