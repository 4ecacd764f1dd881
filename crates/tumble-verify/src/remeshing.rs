//! Contact stiffness per area: a bounce does not depend on the mesh of the body.

use std::f64::consts::PI;

use tumble::{Body, DQuat, DVec3, Damping, MassModel, Material, Mesh, Primitive, Sampling, Shape};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{G, step_until, world_with_floor};

pub(crate) const REMESHING: Case = Case {
    name: "remeshing",
    description: "Bodies of 1 kg with the same stiffness per area hit a floor at 2 m/s. The meshes differ. Penetration depth, contact time and \
            rebound speed are compared with the smooth body, the spin after an oblique impact with the finest mesh. A plate at \
            rest sinks in by M g/(κ A).",
    run: remeshing,
    slow: false,
};

/// Stiffness per area κ (N/m³).
const KAPPA: f64 = 5e5;
/// Mass of every body (kg).
const MASS: f64 = 1.0;
/// Impact speed (m/s).
const SPEED: f64 = 2.0;
/// Radius of the spheres (m).
const RADIUS: f64 = 0.15;
/// Time step (s).
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

/// The measured properties of a bounce.
struct Bounce {
    /// Largest penetration depth of the lowest point (m).
    depth: f64,
    /// Contact time (s).
    time: f64,
    /// Rebound speed (m/s).
    speed: f64,
    /// Angular velocity after the bounce (rad/s).
    spin: DVec3,
    /// Largest residual of the energy ledger, relative to the energy at the start.
    residual: f64,
}

/// Simulates a bounce off the floor without gravity.
///
/// `height` is the distance from the body's centre to its lowest point (m), `velocity` the impact velocity (m/s).
fn bounce(
    shape: Shape,
    orientation: DQuat,
    height: f64,
    material: Material,
    velocity: DVec3,
) -> Result<Bounce, Error> {
    let body = Body::new(shape)
        .mass(MASS)
        .orientation(orientation)
        .position(DVec3::Y * height)
        .velocity(velocity);
    let mut world = world_with_floor(material).gravity(DVec3::ZERO).dt(DT).body(body).build()?;
    let start = world.energy().total();
    let (mut lowest, mut first_contact, mut last_contact, mut residual) =
        (height, None, 0.0, 0.0f64);
    while world.time() < 0.2 {
        world.step()?;
        let energy = world.energy();
        residual = residual.max((energy.total() - start).abs() / start);
        lowest = lowest.min(world.body(0).position().y);
        if energy.elastic > 0.0 {
            first_contact.get_or_insert(world.time());
            last_contact = world.time();
        }
    }
    let (speed, spin) = (world.body(0).velocity().y, world.body(0).angular_velocity());
    let time = last_contact - first_contact.unwrap_or(f64::NAN);
    Ok(Bounce { depth: height - lowest, time, speed, spin, residual })
}

fn solid(mesh: &Mesh) -> Result<Shape, Error> {
    Ok(Shape::from_mesh(mesh, Sampling::Vertices, MassModel::Solid)?)
}

fn geodesic(subdivisions: u32) -> Result<Mesh, Error> {
    Ok(Primitive::Sphere { radius: RADIUS, subdivisions }.mesh()?)
}

/// A sphere meshed along meridians and parallels. Its vertices are densest at the poles, on the y axis.
fn uv_sphere(segments: u32) -> Result<Mesh, Error> {
    let rings = segments / 2;
    let position = |ring: u32, segment: u32| {
        let (polar, azimuth) = (
            PI * f64::from(ring) / f64::from(rings),
            2.0 * PI * f64::from(segment) / f64::from(segments),
        );
        let (s, c) = (libm::sin(polar), libm::cos(polar));
        DVec3::new(s * libm::sin(azimuth), c, s * libm::cos(azimuth)) * RADIUS
    };
    let mut vertices = vec![DVec3::Y * RADIUS, DVec3::NEG_Y * RADIUS];
    vertices.extend((1..rings).flat_map(|ring| (0..segments).map(move |s| position(ring, s))));
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

/// The meshes of the sphere, the finest first, each with its name and orientation.
fn sphere_meshes() -> Result<Vec<(String, Mesh, DQuat)>, Error> {
    let oblique = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.7).normalize();
    let mut meshes = Vec::new();
    for subdivisions in [5, 4, 3] {
        meshes.push((format!("{subdivisions} subdivisions"), geodesic(subdivisions)?, oblique));
    }
    meshes.push((
        "meridians and parallels, on its pole".to_owned(),
        uv_sphere(96)?,
        DQuat::IDENTITY,
    ));
    meshes.push((
        "meridians and parallels, on its side".to_owned(),
        uv_sphere(96)?,
        DQuat::from_rotation_x(1.5),
    ));
    Ok(meshes)
}

/// Compares spheres with a smooth sphere of the same stiffness per area.
///
/// The surface of a sphere between the heights h and h + dh is 2 π R dh (Archimedes), so the force at depth δ is κ π R δ².
/// The largest depth follows from ½ M v² = κ π R δ³/3. The contact time is 2 δ/v ∫ dx/√(1 − x³) from 0 to 1.
fn spheres(checks: &mut Vec<Check>) -> Result<(), Error> {
    let depth = libm::cbrt(1.5 * MASS * SPEED * SPEED / (PI * KAPPA * RADIUS));
    let integral = PI.sqrt() * libm::tgamma(4.0 / 3.0) / libm::tgamma(5.0 / 6.0);
    let time = 2.0 * depth / SPEED * integral;
    let damped = Material { damping: Damping::Restitution(0.5), ..per_area() };
    let rebound = 0.5 * SPEED;
    let down = DVec3::NEG_Y * SPEED;
    for (name, mesh, orientation) in sphere_meshes()? {
        let elastic = bounce(solid(&mesh)?, orientation, RADIUS, per_area(), down)?;
        let name = format!("sphere with {name}");
        checks.push(Check::new(format!("depth, {name}"), depth, elastic.depth, 0.005 * depth, "m"));
        checks.push(Check::new(
            format!("contact time, {name}"),
            time,
            elastic.time,
            0.005 * time,
            "s",
        ));
        let damped = bounce(solid(&mesh)?, orientation, RADIUS, damped, down)?;
        checks.push(Check::new(
            format!("rebound speed, {name}"),
            rebound,
            damped.speed,
            0.005 * rebound,
            "m/s",
        ));
    }
    Ok(())
}

/// Largest depth (m), contact time (s) and rebound speed (m/s) of a point mass under a contact force.
///
/// `force` is a function (N) of the depth (m) and its rate of change (m/s).
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

/// With a stiffness per particle the depth does depend on the mesh.
///
/// The stiffness of the body is proportional to the number of particles, and δ³ to its reciprocal.
fn per_particle(checks: &mut Vec<Check>) -> Result<(), Error> {
    let depth = |subdivisions| -> Result<f64, Error> {
        let material = Material { collision_stiffness: 200.0, ..Material::default() };
        let orientation = DQuat::from_xyzw(0.3, -0.5, 0.2, 0.7).normalize();
        let shape = solid(&geodesic(subdivisions)?)?;
        Ok(bounce(shape, orientation, RADIUS, material, DVec3::NEG_Y * SPEED)?.depth)
    };
    let expected = libm::cbrt(642.0 / 10242.0);
    let ratio = depth(5)? / depth(3)?;
    let quantity = "ratio of depths, sphere with 5 and 3 subdivisions, stiffness per particle";
    checks.push(Check::new(quantity, expected, ratio, 0.03 * expected, ""));
    Ok(())
}

/// Compares boxes that land flat with the force κ (A δ + P δ²/2) of a smooth box.
///
/// A is the area of the lower face and P its perimeter: at depth δ the sides are in contact too.
fn boxes(checks: &mut Vec<Check>) -> Result<(), Error> {
    let size = DVec3::new(0.3, 0.05, 0.3);
    let (area, perimeter) = (size.x * size.z, 2.0 * (size.x + size.z));
    let force = |depth: f64, _| KAPPA * depth * (area + 0.5 * perimeter * depth);
    let (depth, time, _) = smooth_bounce(force);
    for divisions in [6, 12, 24] {
        let shape = solid(&Primitive::Box { size, divisions }.mesh()?)?;
        let down = DVec3::NEG_Y * SPEED;
        let impact = bounce(shape, DQuat::IDENTITY, 0.5 * size.y, per_area(), down)?;
        let name = format!("box on its face, {divisions} divisions");
        checks.push(Check::new(format!("depth, {name}"), depth, impact.depth, 0.01 * depth, "m"));
        checks.push(Check::new(
            format!("contact time, {name}"),
            time,
            impact.time,
            0.01 * time,
            "s",
        ));
    }
    Ok(())
}

/// Compares the spin of spheres after an impact at 45° on a floor with friction.
fn oblique(checks: &mut Vec<Check>) -> Result<(), Error> {
    let material =
        Material { damping: Damping::Restitution(0.7), friction_stiffness: 0.2, ..per_area() };
    let mut finest = None;
    for (name, mesh, orientation) in sphere_meshes()? {
        let velocity = DVec3::new(SPEED, -SPEED, 0.0);
        let impact = bounce(solid(&mesh)?, orientation, RADIUS, material, velocity)?;
        let expected = *finest.get_or_insert(impact.spin.z);
        let quantity = format!("spin after an oblique impact, sphere with {name}");
        let bound = 0.01 * expected.abs();
        checks.push(Check::new(quantity, expected, impact.spin.z, bound, "rad/s"));
        let quantity = format!("residual of the oblique impact, relative, sphere with {name}");
        checks.push(Check::error(quantity, impact.residual, 1e-5, ""));
    }
    Ok(())
}

/// A plate with an uneven mesh that rests on the floor sinks in by M g/(κ A).
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
    let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Shell)?;
    let material = Material { damping: Damping::Restitution(0.2), ..per_area() };
    let body = Body::new(shape).mass(MASS).position(DVec3::ZERO);
    // At rest the dashpot acts on the velocity change of each kick, which changes the depth by about g h².
    let mut world = world_with_floor(material).dt(5e-6).body(body).build()?;
    step_until(&mut world, 0.5)?;
    let expected = MASS * G / (KAPPA * 0.06);
    let depth = -world.body(0).position().y;
    Ok(Check::new("depth of a plate of 0.06 m² at rest", expected, depth, 1e-6 * expected, "m"))
}
