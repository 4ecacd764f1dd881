//! Simulates boxes at rest on each other and on a plane with Rapier.
//!
//! `resting-rapier cuboid|hull|trimesh MASS FRICTION GRAVITY DT STEPS FRAMES < BODIES`: each line of BODIES is one box: edges, moments
//! of inertia, position, and orientation (w x y z). STEPS is the number of steps between two frames.
//!
//! Prints a line for each body and frame, from the initial state on: position, orientation (w x y z), velocity and
//! angular velocity. The last line is the time spent in the steps (s).

use rapier3d::parry::shape::Cuboid;
use rapier3d::prelude::*;
use std::time::{Duration, Instant};

fn number(word: &str) -> f32 {
    word.parse().expect("a number")
}

fn print_state(body: &RigidBody) {
    let (x, q) = (body.translation(), body.rotation());
    let (v, w) = (body.linvel(), body.angvel());
    print!("{:?} {:?} {:?} {:?} {:?} {:?} {:?} ", x.x, x.y, x.z, q.w, q.x, q.y, q.z);
    println!("{:?} {:?} {:?} {:?} {:?} {:?}", v.x, v.y, v.z, w.x, w.y, w.z);
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let shape = arguments[0].as_str();
    let [mass, friction, gravity, dt] = [1, 2, 3, 4].map(|n: usize| number(&arguments[n]));
    let [steps, frames] = [5, 6].map(|n: usize| number(&arguments[n]) as u32);

    let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
    colliders.insert(ColliderBuilder::new(SharedShape::halfspace(Vector::Y)).friction(friction));
    let mut handles = Vec::new();
    for line in std::io::stdin().lines().map(|line| line.expect("text")) {
        let row: Vec<f32> = line.split(' ').map(number).collect();
        let vector = |at: usize| Vector::new(row[at], row[at + 1], row[at + 2]);
        let (points, triangles) = Cuboid::new(0.5 * vector(0)).to_trimesh();
        let collider = match shape {
            "hull" => ColliderBuilder::convex_hull(&points).expect("a hull"),
            "cuboid" => ColliderBuilder::new(SharedShape::new(Cuboid::new(0.5 * vector(0)))),
            "trimesh" => ColliderBuilder::trimesh(points, triangles).expect("a mesh"),
            other => panic!("unknown shape {other}: use cuboid, hull or trimesh"),
        };
        let rotation = Rotation::from_xyzw(row[10], row[11], row[12], row[9]);
        // the mass properties are given; the shape has no density
        let body = RigidBodyBuilder::dynamic()
            .pose(Pose::from_parts(vector(6), rotation))
            .additional_mass_properties(MassProperties::new(Vector::ZERO, mass, vector(3)))
            .can_sleep(false);
        let handle = bodies.insert(body);
        let collider = collider.friction(friction).density(0.0);
        colliders.insert_with_parent(collider, handle, &mut bodies);
        handles.push(handle);
    }

    let parameters = IntegrationParameters { dt, ..Default::default() };
    let mut pipeline = PhysicsPipeline::new();
    let (mut islands, mut broad, mut narrow) =
        (IslandManager::new(), DefaultBroadPhase::new(), NarrowPhase::new());
    let (mut joints, mut multibodies, mut ccd) =
        (ImpulseJointSet::new(), MultibodyJointSet::new(), CCDSolver::new());
    let mut soft = SoftBodySet::new();
    let mut time = Duration::ZERO;
    for frame in 0..frames {
        if frame > 0 {
            let clock = Instant::now();
            for _ in 0..steps {
                pipeline.step(
                    Vector::new(0.0, -gravity, 0.0),
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
        }
        for handle in &handles {
            print_state(&bodies[*handle]);
        }
    }
    println!("{:?}", time.as_secs_f64());
}
