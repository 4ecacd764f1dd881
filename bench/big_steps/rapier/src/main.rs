//! Simulates a heap of clumps of spheres in a box with an open top with Rapier, in double precision on one thread.
//!
//! `big-steps-rapier RADIUS DENSITY FRICTION GRAVITY WIDTH STEPS FRAMES DT ITERATIONS UNIT FREQUENCY RECYCLING < CLUMPS`: each
//! line of CLUMPS is the position and orientation (w x y z) of a clump of eight spheres on the corners of a cube. WIDTH is that
//! of the box, STEPS the number of steps between two frames, ITERATIONS that of the solver in a step, UNIT the
//! length of an object (m), FREQUENCY that of contacts (Hz), and RECYCLING, 0 or 1, whether contacts of bodies that hardly move are kept.
//!
//! Prints for each frame, from the initial state on, a line for each clump: position, orientation (w x y z), velocity and angular
//! velocity; then a line with the wall-clock time that the steps have taken so far (s).

use rapier3d_f64::prelude::*;
use std::time::{Duration, Instant};

fn number(word: &str) -> f64 {
    word.parse().expect("a number")
}

fn print_state(body: &RigidBody) {
    let (x, q) = (body.translation(), body.rotation());
    let (v, w) = (body.linvel(), body.angvel());
    print!("{:?} {:?} {:?} {:?} {:?} {:?} {:?} ", x.x, x.y, x.z, q.w, q.x, q.y, q.z);
    println!("{:?} {:?} {:?} {:?} {:?} {:?}", v.x, v.y, v.z, w.x, w.y, w.z);
}

/// The centres of the spheres of a clump.
fn corners(radius: f64) -> Vec<Vector> {
    let side = |bit: usize| if bit == 0 { -radius } else { radius };
    (0..8).map(|i| Vector::new(side(i & 1), side(i >> 1 & 1), side(i >> 2))).collect()
}

/// The floor and four walls, as half-spaces.
fn add_walls(colliders: &mut ColliderSet, width: f64, friction: f64) {
    let far = Vector::new(width, width, 0.0);
    let walls = [
        (Vector::Z, Vector::ZERO),
        (Vector::X, Vector::ZERO),
        (Vector::Y, Vector::ZERO),
        (-Vector::X, far),
        (-Vector::Y, far),
    ];
    for (normal, point) in walls {
        let wall = ColliderBuilder::new(SharedShape::halfspace(normal));
        colliders.insert(wall.translation(point).friction(friction));
    }
}

fn parameters(settings: &[f64]) -> IntegrationParameters {
    let [dt, iterations, unit, frequency, recycling] = settings.try_into().expect("five settings");
    let mut parameters = IntegrationParameters {
        dt,
        num_solver_iterations: iterations as usize,
        length_unit: unit,
        contact_recycling: recycling != 0.0,
        ..Default::default()
    };
    parameters.contact_softness.natural_frequency = frequency;
    // the ratio of the defaults
    parameters.static_contact_softness.natural_frequency = 2.0 * frequency;
    parameters
}

fn main() {
    let arguments: Vec<f64> = std::env::args().skip(1).map(|word| number(&word)).collect();
    let [radius, density, friction, gravity, width, steps, frames, settings @ ..] = &arguments[..]
    else {
        panic!("too few arguments")
    };
    let parameters = parameters(settings);

    let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
    add_walls(&mut colliders, *width, *friction);
    let mut handles = Vec::new();
    for line in std::io::stdin().lines().map(|line| line.expect("text")) {
        let row: Vec<f64> = line.split(' ').map(number).collect();
        let rotation = Rotation::from_xyzw(row[4], row[5], row[6], row[3]);
        let pose = Pose::from_parts(Vector::new(row[0], row[1], row[2]), rotation);
        let handle = bodies.insert(RigidBodyBuilder::dynamic().pose(pose).can_sleep(false));
        for corner in corners(*radius) {
            let ball = ColliderBuilder::ball(*radius).translation(corner);
            colliders.insert_with_parent(
                ball.density(*density).friction(*friction),
                handle,
                &mut bodies,
            );
        }
        handles.push(handle);
    }

    let mut pipeline = PhysicsPipeline::new();
    let (mut islands, mut broad, mut narrow) =
        (IslandManager::new(), DefaultBroadPhase::new(), NarrowPhase::new());
    let (mut joints, mut multibodies, mut ccd) =
        (ImpulseJointSet::new(), MultibodyJointSet::new(), CCDSolver::new());
    let mut soft = SoftBodySet::new();
    let mut time = Duration::ZERO;
    for frame in 0..*frames as u32 {
        let clock = Instant::now();
        for _ in 0..if frame == 0 { 0 } else { *steps as u32 } {
            pipeline.step(
                Vector::new(0.0, 0.0, -*gravity),
                &parameters,
                &mut islands,
                &mut broad,
                &mut narrow,
                &mut bodies,
                &mut colliders,
                &mut joints,
                &mut multibodies,
                &mut soft,
                &mut ccd,
                &(),
                &(),
            );
        }
        time += clock.elapsed();
        for handle in &handles {
            print_state(&bodies[*handle]);
        }
        println!("{:?}", time.as_secs_f64());
    }
}
