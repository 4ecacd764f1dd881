//! Draws pictures of synthetic motions: `sample_pictures FOLDER [MESH.obj SCALE]`.
//!
//! The motions are not simulated. The example serves to inspect the rendering.

use std::error::Error;
use std::path::Path;
use std::time::Instant;
use tumble::{DQuat, DVec3};
use tumble_io::picture::{
    Boundary, DEFAULT_SIZE, Frame, PictureBody, PictureInput, Pose, encode_png, render,
};

type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// Mesh of a sphere with `count` rings and twice as many sectors.
fn sphere(radius: f64, count: u32) -> Mesh {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    let sectors = 2 * count;
    for ring in 0..=count {
        let (sin, cos) = (std::f64::consts::PI * f64::from(ring) / f64::from(count)).sin_cos();
        for sector in 0..sectors {
            let (y, x) = (std::f64::consts::TAU * f64::from(sector) / f64::from(sectors)).sin_cos();
            vertices.push(radius * DVec3::new(sin * x, cos, sin * y));
            if ring < count {
                let (a, b) = (ring * sectors + sector, ring * sectors + (sector + 1) % sectors);
                triangles.push([a, b, b + sectors]);
                triangles.push([a, b + sectors, a + sectors]);
            }
        }
    }
    (vertices, triangles)
}

fn brick(half: DVec3) -> Mesh {
    let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
    let corner = |i: u32| half * DVec3::new(sign(i & 1), sign(i & 2), sign(i & 4));
    let quads =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |q: [u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]];
    ((0..8).map(corner).collect(), quads.into_iter().flat_map(halves).collect())
}

/// Reads vertices and triangles of an OBJ file and moves the mean of the vertices to the origin.
fn read_obj(path: &str, scale: f64) -> Result<Mesh, Box<dyn Error>> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for line in std::fs::read_to_string(path)?.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |i: usize| words.get(i).and_then(|w| w.parse().ok()).unwrap_or(0.0);
        let index = |i: usize| {
            let word = words.get(i).and_then(|w| w.split('/').next());
            word.and_then(|w| w.parse::<u32>().ok()).unwrap_or(1).saturating_sub(1)
        };
        match words.first() {
            Some(&"v") => vertices.push(scale * DVec3::new(number(1), number(2), number(3))),
            Some(&"f") => triangles.push([index(1), index(2), index(3)]),
            _ => {}
        }
    }
    let mean = vertices.iter().sum::<DVec3>() / vertices.len().max(1) as f64;
    vertices.iter_mut().for_each(|v| *v -= mean);
    Ok((vertices, triangles))
}

/// A spinning body thrown inside a box, with a coefficient of restitution of 0.8 at the walls. Very
/// large bounds stand for missing walls.
struct Throw {
    start: DVec3,
    velocity: DVec3,
    gravity: DVec3,
    spin: DVec3,
    radius: f64,
    low: DVec3,
    high: DVec3,
}

impl Throw {
    fn frames(&self, duration: f64, count: usize) -> Vec<(f64, Pose)> {
        let (mut position, mut velocity) = (self.start, self.velocity);
        let (mut orientation, mut spin) = (DQuat::IDENTITY, self.spin);
        let steps = 40;
        let dt = duration / (count * steps) as f64;
        let mut poses = Vec::new();
        for step in 0..=count * steps {
            if step % steps == 0 {
                poses.push((step as f64 * dt, Pose { position, orientation }));
            }
            velocity += self.gravity * dt;
            position += velocity * dt;
            orientation = DQuat::from_scaled_axis(spin * dt) * orientation;
            for axis in 0..3 {
                let (low, high) = (self.low[axis] + self.radius, self.high[axis] - self.radius);
                let hit = (position[axis] < low && velocity[axis] < 0.0)
                    || (position[axis] > high && velocity[axis] > 0.0);
                if hit {
                    velocity[axis] *= -0.8;
                    spin = spin * 0.8 + DVec3::new(velocity.z, 0.0, -velocity.x);
                }
            }
        }
        poses
    }
}

fn to_frames(motions: &[Vec<(f64, Pose)>]) -> Vec<Frame> {
    let frame = |i: usize| Frame {
        time: motions[0][i].0,
        poses: motions.iter().map(|motion| motion[i].1).collect(),
    };
    (0..motions.first().map_or(0, Vec::len)).map(frame).collect()
}

struct Sample<'a> {
    name: &'a str,
    title: &'a str,
    up: DVec3,
    meshes: Vec<&'a Mesh>,
    boundary: Vec<Boundary>,
    frames: Vec<Frame>,
}

fn draw(folder: &Path, sample: &Sample, size: (u32, u32)) -> Result<(), Box<dyn Error>> {
    let names: Vec<String> = (1..=sample.meshes.len()).map(|i| format!("body {i}")).collect();
    let body =
        |(mesh, name): (&&'_ Mesh, &'_ String)| (mesh.0.clone(), mesh.1.clone(), name.clone());
    let owned: Vec<_> = sample.meshes.iter().zip(&names).map(body).collect();
    let bodies: Vec<PictureBody> = owned
        .iter()
        .map(|(vertices, triangles, name)| PictureBody {
            name,
            vertices,
            triangles,
            is_kinematic: false,
        })
        .collect();
    let input = PictureInput {
        title: sample.title,
        up: sample.up,
        bodies: &bodies,
        boundary: &sample.boundary,
        frames: &sample.frames,
        size,
    };
    let start = Instant::now();
    let image = render(&input);
    let render_time = start.elapsed();
    let png = encode_png(&image)?;
    println!(
        "{:12} {render_time:8.2?} {:8.2?} {} kB",
        sample.name,
        start.elapsed(),
        png.len() / 1024
    );
    std::fs::write(folder.join(format!("{}.png", sample.name)), png)?;
    Ok(())
}

fn open_box(half: f64) -> Boundary {
    Boundary::Box {
        min: DVec3::splat(-half),
        max: DVec3::splat(half),
        orientation: DQuat::IDENTITY,
        open: [false, false, false, true, false, false],
    }
}

fn throw(half: f64, velocity: DVec3, spin: DVec3, radius: f64) -> Throw {
    let high = DVec3::new(half, f64::MAX, half);
    let gravity = DVec3::new(0.0, -9.8, 0.0);
    Throw { start: DVec3::ZERO, velocity, gravity, spin, radius, low: DVec3::splat(-half), high }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = Path::new(arguments.first().map_or("pictures", String::as_str));
    std::fs::create_dir_all(folder)?;
    let brick = brick(DVec3::new(0.25, 0.12, 0.18));
    let thrown = match (arguments.get(1), arguments.get(2).and_then(|s| s.parse().ok())) {
        (Some(path), Some(scale)) => read_obj(path, scale)?,
        _ => brick.clone(),
    };
    let point: Mesh = (vec![DVec3::ZERO], Vec::new());
    let small = sphere(0.07, 16);
    let cloud: Mesh = (sphere(0.2, 14).0, Vec::new());
    let huge = sphere(0.4, 720);
    let y = DVec3::Y;
    let velocity = DVec3::new(4.0, 2.0, 3.0);
    let spin = DVec3::new(0.0, 100.0, 0.0);
    let flat = |normal: DVec3| vec![Boundary::Plane { normal, offset: 0.0 }];
    let over_plane = |x: f64, up: f64| Throw {
        start: DVec3::new(x, 0.5, -0.2 * x),
        velocity: DVec3::new(2.0 + x, up, 0.7),
        low: DVec3::new(-9e9, 0.0, -9e9),
        high: DVec3::splat(9e9),
        ..throw(1.0, velocity, DVec3::new(3.0, 1.0, 2.0), 0.2)
    };
    let spheres: Vec<_> = (0..200)
        .map(|i: i32| {
            let at = DVec3::new(f64::from(i % 6), f64::from(i / 36), f64::from(i / 6 % 6)) * 0.3;
            let velocity =
                DVec3::new(f64::from(i * 37 % 11) - 5.0, 1.0, f64::from(i * 53 % 13) - 6.0);
            Throw {
                start: at - DVec3::new(0.75, 0.0, 0.75),
                ..throw(1.0, 0.3 * velocity, DVec3::ONE, 0.07)
            }
            .frames(1.5, 90)
        })
        .collect();
    let free = |v: DVec3| Throw {
        gravity: DVec3::ZERO,
        low: DVec3::splat(-9e9),
        high: DVec3::splat(9e9),
        ..throw(1.0, v, DVec3::new(1.0, 3.0, 0.5), 0.0)
    };
    let tilted = Throw {
        start: DVec3::new(0.0, 0.0, 0.4),
        velocity: DVec3::new(1.2, 0.8, 2.0),
        gravity: DVec3::new(0.0, 0.0, -9.8),
        low: DVec3::new(-9e9, -9e9, 0.0),
        ..free(DVec3::ZERO)
    };
    let single = |motion: &Throw, time, count| to_frames(&[motion.frames(time, count)]);
    let sample = |name, title, meshes, boundary, frames| Sample {
        name,
        title,
        up: y,
        meshes,
        boundary,
        frames,
    };
    let bounce = throw(1.0, velocity, spin, 0.22);
    let samples = [
        sample(
            "box",
            "a mesh in an open box",
            vec![&thrown],
            vec![open_box(1.0)],
            single(&bounce, 3.0, 300),
        ),
        sample(
            "short",
            "a mesh in an open box",
            vec![&thrown],
            vec![open_box(1.0)],
            single(&bounce, 0.8, 80),
        ),
        sample(
            "point",
            "a point",
            vec![&point],
            vec![open_box(1.0)],
            single(&throw(1.0, velocity, spin, 0.0), 1.2, 200),
        ),
        sample(
            "crowd",
            "two hundred balls",
            vec![&small; 200],
            vec![open_box(1.0)],
            to_frames(&spheres),
        ),
        sample(
            "tall",
            "out through the top",
            vec![&thrown],
            vec![open_box(1.0)],
            single(&throw(1.0, DVec3::new(0.3, 9.0, 0.2), spin, 0.25), 2.4, 240),
        ),
        sample(
            "plane",
            "bricks and a cloud on a plane",
            vec![&brick, &cloud, &brick],
            flat(y),
            to_frames(&[
                over_plane(0.0, 3.0).frames(1.5, 150),
                over_plane(-0.9, 4.0).frames(1.5, 150),
                over_plane(1.2, 2.0).frames(1.5, 150),
            ]),
        ),
        Sample {
            up: DVec3::Z,
            ..sample(
                "z-up",
                "gravity along −z",
                vec![&brick],
                flat(DVec3::Z),
                single(&Throw { radius: 0.15, ..tilted }, 1.6, 160),
            )
        },
        sample(
            "free",
            "free flight",
            vec![&brick, &thrown],
            Vec::new(),
            to_frames(&[
                free(DVec3::new(1.0, 0.2, 0.0)).frames(3.0, 100),
                Throw { start: DVec3::new(2.0, 0.8, -0.6), ..free(DVec3::new(-0.6, -0.1, 0.8)) }
                    .frames(3.0, 100),
            ]),
        ),
        sample(
            "start",
            "only the start",
            vec![&thrown],
            vec![open_box(1.0)],
            single(&bounce, 0.01, 1)[..1].to_vec(),
        ),
        sample(
            "million",
            "a million vertices",
            vec![&huge],
            vec![open_box(1.0)],
            single(&throw(1.0, velocity, spin, 0.4), 1.0, 100),
        ),
    ];
    for sample in &samples {
        draw(folder, sample, DEFAULT_SIZE)?;
    }
    let small_picture = Sample {
        name: "little",
        ..sample("", "little", vec![&thrown], vec![open_box(1.0)], single(&bounce, 0.8, 80))
    };
    draw(folder, &small_picture, (480, 300))
}
