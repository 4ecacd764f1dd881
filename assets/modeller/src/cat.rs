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
    parts.extend(toes());
    parts.push(tail());
    parts.extend(head());
    parts.extend(ears());
    parts.extend(face());
    Solid { parts, ground_blend: 0.015 }
}

/// The wanted edge length on the trunk.
const COARSE: f64 = 0.057;

/// Where the mesh is finer: centre, radius of full effect, wanted edge length.
const FINE: [([f64; 3], f64, f64); 4] = [
    ([0.0, 1.50, 0.55], 0.30, 0.029),
    ([0.25, 1.85, 0.25], 0.25, 0.040),
    ([0.155, 0.05, 0.56], 0.10, 0.027),
    ([0.41, 0.06, 0.45], 0.10, 0.027),
];

/// The wanted edge length: finer on the face, the ears and the paws than on the trunk.
pub fn spacing(point: DVec3) -> f64 {
    let folded = DVec3::new(libm::fabs(point.x), point.y, point.z);
    FINE.iter().fold(COARSE, |size, &(centre, radius, fine)| {
        // lengths grow by an eighth of the way walked: neighbours differ little
        let away = (folded.distance(centre.into()) - radius).max(0.0);
        size.min(fine + away / 8.0)
    })
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
        twins("hind foot", path(&[[0.40, 0.06, 0.0, 0.085], [0.41, 0.05, 0.34, 0.075]]), 0.05),
        twins("hind toes", egg([0.41, 0.055, 0.36], [0.095, 0.08, 0.12], 0.0), 0.04),
    ]
}

fn forelegs() -> Vec<Part> {
    vec![
        twins("shoulder", egg([0.21, 0.84, 0.16], [0.12, 0.27, 0.18], -6.0), 0.12),
        twins(
            "foreleg",
            path(&[
                [0.18, 0.78, 0.26, 0.12],
                [0.155, 0.40, 0.35, 0.092],
                [0.15, 0.08, 0.38, 0.082],
            ]),
            0.09,
        ),
        twins("fore paw", egg([0.155, 0.055, 0.45], [0.105, 0.085, 0.145], 0.0), 0.04),
    ]
}

fn tail() -> Part {
    let knots = [
        [0.00, 0.16, -0.60, 0.11],
        [0.26, 0.075, -0.57, 0.105],
        [0.46, 0.07, -0.36, 0.10],
        [0.55, 0.07, -0.05, 0.095],
        [0.56, 0.065, 0.28, 0.09],
        [0.48, 0.055, 0.50, 0.08],
        [0.37, 0.04, 0.61, 0.055],
    ];
    part("tail", curve(&knots), 0.09)
}

fn head() -> Vec<Part> {
    vec![
        part("skull", egg([0.0, 1.54, 0.30], [0.38, 0.31, 0.33], 0.0), 0.12),
        twins("cheek", egg([0.21, 1.43, 0.37], [0.19, 0.15, 0.18], 0.0), 0.12),
    ]
}

fn ears() -> Vec<Part> {
    vec![
        twins("ear back", path(&[[0.22, 1.70, 0.20, 0.13], [0.325, 2.02, 0.21, 0.03]]), 0.08),
        twins(
            "ear",
            plate([[0.09, 1.77, 0.30], [0.315, 1.68, 0.20], [0.335, 2.05, 0.23]], 0.032),
            0.06,
        ),
        carve(
            "ear cup",
            plate([[0.17, 1.83, 0.38], [0.31, 1.77, 0.33], [0.315, 1.94, 0.29]], 0.042),
            0.03,
        ),
    ]
}

fn face() -> Vec<Part> {
    vec![
        part("chin", egg([0.0, 1.345, 0.575], [0.075, 0.06, 0.08], 0.0), 0.04),
        twins("muzzle", egg([0.083, 1.415, 0.60], [0.105, 0.082, 0.105], 0.0), 0.035),
        part("bridge", path(&[[0.0, 1.66, 0.54, 0.08], [0.0, 1.50, 0.645, 0.05]]), 0.08),
        carve("eye socket", path(&[[0.13, 1.553, 0.66, 0.077], [0.235, 1.592, 0.635, 0.08]]), 0.04),
        twins("eye", path(&[[0.148, 1.564, 0.543, 0.073], [0.207, 1.583, 0.52, 0.071]]), 0.01),
        part("nose", egg([0.0, 1.485, 0.685], [0.055, 0.035, 0.035], 0.0), 0.02),
    ]
}

fn toes() -> Vec<Part> {
    // upright cuts from the front, on either side of the middle toes
    let cleft =
        |x: f64, z: f64| plate([[x, -0.1, z], [x, 0.16, z - 0.04], [x, 0.2, z + 0.2]], 0.012);
    vec![
        carve("inner fore cleft", cleft(0.121, 0.575), 0.02),
        carve("outer fore cleft", cleft(0.189, 0.575), 0.02),
        carve("inner hind cleft", cleft(0.378, 0.461), 0.02),
        carve("outer hind cleft", cleft(0.442, 0.461), 0.02),
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
