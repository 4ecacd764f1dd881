//! The sitting cat, as a table of parts.
//!
//! Lengths are in model units: the ground is y = 0, the ears end near y = 2, the cat faces +z.

use crate::solid::{Act, Part, Shape, Solid};
use glam::{DMat3, DVec3};

/// The parts, from the trunk outwards; a later part lies over an earlier one.
pub fn solid() -> Solid {
    let mut parts = trunk();
    parts.extend(hind_legs());
    parts.extend(forelegs());
    parts.push(tail());
    parts.extend(head());
    parts.extend(ears());
    parts.extend(face());
    Solid { parts, ground_blend: 0.04 }
}

/// The wanted edge length: finer on the face and the paws than on the trunk.
pub fn spacing(point: DVec3) -> f64 {
    const TRUNK: f64 = 0.060;
    const FACE: f64 = 0.036;
    // 1 around the face, fading to 0 over the neck
    let near = 1.0 - ((point.distance(DVec3::new(0.0, 1.52, 0.45)) - 0.35) / 0.5).clamp(0.0, 1.0);
    TRUNK + near * near * (3.0 - 2.0 * near) * (FACE - TRUNK)
}

fn trunk() -> Vec<Part> {
    vec![
        part("rump", egg([0.0, 0.36, -0.30], [0.40, 0.42, 0.42], 0.0), 0.1),
        part("belly", egg([0.0, 0.60, -0.10], [0.36, 0.52, 0.36], -22.0), 0.25),
        part("chest", egg([0.0, 0.92, 0.14], [0.30, 0.36, 0.27], -10.0), 0.25),
        part("neck", path(&[[0.0, 1.05, 0.10, 0.25], [0.0, 1.40, 0.22, 0.22]]), 0.20),
        part("ruff", egg([0.0, 1.10, 0.25], [0.22, 0.24, 0.19], 0.0), 0.15),
    ]
}

fn hind_legs() -> Vec<Part> {
    vec![
        twins("thigh", egg([0.34, 0.34, -0.08], [0.17, 0.34, 0.36], -12.0), 0.08),
        twins("hind foot", path(&[[0.40, 0.06, 0.0, 0.085], [0.41, 0.055, 0.34, 0.075]]), 0.05),
        twins("hind toes", egg([0.41, 0.065, 0.36], [0.095, 0.08, 0.12], 0.0), 0.04),
    ]
}

fn forelegs() -> Vec<Part> {
    vec![
        twins("shoulder", egg([0.21, 0.84, 0.16], [0.12, 0.27, 0.18], -6.0), 0.12),
        twins(
            "foreleg",
            path(&[[0.18, 0.78, 0.26, 0.12], [0.155, 0.40, 0.35, 0.092], [0.15, 0.08, 0.38, 0.082]]),
            0.06,
        ),
        twins("fore paw", egg([0.155, 0.06, 0.45], [0.105, 0.085, 0.145], 0.0), 0.04),
    ]
}

fn tail() -> Part {
    let knots = [
        [0.00, 0.16, -0.60, 0.11],
        [0.26, 0.09, -0.57, 0.105],
        [0.46, 0.08, -0.36, 0.10],
        [0.55, 0.08, -0.05, 0.095],
        [0.56, 0.08, 0.28, 0.09],
        [0.48, 0.08, 0.50, 0.08],
        [0.37, 0.08, 0.60, 0.06],
    ];
    part("tail", curve(&knots), 0.03)
}

fn head() -> Vec<Part> {
    vec![
        part("skull", egg([0.0, 1.54, 0.30], [0.38, 0.31, 0.33], 0.0), 0.12),
        twins("cheek", egg([0.21, 1.43, 0.37], [0.19, 0.15, 0.18], 0.0), 0.12),
    ]
}

fn ears() -> Vec<Part> {
    vec![
        twins("ear back", path(&[[0.22, 1.70, 0.20, 0.13], [0.31, 2.02, 0.21, 0.03]]), 0.08),
        twins("ear", plate([[0.09, 1.76, 0.30], [0.37, 1.60, 0.20], [0.315, 2.04, 0.23]], 0.035), 0.06),
        carve("ear cup", plate([[0.16, 1.81, 0.37], [0.33, 1.74, 0.32], [0.30, 1.93, 0.295]], 0.035), 0.03),
    ]
}

fn face() -> Vec<Part> {
    vec![
        twins("muzzle", egg([0.08, 1.415, 0.59], [0.105, 0.08, 0.11], 0.0), 0.06),
        part("chin", egg([0.0, 1.35, 0.57], [0.075, 0.06, 0.08], 0.0), 0.04),
        part("bridge", path(&[[0.0, 1.64, 0.54, 0.07], [0.0, 1.49, 0.64, 0.05]]), 0.08),
        carve("eye socket", egg([0.17, 1.565, 0.64], [0.095, 0.075, 0.08], 0.0), 0.05),
        twins("eye", egg([0.165, 1.565, 0.555], [0.08, 0.065, 0.06], 0.0), 0.012),
        part("nose", egg([0.0, 1.485, 0.685], [0.055, 0.035, 0.035], 0.0), 0.02),
    ]
}

/// A part on the plane of symmetry, or without a twin.
fn part(name: &'static str, shape: Shape, blend: f64) -> Part {
    Part { name, shape, act: Act::Join, blend, mirrored: false }
}

/// A part at +x with its twin at −x.
fn twins(name: &'static str, shape: Shape, blend: f64) -> Part {
    Part { mirrored: true, ..part(name, shape, blend) }
}

/// A pair of hollows.
fn carve(name: &'static str, shape: Shape, blend: f64) -> Part {
    Part { act: Act::Carve, ..twins(name, shape, blend) }
}

/// An ellipsoid; `pitch` in degrees tips its top forwards.
fn egg(centre: [f64; 3], radii: [f64; 3], pitch: f64) -> Shape {
    let (sine, cosine) = libm::sincos(pitch.to_radians());
    Shape::Ellipsoid {
        centre: centre.into(),
        radii: radii.into(),
        to_local: DMat3::from_cols(
            DVec3::X,
            DVec3::new(0.0, cosine, -sine),
            DVec3::new(0.0, sine, cosine),
        ),
    }
}

/// A path of round cones through `[x, y, z, radius]` knots.
fn path(knots: &[[f64; 4]]) -> Shape {
    Shape::Path(knots.iter().map(|&[x, y, z, radius]| (DVec3::new(x, y, z), radius)).collect())
}

/// A Catmull-Rom curve through `[x, y, z, radius]` knots.
fn curve(knots: &[[f64; 4]]) -> Shape {
    let at = |i: usize| knots[i.clamp(1, knots.len()) - 1];
    let mut fine = vec![];
    for span in 1..knots.len() {
        let [p, q, r, s] = [at(span - 1), at(span), at(span + 1), at(span + 2)];
        for step in 0..6 {
            let t = f64::from(step) / 6.0;
            fine.push([0, 1, 2, 3].map(|i| {
                let bend = 2.0 * p[i] - 5.0 * q[i] + 4.0 * r[i] - s[i];
                let twist = 3.0 * (q[i] - r[i]) + s[i] - p[i];
                q[i] + 0.5 * t * (r[i] - p[i] + t * (bend + t * twist))
            }));
        }
    }
    fine.push(knots[knots.len() - 1]);
    path(&fine)
}

/// A triangular plate.
fn plate(corners: [[f64; 3]; 3], radius: f64) -> Shape {
    Shape::Plate { corners: corners.map(DVec3::from_array), radius }
}
