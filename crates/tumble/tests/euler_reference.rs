//! The integrator "euler" against the reference implementation of the basic system.

#![allow(clippy::unwrap_used)]

mod reference;

use proptest::prelude::*;
use reference::Reference;
use tumble::{
    Body, BodyState, DQuat, DVec3, Integrator, Material, Shape, WallBox, WallPlane, World,
};

fn vector(range: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-range..range).prop_map(DVec3::from_array)
}

fn wall() -> impl Strategy<Value = WallPlane> {
    (vector(1.0), -1.0..0.6f64).prop_filter_map("a normal", |(n, d)| WallPlane::new(n, d))
}

/// The same body and surroundings for the library and the reference implementation.
fn pair(
    points: &[DVec3],
    mass: f64,
    c: f64,
    k: f64,
    walls: &[WallPlane],
    start: (DVec3, DVec3, DVec3, DQuat),
) -> Option<(World, Reference)> {
    let shape = Shape::from_particles(points).ok()?;
    let reference = Reference {
        r: shape.particles().iter().collect(),
        m: mass,
        g: DVec3::new(0.3, -9.8, 0.1),
        c,
        k,
        walls: walls.to_vec(),
    };
    let (position, velocity, omega, orientation) = start;
    let body = Body::new(shape)
        .particle_mass(mass)
        .position(position)
        .velocity(velocity)
        .angular_velocity(omega)
        .orientation(orientation);
    let builder = World::builder()
        .integrator(Integrator::Euler)
        .gravity(reference.g)
        .velocity_damping_stiffness(c)
        .material(Material { collision_stiffness: k, ..Material::default() });
    let world = walls.iter().fold(builder, |b, w| b.wall(*w)).body(body).build().ok()?;
    Some((world, reference))
}

/// The largest difference, relative to `scale`.
fn difference(a: &BodyState, b: &BodyState, scale: &[f64; 3]) -> f64 {
    let q = (a.orientation - b.orientation).length();
    ((a.position - b.position).length() / scale[0])
        .max((a.velocity - b.velocity).length() / scale[1])
        .max((a.angular_momentum - b.angular_momentum).length() / scale[2])
        .max(q)
}

/// Magnitudes of position, velocity and angular momentum after a step, including the effect of all forces.
fn scales(y: &Reference, s: &BodyState, h: f64) -> [f64; 3] {
    let n = y.r.len() as f64;
    let radius = y.r.iter().fold(0.0f64, |m, r| m.max(r.length()));
    let deepest = y.walls.iter().fold(0.0f64, |m, w| m.max(w.depth(s.position) + radius));
    let kick = h * (y.g.length() + y.k * deepest / y.m * y.walls.len() as f64);
    let speed = s.velocity.length() + kick;
    [
        s.position.length() + radius + speed * h,
        speed,
        n * y.m * radius * speed + s.angular_momentum.length(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]
    #[test]
    fn one_step_agrees_with_the_reference_implementation(
        points in prop::collection::vec(vector(0.5), 4..60),
        mass in 0.01..10.0f64,
        c in prop_oneof![Just(0.0), 0.0..5.0f64],
        k in 1.0..1e5f64,
        walls in prop::collection::vec(wall(), 0..6),
        start in (vector(1.0), vector(5.0), vector(100.0), prop::array::uniform4(-1.0..1.0f64)),
    ) {
        let q = DQuat::from_array(start.3);
        prop_assume!(q.length() > 0.1);
        let Some((mut world, reference)) =
            pair(&points, mass, c, k, &walls, (start.0, start.1, start.2, q.normalize()))
        else { return Ok(()) };
        let moments = world.body(0).model().shape.principal().moments;
        prop_assume!(moments.x > 1e-3 * moments.z);
        let mut expected = world.state().bodies[0];
        let scale = scales(&reference, &expected, 1e-3);
        world.step().unwrap();
        reference.step(&mut expected, 1e-3);
        let found = difference(&world.state().bodies[0], &expected, &scale);
        prop_assert!(found < 1e-12, "off by {found:e}");
    }
}

/// 4,000 points on a perturbed ellipsoid.
fn perturbed_ellipsoid() -> Vec<DVec3> {
    (0..4000)
        .map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 4000.0;
            let (s, c) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
            let ring = (1.0 - z * z).sqrt();
            DVec3::new(0.3 * ring * c, 0.2 * ring * s, 0.15 * z)
                * (1.0 + 0.15 * (3.0 * s).sin() * ring)
        })
        .collect()
}

fn three_seconds(c: f64) -> f64 {
    let start =
        (DVec3::ZERO, DVec3::new(4.0, 2.0, 3.0), DVec3::new(0.0, 100.0, 0.0), DQuat::IDENTITY);
    let walls = WallBox::arena().planes();
    let (mut world, reference) = pair(&perturbed_ellipsoid(), 1.0, c, 1e4, &walls, start).unwrap();
    let mut expected = world.state().bodies[0];
    let mut worst = 0.0f64;
    for _ in 0..3000 {
        world.step().unwrap();
        reference.step(&mut expected, 1e-3);
        let scale = [1.0, 1.0, expected.angular_momentum.length().max(1.0)];
        worst = worst.max(difference(&world.state().bodies[0], &expected, &scale));
    }
    worst
}

#[test]
fn three_seconds_without_drag_agree_within_1e_9() {
    let worst = three_seconds(0.0);
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn three_seconds_with_drag_agree_within_1e_9() {
    let worst = three_seconds(1.0);
    assert!(worst < 1e-9, "{worst:e}");
}
