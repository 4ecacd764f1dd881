//! The bits of a heap depend on its state alone: not on the number of threads, not on what was remembered between steps.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use tumble::{
    Body, ContactDepths, DQuat, DVec3, Damping, Energy, Integrator, MassModel, Material,
    MaterialOverride, Motion, Oscillation, Prescribed, Primitive, Sampling, Shape, Surface,
    WallBox, WallPlane, World, WorldBuilder,
};

/// Small numbers that look random, the same every time.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0 >> 33
    }

    /// Between -1 and 1.
    fn throw(&mut self) -> f64 {
        (self.roll() % 2001) as f64 / 1000.0 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.throw(), self.throw(), self.throw())
    }
}

fn clump() -> Shape {
    let points = [DVec3::ZERO, DVec3::X, DVec3::new(0.4, 0.9, 0.0), DVec3::new(0.5, 0.3, 0.8)];
    Shape::of_particles(&points.map(|point| point * 0.06)).unwrap()
}

fn solid(primitive: Primitive) -> Arc<Shape> {
    let mesh = primitive.mesh().unwrap();
    Arc::new(Shape::of_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap())
}

fn rough(dice: &mut Dice, body: Body, place: DVec3) -> Body {
    let turned = DQuat::from_xyzw(dice.throw(), dice.throw(), dice.throw(), 1.5);
    let (velocity, spin) = (dice.vector() - DVec3::Y, dice.vector() * 5.0);
    body.position(place + dice.vector() * 0.01)
        .orientation(turned)
        .velocity(velocity)
        .angular_velocity(spin)
}

/// 200 clumps, and on top of every second layer of them boxes and knots; a shaken slab beneath, which is also a belt.
fn heap(integrator: Integrator) -> WorldBuilder {
    let mut dice = Dice(7);
    let clump = Arc::new(clump());
    let knot = solid(Primitive::Knot { radius: 0.06, tube_radius: 0.022, segments: 6 });
    let cube = solid(Primitive::Box { size: DVec3::new(0.2, 0.12, 0.15), divisions: 2 });
    let slab = solid(Primitive::Box { size: DVec3::new(1.0, 0.2, 1.0), divisions: 1 });
    let material = Material {
        collision_stiffness: 2e4,
        damping: Damping::Restitution(0.4),
        friction_stiffness: 0.5,
        ..Material::default()
    };
    let arena = WallBox {
        min: DVec3::new(-0.55, -0.3, -0.55),
        max: DVec3::new(0.55, 9.0, 0.55),
        orientation: DQuat::IDENTITY,
        open: [false; 6],
    };
    let swing = Oscillation { amplitude: DVec3::Y * 0.01, frequency: 8.0, phase: 0.3 };
    let shaken = Prescribed { oscillation: Some(swing), surface_velocity: DVec3::X * 0.4 };
    let base = Body::new(slab).position(DVec3::Y * -0.1).surface(Surface::Mesh);
    let mut world = World::builder()
        .dt(2e-4)
        .integrator(integrator)
        .velocity_damping_stiffness(0.001)
        .material(material)
        .walls_of_box(&arena)
        .body(base.motion(Motion::Prescribed(shaken)).name("slab"));
    for layer in 0..8 {
        for cell in 0..25 {
            let [x, z] = [cell % 5, cell / 5].map(|i| f64::from(i - 2) * 0.2);
            let place = DVec3::new(x, 0.15 + f64::from(layer) * 0.2, z);
            let spheres = Surface::Spheres { radius: 0.04 };
            let body = Body::new(Arc::clone(&clump)).particle_mass(0.2).surface(spheres);
            world = world.body(rough(&mut dice, body, place));
        }
    }
    for number in 0..8 {
        let [x, z] = [number % 2, number / 2 % 2].map(|i| f64::from(i) * 0.5 - 0.25);
        let place = DVec3::new(x, 1.95 + 0.3 * f64::from(number / 4), z);
        let shape = if number % 2 == 0 { &knot } else { &cube };
        let body = Body::new(Arc::clone(shape)).mass(0.8).surface(Surface::Mesh);
        world = world.body(rough(&mut dice, body, place).velocity(DVec3::Y * -4.0));
    }
    world
}

fn advance(world: &mut World, steps: u32) {
    for _ in 0..steps {
        world.step().unwrap();
    }
}

fn hash_after(steps: u32, threads: usize, integrator: Integrator) -> (String, usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut world = heap(integrator).build().unwrap();
        advance(&mut world, steps);
        let totals = world.state().totals;
        assert!(totals.max_depth > 1e-3 && totals.slip > 0.0 && totals.work != 0.0, "{totals:?}");
        (world.state().hash(), world.state().pair_springs.len())
    })
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    for (integrator, steps) in [(Integrator::Splitting, 2500), (Integrator::Euler, 600)] {
        let (alone, springs) = hash_after(steps, 1, integrator);
        assert!(springs > 50, "hardly a heap: {springs} springs");
        for threads in [2, 3, 8] {
            let (hash, _) = hash_after(steps, threads, integrator);
            assert_eq!(hash, alone, "{integrator:?} with {threads} threads");
        }
    }
}

#[test]
fn what_is_forgotten_at_random_changes_no_bit() {
    let mut kept = heap(Integrator::Splitting).build().unwrap();
    let mut forgetful = kept.clone();
    let mut dice = Dice(99);
    for step in 0..2500 {
        kept.step().unwrap();
        if dice.roll().is_multiple_of(7) {
            forgetful.forget_scratch();
        }
        forgetful.step().unwrap();
        if step % 100 == 99 {
            assert_eq!(kept.state().hash(), forgetful.state().hash(), "after step {step}");
        }
    }
}

#[test]
fn a_heap_that_is_put_back_goes_on_to_the_same_bits() {
    for integrator in [Integrator::Splitting, Integrator::Euler] {
        let mut whole = heap(integrator).build().unwrap();
        advance(&mut whole, 1500);
        for _ in 0..3 {
            assert!(!whole.state().pair_springs.is_empty());
            let mut again = heap(integrator).build().unwrap();
            again.restore(whole.state().clone()).unwrap();
            // looking at it changes nothing
            assert_eq!(whole.energy(), again.energy());
            advance(&mut whole, 150);
            advance(&mut again, 150);
            assert_eq!(whole.state().hash(), again.state().hash(), "{integrator:?}");
            assert_eq!(whole.state(), again.state());
        }
    }
}

/// Clumps with friction on a floor without: its contacts lie in lanes where others have been.
fn on_ice(integrator: Integrator) -> World {
    let mut dice = Dice(5);
    let (clump, spheres) = (Arc::new(clump()), Surface::Spheres { radius: 0.04 });
    let material = Material {
        collision_stiffness: 2e4,
        damping: Damping::Restitution(0.4),
        friction_stiffness: 0.5,
        ..Material::default()
    };
    let ice = MaterialOverride { friction_stiffness: Some(0.0), ..MaterialOverride::default() };
    let floor = WallPlane::new(DVec3::Y, 0.0).unwrap();
    let mut world = World::builder().dt(2e-4).integrator(integrator).material(material);
    world = world.wall_of(floor, ice);
    for number in 0..100 {
        let cell =
            DVec3::new(f64::from(number % 5), f64::from(number / 25), f64::from(number / 5 % 5));
        let body = Body::new(Arc::clone(&clump)).particle_mass(0.2).surface(spheres);
        world = world.body(rough(&mut dice, body, cell * 0.2 + DVec3::Y * 0.15));
    }
    world.build().unwrap()
}

#[test]
fn what_is_asked_of_a_state_does_not_depend_on_what_came_before() {
    use Integrator::{Euler, Splitting};
    for (integrator, threads) in [(Splitting, 1), (Splitting, 2), (Euler, 2)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut world = on_ice(integrator);
            for _ in 0..30 {
                advance(&mut world, 40);
                assert_eq!(world.energy(), Energy::of(world.model(), world.state()));
                assert_eq!(world.contact_depths(), ContactDepths::of(world.model(), world.state()));
            }
            let (springs, depths) = (&world.state().pair_springs, world.contact_depths());
            assert!(!springs.is_empty() && depths.walls > 0.0, "{} {depths:?}", springs.len());
        });
    }
}
