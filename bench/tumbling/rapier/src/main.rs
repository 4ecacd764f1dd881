//! Simulates free tumbling with Rapier: `tumbling-rapier f32|f64 DT` prints the orientation (w x y z) and the angular
//! velocity in the world frame after 20 s.

/// The simulation for either precision: the two crates have the same interface.
macro_rules! simulate {
    ($rapier:ident, $real:ty, $dt:expr) => {{
        use $rapier::prelude::*;
        let body = RigidBodyBuilder::dynamic()
            .additional_mass_properties(MassProperties::new(
                Vector::ZERO,
                1.0,
                Vector::new(1.0, 2.0, 3.0),
            ))
            .angvel(Vector::new(0.01, 5.0, 0.01))
            // the default, set explicitly because the motion depends on it
            .gyroscopic_forces_enabled(true)
            .linear_damping(0.0)
            .angular_damping(0.0)
            .can_sleep(false);
        let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
        let handle = bodies.insert(body);
        let parameters = IntegrationParameters { dt: $dt as $real, ..Default::default() };
        let mut pipeline = PhysicsPipeline::new();
        let (mut islands, mut broad, mut narrow) =
            (IslandManager::new(), DefaultBroadPhase::new(), NarrowPhase::new());
        let (mut joints, mut multibodies, mut ccd) =
            (ImpulseJointSet::new(), MultibodyJointSet::new(), CCDSolver::new());
        let mut soft = SoftBodySet::new();
        for _ in 0..(20.0 / $dt).round() as u64 {
            pipeline.step(
                Vector::ZERO,
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
        let (q, omega) = (bodies[handle].rotation(), bodies[handle].angvel());
        println!(
            "{:?} {:?} {:?} {:?} {:?} {:?} {:?}",
            q.w, q.x, q.y, q.z, omega.x, omega.y, omega.z
        );
    }};
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let dt: f64 = arguments[1].parse().expect("DT is a number of seconds");
    match arguments[0].as_str() {
        "f32" => simulate!(single, f32, dt),
        "f64" => simulate!(double, f64, dt),
        other => panic!("unknown precision {other}: use f32 or f64"),
    }
}
