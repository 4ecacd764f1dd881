//! Exact flight: any step, any inertia.
#![allow(clippy::unwrap_used)]

use tumble::{Body, DMat3, DQuat, DVec3, Mesh, Shape, World};

/// A body of 1 kg with these principal moments (kg·m²) about x, y, z.
fn body(moments: DVec3) -> Body {
    let points = [DVec3::X, -DVec3::X];
    let gyration = DMat3::from_diagonal(moments);
    let shape = Shape::of_distribution(&points, Mesh::default(), DVec3::ZERO, gyration).unwrap();
    Body::new(shape).mass(1.0)
}

fn world(moments: DVec3, omega: DVec3, dt: f64) -> World {
    let body = body(moments).angular_velocity(omega);
    World::builder().gravity(DVec3::ZERO).dt(dt).body(body).build().unwrap()
}

fn run(world: &mut World, time: f64) {
    for _ in 0..(time / world.dt()).round() as u64 {
        world.step().unwrap();
    }
}

/// Angle between two orientations (rad).
fn angle(a: DQuat, b: DQuat) -> f64 {
    let apart = if a.dot(b) < 0.0 { a + b } else { a - b };
    2.0 * apart.length()
}

/// Moments (1, 2, 3), ω₀ = (0.01, 5, 0.01) rad/s, after 20 s: Taylor series of order 40 in numbers of
/// 40 digits, in steps of 0.05 s.
const TUMBLED: [f64; 4] = [
    -0.709562695226128508718648441383,
    -0.000671189134824091121868436563671,
    -0.704637374307752197465902093928,
    -0.00254985828121570024836252148386,
];

#[test]
fn tumbling_is_exact_at_any_step() {
    let [w, x, y, z] = TUMBLED;
    for dt in [1e-3, 0.02, 0.1, 4.0, 20.0] {
        let mut world = world(DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.01, 5.0, 0.01), dt);
        let start = (world.energy().total(), world.body(0).angular_momentum());
        run(&mut world, 20.0);
        let off = angle(world.body(0).orientation(), DQuat::from_xyzw(x, y, z, w));
        println!("dt {dt}: {off:e} rad");
        assert!(off < 1e-11, "dt {dt}: {off:e} rad");
        assert!((world.energy().total() / start.0 - 1.0).abs() < 1e-14);
        assert_eq!(world.body(0).angular_momentum(), start.1);
    }
}
