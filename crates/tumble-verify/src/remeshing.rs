//! Contact stiffness per area: how a body bounces does not depend on how finely it is sampled.

use std::f64::consts::PI;

use tumble::{Body, DQuat, DVec3, Damping, MassModel, Material, Mesh, Primitive, Sampling, Shape};

use crate::check::{Case, Check, Outcome};
use crate::contact::on_floor;
use crate::flight::run;

type Error = Box<dyn std::error::Error>;

pub(crate) const REMESHING: Case = Case {
    name: "remeshing",
    about: "bodies of 1 kg and the same stiffness per area at 2 m/s against a floor, meshed in several ways: depth, \
            time and rebound against those of the smooth body, spin against the finest mesh; and a plate at rest",
    run: remeshing,
    slow: false,
};

/// Stiffness per area (N/m³).
const KAPPA: f64 = 5e5;
const MASS: f64 = 1.0;
const SPEED: f64 = 2.0;
const RADIUS: f64 = 0.15;
const DT: f64 = 2e-5;

fn per_area() -> Material {
    Material { collision_stiffness_per_area: Some(KAPPA), ..Material::default() }
}

fn remeshing() -> Outcome {
    let mut checks = Vec::new();
    spheres(&mut checks)?;
    per_particle(&mut checks)?;
    boxes(&mut checks)?;
    oblique(&mut checks)?;
    checks.push(plate()?);
    Ok(checks)
}

/// What a bounce was like.
struct Bounce {
    /// How far the lowest point came behind the floor (m).
    depth: f64,
    /// From the first touch to the last (s).
    time: f64,
    /// Speed back (m/s).
    speed: f64,
    /// Angular velocity after it (rad/s).
    spin: DVec3,
    /// The largest residual of the ledger, as a part of the energy at the start.
    residual: f64,
}

/// Throws a body, `height` from its centre to its lowest point, at the floor with `velocity`; no gravity.
fn bounce(
    shape: Shape,
    turn: DQuat,
    height: f64,
    material: Material,
    velocity: DVec3,
) -> Result<Bounce, Error> {
    let body = Body::new(shape)
        .mass(MASS)
        .orientation(turn)
        .position(DVec3::Y * height)
        .velocity(velocity);
    let mut world = on_floor(material).gravity(DVec3::ZERO).dt(DT).body(body).build()?;
    let start = world.energy().total();
    let (mut lowest, mut touch, mut leave, mut residual) = (height, None, 0.0, 0.0f64);
    while world.time() < 0.2 {
        world.step()?;
        let energy = world.energy();
        residual = residual.max((energy.total() - start).abs() / start);
        lowest = lowest.min(world.body(0).position().y);
        if energy.elastic > 0.0 {
            touch.get_or_insert(world.time());
            leave = world.time();
        }
    }
    let (speed, spin) = (world.body(0).velocity().y, world.body(0).angular_velocity());
    let time = leave - touch.unwrap_or(f64::NAN);
    Ok(Bounce { depth: height - lowest, time, speed, spin, residual })
}

fn solid(mesh: &Mesh) -> Result<Shape, Error> {
    Ok(Shape::of_mesh(mesh, Sampling::Vertices, MassModel::Solid)?)
}

fn geodesic(subdivisions: u32) -> Result<Mesh, Error> {
    Ok(Primitive::Sphere { radius: RADIUS, subdivisions }.mesh()?)
}

/// A sphere of meridians and parallels, whose vertices crowd around the poles on the y axis.
fn globe(segments: u32) -> Result<Mesh, Error> {
    let rings = segments / 2;
    let place = |ring: u32, segment: u32| {
        let (polar, around) = (
            PI * f64::from(ring) / f64::from(rings),
            2.0 * PI * f64::from(segment) / f64::from(segments),
        );
        let (s, c) = (libm::sin(polar), libm::cos(polar));
        DVec3::new(s * libm::sin(around), c, s * libm::cos(around)) * RADIUS
    };
    let mut vertices = vec![DVec3::Y * RADIUS, DVec3::NEG_Y * RADIUS];
    vertices.extend((1..rings).flat_map(|ring| (0..segments).map(move |s| place(ring, s))));
    let at = |ring: u32, segment: u32| match ring {
        0 => 0,
        ring if ring == rings => 1,
        ring => 2 + (ring - 1) * segments + segment % segments,
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for s in 0..segments {
            let [a, b] = [at(ring, s), at(ring, s + 1)];
            let [c, d] = [at(ring + 1, s), at(ring + 1, s + 1)];
            triangles.extend(
                [[a, c, d], [a, d, b]].into_iter().filter(|[i, j, k]| i != j && j != k && i != k),
            );
        }
    }
    Ok(Mesh::new(vertices, triangles)?)
}

/// Every mesh of the sphere, what to call it, and how it is turned.
fn meshes() -> Result<Vec<(String, Mesh, DQuat)>, Error> {
    let some = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.7).normalize();
    let mut meshes = Vec::new();
    for subdivisions in [5, 4, 3] {
        meshes.push((format!("{subdivisions} subdivisions"), geodesic(subdivisions)?, some));
    }
    meshes.push(("globe on its pole".to_owned(), globe(96)?, DQuat::IDENTITY));
    meshes.push(("globe on its side".to_owned(), globe(96)?, DQuat::from_rotation_x(1.5)));
    Ok(meshes)
}

/// By Archimedes the sphere has 2 π R dh of its surface between heights h and h + dh, so that springs push back with
/// κ π R δ²: ½ M v² = κ π R δ³/3, and the contact lasts 2 δ/v ∫ dx/√(1 − x³) from 0 to 1.
fn spheres(checks: &mut Vec<Check>) -> Result<(), Error> {
    let depth = libm::cbrt(1.5 * MASS * SPEED * SPEED / (PI * KAPPA * RADIUS));
    let integral = PI.sqrt() * libm::tgamma(4.0 / 3.0) / libm::tgamma(5.0 / 6.0);
    let time = 2.0 * depth / SPEED * integral;
    let damped = Material { damping: Damping::Restitution(0.5), ..per_area() };
    let back = smooth_rebound(damped);
    let down = DVec3::NEG_Y * SPEED;
    for (name, mesh, turn) in meshes()? {
        let elastic = bounce(solid(&mesh)?, turn, RADIUS, per_area(), down)?;
        let name = format!("sphere, {name}");
        checks.push(Check::new(format!("depth, {name}"), depth, elastic.depth, 0.005 * depth, "m"));
        checks.push(Check::new(format!("time, {name}"), time, elastic.time, 0.005 * time, "s"));
        let damped = bounce(solid(&mesh)?, turn, RADIUS, damped, down)?;
        checks.push(Check::new(
            format!("rebound, {name}"),
            back,
            damped.speed,
            0.005 * back,
            "m/s",
        ));
    }
    Ok(())
}

/// How fast the smooth sphere comes back, with the springs and dashpots of its surface summed in closed form,
/// ∫ max(0, κ (δ − h) + c δ') 2 π R dh.
fn smooth_rebound(material: Material) -> f64 {
    let law = material.at_area(4.0 * PI * RADIUS * RADIUS).law(MASS);
    let lag = law.damping / law.stiffness;
    let force = |depth: f64, rate: f64| {
        let reach = (depth + lag * rate).max(0.0);
        let most = reach.min(depth);
        2.0 * PI * RADIUS * KAPPA * most * (reach - 0.5 * most)
    };
    smooth_bounce(force).2
}

/// Depth (m), time (s) and speed back (m/s) of a body that is pushed by `force` (N) of its depth and its rate, in
/// small steps.
fn smooth_bounce(force: impl Fn(f64, f64) -> f64) -> (f64, f64, f64) {
    let (mut depth, mut rate, mut time, mut deepest, h) = (0.0, SPEED, 0.0, 0.0f64, 1e-6);
    loop {
        let (middle, half) = (depth + 0.5 * h * rate, rate - 0.5 * h * force(depth, rate) / MASS);
        let push = force(middle, half);
        depth += h * half;
        rate -= h * push / MASS;
        time += h;
        deepest = deepest.max(depth);
        if rate < 0.0 && push <= 0.0 {
            return (deepest, time, -rate);
        }
    }
}

/// With a stiffness per particle, sixteen times the particles are sixteen times as stiff, and δ³ falls by that.
fn per_particle(checks: &mut Vec<Check>) -> Result<(), Error> {
    let depth = |subdivisions| -> Result<f64, Error> {
        let material = Material { collision_stiffness: 200.0, ..Material::default() };
        let turn = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.7).normalize();
        let shape = solid(&geodesic(subdivisions)?)?;
        Ok(bounce(shape, turn, RADIUS, material, DVec3::NEG_Y * SPEED)?.depth)
    };
    let expected = libm::cbrt(642.0 / 10242.0);
    let found = depth(5)? / depth(3)?;
    let quantity = "depth, sphere, 5 to 3 subdivisions, stiffness per particle";
    checks.push(Check::new(quantity, expected, found, 0.03 * expected, ""));
    Ok(())
}

/// A flat box sinks in with its face A and, by and by, with its sides: κ (A δ + P δ²/2), P around the face.
fn boxes(checks: &mut Vec<Check>) -> Result<(), Error> {
    let size = DVec3::new(0.3, 0.05, 0.3);
    let (face, around) = (size.x * size.z, 2.0 * (size.x + size.z));
    let force = |depth: f64, _| KAPPA * depth * (face + 0.5 * around * depth);
    let (depth, time, _) = smooth_bounce(force);
    for divisions in [6, 12, 24] {
        let shape = solid(&Primitive::Box { size, divisions }.mesh()?)?;
        let down = DVec3::NEG_Y * SPEED;
        let hit = bounce(shape, DQuat::IDENTITY, 0.5 * size.y, per_area(), down)?;
        let name = format!("box flat on its face, {divisions} divisions");
        checks.push(Check::new(format!("depth, {name}"), depth, hit.depth, 0.01 * depth, "m"));
        checks.push(Check::new(format!("time, {name}"), time, hit.time, 0.01 * time, "s"));
    }
    Ok(())
}

/// A sphere thrown at 45° against a floor with friction leaves with the same spin whatever its mesh.
fn oblique(checks: &mut Vec<Check>) -> Result<(), Error> {
    let material =
        Material { damping: Damping::Restitution(0.7), friction_stiffness: 0.2, ..per_area() };
    let mut finest = None;
    for (name, mesh, turn) in meshes()? {
        let thrown = DVec3::new(SPEED, -SPEED, 0.0);
        let found = bounce(solid(&mesh)?, turn, RADIUS, material, thrown)?;
        let expected = *finest.get_or_insert(found.spin.z);
        checks.push(Check::new(
            format!("spin of an oblique bounce, {name}"),
            expected,
            found.spin.z,
            0.01 * expected.abs(),
            "rad/s",
        ));
        checks.push(Check::error(format!("its ledger, {name}"), found.residual, 1e-5, ""));
    }
    Ok(())
}

/// An unevenly meshed plate that lies on the floor sinks in by M g/(κ A).
fn plate() -> Result<Check, Error> {
    let (xs, zs) = ([0.0, 0.01, 0.05, 0.12, 0.13, 0.21, 0.3], [0.0, 0.07, 0.08, 0.15, 0.2]);
    let vertices = xs.iter().flat_map(|&x| zs.iter().map(move |&z| DVec3::new(x, 0.0, z)));
    let (vertices, mut triangles) = (vertices.collect::<Vec<_>>(), Vec::new());
    for i in 0..xs.len() as u32 - 1 {
        for j in 0..zs.len() as u32 - 1 {
            let corner = |i, j| i * zs.len() as u32 + j;
            let [a, b, c, d] =
                [corner(i, j), corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    let mesh = Mesh::new(vertices, triangles)?;
    let shape = Shape::of_mesh(&mesh, Sampling::Vertices, MassModel::Shell)?;
    let material = Material { damping: Damping::Restitution(0.2), ..per_area() };
    let body = Body::new(shape).mass(MASS).position(DVec3::ZERO);
    // at rest a dashpot feels the kicks of the steps, which costs some g h² of depth
    let mut world = on_floor(material).dt(5e-6).body(body).build()?;
    run(&mut world, 0.5)?;
    let expected = MASS * 9.8 / (KAPPA * 0.06);
    let depth = -world.body(0).position().y;
    Ok(Check::new("depth, plate of 0.06 m² at rest", expected, depth, 1e-6 * expected, "m"))
}
