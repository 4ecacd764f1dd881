//! Simulates a body that bounces in a closed box with Rapier.
//!
//! `bouncing-rapier time|states f32|f64 trimesh|hull|parts FOLDER START… END…`: FOLDER holds the output of `body.py`;
//! START is position, velocity and angular velocity; ENDs are the ends of the phases (s).
//!
//! `time` prints the seconds spent in the steps of each phase. `states` prints position, orientation (w x y z),
//! velocity, angular velocity and the number of contact points in the solver after every step.

use std::collections::HashMap;
use std::time::Instant;

/// The output of `body.py`.
struct Input {
    points: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    setup: HashMap<String, Vec<f64>>,
}

impl Input {
    fn read(folder: &str) -> Self {
        let read = |name: &str| {
            std::fs::read_to_string(format!("{folder}/{name}"))
                .expect("FOLDER holds the output of body.py")
        };
        let (obj, setup) = (read("body.obj"), read("setup.txt"));
        let rows = |key: &'static str| {
            obj.lines().filter_map(move |line| line.strip_prefix(key)).map(str::split_whitespace)
        };
        Self {
            points: rows("v ").map(|row| triple(row.map(number))).collect(),
            triangles: rows("f ")
                .map(|row| triple(row.map(number)).map(|n| n as u32 - 1))
                .collect(),
            setup: setup
                .lines()
                .map(|line| line.split_once(' ').expect("a key and its values"))
                .map(|(key, values)| (key.to_owned(), values.split(' ').map(number).collect()))
                .collect(),
        }
    }

    fn get(&self, key: &str) -> f64 {
        self.setup[key][0]
    }
}

fn number(word: &str) -> f64 {
    word.parse().expect("a number")
}

fn triple(row: impl Iterator<Item = f64>) -> [f64; 3] {
    row.collect::<Vec<_>>().try_into().expect("three numbers")
}

/// The simulation for either precision: the two crates have the same interface.
macro_rules! simulate {
    ($rapier:ident, $real:ty, $print_states:expr, $shape:expr, $input:expr, $start:expr, $ends:expr) => {{
        use $rapier::prelude::*;
        let input: &Input = $input;
        let get = |key: &str| input.get(key) as $real;
        let vector = |v: &[f64]| Vector::new(v[0] as $real, v[1] as $real, v[2] as $real);
        let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());

        // six thick walls around a cube
        let (box_, thickness) = (get("box"), 0.5);
        let material = |collider: ColliderBuilder| {
            collider.restitution(get("restitution")).friction(get("friction"))
        };
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let (mut half, mut centre) = ([box_ + 2.0 * thickness; 3], [0.0; 3]);
                (half[axis], centre[axis]) = (thickness, side * (box_ + thickness));
                let wall = ColliderBuilder::cuboid(half[0], half[1], half[2])
                    .translation(Vector::new(centre[0], centre[1], centre[2]));
                colliders.insert(material(wall));
            }
        }

        // the mass properties are given; the shape has no density
        let points: Vec<_> = input.points.iter().map(|p| vector(p)).collect();
        let shape = match $shape {
            "trimesh" => ColliderBuilder::trimesh(points, input.triangles.clone()).expect("a mesh"),
            "hull" => ColliderBuilder::convex_hull(&points).expect("a hull"),
            "parts" => ColliderBuilder::convex_decomposition(&points, &input.triangles),
            other => panic!("unknown shape {other}: use trimesh, hull or parts"),
        };
        let start: &[f64] = $start;
        let body = RigidBodyBuilder::dynamic()
            .translation(vector(&start[..3]))
            .linvel(vector(&start[3..6]))
            .angvel(vector(&start[6..]))
            .additional_mass_properties(MassProperties::new(
                Vector::ZERO,
                get("mass"),
                vector(&input.setup["moments"]),
            ))
            .linear_damping(0.0)
            .angular_damping(0.0)
            .can_sleep(false);
        let handle = bodies.insert(body);
        colliders.insert_with_parent(material(shape).density(0.0), handle, &mut bodies);

        let parameters = IntegrationParameters { dt: get("dt"), ..Default::default() };
        let gravity = Vector::new(0.0, 0.0, -get("gravity"));
        let mut pipeline = PhysicsPipeline::new();
        let (mut islands, mut broad, mut narrow) =
            (IslandManager::new(), DefaultBroadPhase::new(), NarrowPhase::new());
        let (mut joints, mut multibodies, mut ccd) =
            (ImpulseJointSet::new(), MultibodyJointSet::new(), CCDSolver::new());
        let mut soft = SoftBodySet::new();
        let mut step = 0;
        for end in $ends {
            let clock = Instant::now();
            while step < (end / input.get("dt")).round() as u64 {
                pipeline.step(
                    gravity,
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
                step += 1;
                if $print_states {
                    let contacts: usize = narrow
                        .contact_pairs()
                        .flat_map(|pair| pair.solver_manifolds())
                        .map(|manifold| manifold.data.num_active_contacts())
                        .sum();
                    let body = &bodies[handle];
                    let (x, q) = (body.translation(), body.rotation());
                    let (v, w) = (body.linvel(), body.angvel());
                    print!(
                        "{:?} {:?} {:?} {:?} {:?} {:?} {:?} ",
                        x.x, x.y, x.z, q.w, q.x, q.y, q.z
                    );
                    print!("{:?} {:?} {:?} {:?} {:?} {:?} ", v.x, v.y, v.z, w.x, w.y, w.z);
                    println!("{contacts}");
                }
            }
            if !$print_states {
                println!("{:?}", clock.elapsed().as_secs_f64());
            }
        }
    }};
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let print_states = arguments[0] == "states";
    let shape = arguments[2].as_str();
    let input = Input::read(&arguments[3]);
    let numbers: Vec<f64> = arguments[4..].iter().map(|word| number(word)).collect();
    let (start, ends) = numbers.split_at(9);
    match arguments[1].as_str() {
        "f32" => simulate!(single, f32, print_states, shape, &input, start, ends),
        "f64" => simulate!(double, f64, print_states, shape, &input, start, ends),
        other => panic!("unknown precision {other}: use f32 or f64"),
    }
}
