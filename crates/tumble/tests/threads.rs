//! The bits of a heap depend on its state alone: not on the number of threads, not on what was remembered between steps.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use tumble::{
    Body, DQuat, DVec3, Damping, Energy, Integrator, MassModel, Material, MaterialOverride, Motion,
    Oscillation, PenetrationDepths, Prescribed, Primitive, Sampling, Shape, Surface, WallBox,
    WallPlane, World, WorldBuilder,
};

/// A linear congruential generator.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        self.0 >> 33
    }

    /// Between -1 and 1.
    fn uniform(&mut self) -> f64 {
        (self.next() % 2001) as f64 / 1000.0 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.uniform(), self.uniform(), self.uniform())
    }
}

fn clump() -> Shape {
    let points = [DVec3::ZERO, DVec3::X, DVec3::new(0.4, 0.9, 0.0), DVec3::new(0.5, 0.3, 0.8)];
    Shape::from_particles(&points.map(|point| point * 0.06)).unwrap()
}

fn solid(primitive: Primitive) -> Arc<Shape> {
    let mesh = primitive.mesh().unwrap();
    Arc::new(Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap())
}

fn rough(random: &mut Random, body: Body, place: DVec3) -> Body {
    let turned = DQuat::from_xyzw(random.uniform(), random.uniform(), random.uniform(), 1.5);
    let (velocity, spin) = (random.vector() - DVec3::Y, random.vector() * 5.0);
    body.position(place + random.vector() * 0.01)
        .orientation(turned)
        .velocity(velocity)
        .angular_velocity(spin)
}

/// 200 clumps, with boxes and knots above, on an oscillating slab with a surface velocity.
fn heap(integrator: Integrator) -> WorldBuilder {
    let mut random = Random(7);
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
        .box_walls(&arena)
        .body(base.motion(Motion::Prescribed(shaken)).name("slab"));
    for layer in 0..8 {
        for cell in 0..25 {
            let [x, z] = [cell % 5, cell / 5].map(|i| f64::from(i - 2) * 0.2);
            let place = DVec3::new(x, 0.15 + f64::from(layer) * 0.2, z);
            let spheres = Surface::Spheres { radius: 0.04 };
            let body = Body::new(Arc::clone(&clump)).particle_mass(0.2).surface(spheres);
            world = world.body(rough(&mut random, body, place));
        }
    }
    for number in 0..8 {
        let [x, z] = [number % 2, number / 2 % 2].map(|i| f64::from(i) * 0.5 - 0.25);
        let place = DVec3::new(x, 1.95 + 0.3 * f64::from(number / 4), z);
        let shape = if number % 2 == 0 { &knot } else { &cube };
        let body = Body::new(Arc::clone(shape)).mass(0.8).surface(Surface::Mesh);
        world = world.body(rough(&mut random, body, place).velocity(DVec3::Y * -4.0));
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
fn the_number_of_threads_does_not_change_any_bit() {
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
fn dropping_cached_data_at_random_does_not_change_any_bit() {
    let mut cached = heap(Integrator::Splitting).build().unwrap();
    let mut uncached = cached.clone();
    let mut random = Random(99);
    for step in 0..2500 {
        cached.step().unwrap();
        if random.next().is_multiple_of(7) {
            uncached.clear_scratch();
        }
        uncached.step().unwrap();
        if step % 100 == 99 {
            assert_eq!(cached.state().hash(), uncached.state().hash(), "after step {step}");
        }
    }
}

#[test]
fn a_restored_heap_continues_bit_for_bit() {
    for integrator in [Integrator::Splitting, Integrator::Euler] {
        let mut whole = heap(integrator).build().unwrap();
        advance(&mut whole, 1500);
        for _ in 0..3 {
            assert!(!whole.state().pair_springs.is_empty());
            let mut again = heap(integrator).build().unwrap();
            again.restore(whole.state().clone()).unwrap();
            // reading the energy does not change the state
            assert_eq!(whole.energy(), again.energy());
            advance(&mut whole, 150);
            advance(&mut again, 150);
            assert_eq!(whole.state().hash(), again.state().hash(), "{integrator:?}");
            assert_eq!(whole.state(), again.state());
        }
    }
}

/// Clumps with friction on a floor without friction, so that lanes are reused by contacts without springs.
fn on_ice(integrator: Integrator) -> World {
    let mut random = Random(5);
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
    world = world.wall_with_material(floor, ice);
    for number in 0..100 {
        let cell =
            DVec3::new(f64::from(number % 5), f64::from(number / 25), f64::from(number / 5 % 5));
        let body = Body::new(Arc::clone(&clump)).particle_mass(0.2).surface(spheres);
        world = world.body(rough(&mut random, body, cell * 0.2 + DVec3::Y * 0.15));
    }
    world.build().unwrap()
}

#[test]
fn energy_and_depths_depend_on_the_state_only() {
    use Integrator::{Euler, Splitting};
    for (integrator, threads) in [(Splitting, 1), (Splitting, 2), (Euler, 2)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut world = on_ice(integrator);
            for _ in 0..30 {
                advance(&mut world, 40);
                assert_eq!(world.energy(), Energy::new(world.model(), world.state()));
                assert_eq!(
                    world.penetration_depths(),
                    PenetrationDepths::new(world.model(), world.state())
                );
            }
            let (springs, depths) = (&world.state().pair_springs, world.penetration_depths());
            assert!(!springs.is_empty() && depths.walls > 0.0, "{} {depths:?}", springs.len());
        });
    }
}
