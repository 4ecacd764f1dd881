//! The signed distance against plain loops and closed formulas.

mod agreement;
mod nearby;
mod surfaces;

use glam::{DQuat, DVec3};
use proptest::prelude::*;

use super::*;
use crate::{Mesh, Primitive};

const NO_HINT: u32 = u32::MAX;

/// The mesh of a built-in shape.
fn primitive(name: &str) -> Mesh {
    Primitive::from_name(name).unwrap().mesh().unwrap()
}

/// A mesh with transformed vertices.
fn moved(mesh: &Mesh, by: impl Fn(DVec3) -> DVec3) -> Mesh {
    Mesh { vertices: mesh.vertices.iter().map(|&v| by(v)).collect(), ..mesh.clone() }
}

/// A closed star-shaped mesh: a sphere with a random radius in each direction.
fn star(seed: u64) -> Mesh {
    let sphere = Primitive::Sphere { radius: 1.0, subdivisions: 2 }.mesh().unwrap();
    let mut state = seed | 1;
    let radii: Vec<f64> = sphere.vertices.iter().map(|_| 0.4 + random(&mut state)).collect();
    let vertices = sphere.vertices.iter().zip(radii).map(|(v, r)| *v * r).collect();
    Mesh { vertices, ..sphere }
}

/// A number from 0 to 1; Marsaglia's xorshift, J. Stat. Softw. 8 (2003) 14.
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// Points in and around the box of a mesh, some close to its surface and some on it.
fn points(mesh: &Mesh, count: usize, seed: u64) -> Vec<DVec3> {
    let low = mesh.vertices.iter().fold(DVec3::INFINITY, |low, v| low.min(*v));
    let high = mesh.vertices.iter().fold(DVec3::NEG_INFINITY, |high, v| high.max(*v));
    let mut state = seed | 1;
    let mut cube = || DVec3::from_array([(); 3].map(|()| random(&mut state) - 0.5));
    let middle = 0.5 * (low + high);
    (0..count)
        .map(|i| match i % 3 {
            0 => middle + cube() * 1.5 * (high - low),
            1 => mesh.vertices[i * 7 % mesh.vertices.len()] + cube() * 0.05 * (high - low),
            _ => {
                let t = mesh.triangles[i * 13 % mesh.triangles.len()];
                let [a, b, c] = t.map(|i| mesh.vertices[i as usize]);
                let w = cube() + 0.5;
                let on = (a * w.x + b * w.y + c * w.z) / w.element_sum();
                on + cube() * [0.0, 0.01, 0.1][i % 9 / 3] * (high - low)
            }
        })
        .collect()
}

/// The distance to a triangle by Ericson's regions (Real-Time Collision Detection, 2004, 5.1.5).
fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let (ab, ac) = (b - a, c - a);
    let along = |v: DVec3| (ab.dot(v), ac.dot(v));
    let ((d1, d2), (d3, d4), (d5, d6)) = (along(p - a), along(p - b), along(p - c));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let closest = if d1 <= 0.0 && d2 <= 0.0 {
        a
    } else if d3 >= 0.0 && d4 <= d3 {
        b
    } else if d6 >= 0.0 && d5 <= d6 {
        c
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        a + ab * (d1 / (d1 - d3))
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        a + ac * (d2 / (d2 - d6))
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))
    } else {
        a + (ab * vb + ac * vc) / (va + vb + vc)
    };
    p.distance(closest)
}

/// The unsigned distance by a loop over all triangles.
fn plain_distance(mesh: &Mesh, p: DVec3) -> f64 {
    let to = |t: &[u32; 3]| to_triangle(p, t.map(|i| mesh.vertices[i as usize]));
    mesh.triangles.iter().map(to).fold(f64::INFINITY, f64::min)
}

/// Whether a point is inside, by a sum of solid angles over the mesh itself.
fn plain_inside(mesh: &Mesh, p: DVec3) -> bool {
    let angle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.vertices[i as usize] - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let along = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * libm::atan2(a.dot(b.cross(c)), along)
    };
    mesh.triangles.iter().map(angle).sum::<f64>() > 2.0 * std::f64::consts::PI
}

fn vector() -> impl Strategy<Value = DVec3> {
    [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
}

fn turn() -> DQuat {
    DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7)
}
