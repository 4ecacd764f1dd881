//! The sitting cat as a list of parts.
//!
//! Lengths are in model units. The ground is y = 0, the ears end near y = 2, and the cat faces +z.

use crate::solid::{Operation, Part, Shape, Solid};
use glam::{DMat3, DVec3};

/// The solid. Parts apply in order, from the trunk outwards.
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

/// Target edge length on the trunk.
const TRUNK_SPACING: f64 = 0.057;

/// Regions of finer mesh: centre, radius, and target edge length within the radius.
const FINE_REGIONS: [([f64; 3], f64, f64); 4] = [
    ([0.0, 1.50, 0.55], 0.30, 0.029),
    ([0.25, 1.85, 0.25], 0.25, 0.040),
    ([0.155, 0.05, 0.56], 0.10, 0.027),
    ([0.41, 0.06, 0.45], 0.10, 0.027),
];

/// Target edge length at a point: shorter on the face, the ears and the paws than on the trunk.
pub fn spacing(point: DVec3) -> f64 {
    // regions are symmetric in x
    let mirrored = DVec3::new(libm::fabs(point.x), point.y, point.z);
    FINE_REGIONS.iter().fold(TRUNK_SPACING, |spacing, &(centre, radius, fine)| {
        // grade the length by 1/8 of the distance, so that neighbouring edges differ little
        let distance = (mirrored.distance(centre.into()) - radius).max(0.0);
        spacing.min(fine + distance / 8.0)
    })
}

fn trunk() -> Vec<Part> {
    vec![
        part("rump", ellipsoid([0.0, 0.36, -0.30], [0.40, 0.42, 0.42], 0.0), 0.1),
        part("belly", ellipsoid([0.0, 0.60, -0.10], [0.36, 0.52, 0.36], -22.0), 0.25),
        part("chest", ellipsoid([0.0, 0.92, 0.14], [0.30, 0.36, 0.27], -10.0), 0.25),
        part("neck", path(&[[0.0, 1.05, 0.10, 0.25], [0.0, 1.40, 0.22, 0.22]]), 0.20),
        part("ruff", ellipsoid([0.0, 1.10, 0.25], [0.22, 0.24, 0.19], 0.0), 0.15),
    ]
}

fn hind_legs() -> Vec<Part> {
    vec![
        mirrored_pair("thigh", ellipsoid([0.34, 0.34, -0.08], [0.17, 0.34, 0.36], -12.0), 0.08),
        mirrored_pair(
            "hind foot",
            path(&[[0.40, 0.06, 0.0, 0.085], [0.41, 0.05, 0.34, 0.075]]),
            0.05,
        ),
        mirrored_pair("hind toes", ellipsoid([0.41, 0.055, 0.36], [0.095, 0.08, 0.12], 0.0), 0.04),
    ]
}

fn forelegs() -> Vec<Part> {
    vec![
        mirrored_pair("shoulder", ellipsoid([0.21, 0.84, 0.16], [0.12, 0.27, 0.18], -6.0), 0.12),
        mirrored_pair(
            "foreleg",
            path(&[
                [0.18, 0.78, 0.26, 0.12],
                [0.155, 0.40, 0.35, 0.092],
                [0.15, 0.08, 0.38, 0.082],
            ]),
            0.09,
        ),
        mirrored_pair(
            "fore paw",
            ellipsoid([0.155, 0.055, 0.45], [0.105, 0.085, 0.145], 0.0),
            0.04,
        ),
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
    part("tail", spline(&knots), 0.09)
}

fn head() -> Vec<Part> {
    vec![
        part("skull", ellipsoid([0.0, 1.54, 0.30], [0.38, 0.31, 0.33], 0.0), 0.12),
        mirrored_pair("cheek", ellipsoid([0.21, 1.43, 0.37], [0.19, 0.15, 0.18], 0.0), 0.12),
    ]
}

fn ears() -> Vec<Part> {
    vec![
        mirrored_pair(
            "ear back",
            path(&[[0.22, 1.70, 0.20, 0.13], [0.325, 2.02, 0.21, 0.03]]),
            0.08,
        ),
        mirrored_pair(
            "ear",
            plate([[0.09, 1.77, 0.30], [0.315, 1.68, 0.20], [0.335, 2.05, 0.23]], 0.032),
            0.06,
        ),
        carved_pair(
            "ear cup",
            plate([[0.17, 1.83, 0.38], [0.31, 1.77, 0.33], [0.315, 1.94, 0.29]], 0.042),
            0.03,
        ),
    ]
}

fn face() -> Vec<Part> {
    vec![
        part("chin", ellipsoid([0.0, 1.345, 0.575], [0.075, 0.06, 0.08], 0.0), 0.04),
        mirrored_pair("muzzle", ellipsoid([0.083, 1.415, 0.60], [0.105, 0.082, 0.105], 0.0), 0.035),
        part("bridge", path(&[[0.0, 1.66, 0.54, 0.08], [0.0, 1.50, 0.645, 0.05]]), 0.08),
        carved_pair(
            "eye socket",
            path(&[[0.13, 1.553, 0.66, 0.077], [0.235, 1.592, 0.635, 0.08]]),
            0.04,
        ),
        mirrored_pair(
            "eye",
            path(&[[0.148, 1.564, 0.543, 0.073], [0.207, 1.583, 0.52, 0.071]]),
            0.01,
        ),
        part("nose", ellipsoid([0.0, 1.485, 0.685], [0.055, 0.035, 0.035], 0.0), 0.02),
    ]
}

fn toes() -> Vec<Part> {
    // vertical cuts on either side of the middle toes
    let cleft =
        |x: f64, z: f64| plate([[x, -0.1, z], [x, 0.16, z - 0.04], [x, 0.2, z + 0.2]], 0.012);
    vec![
        carved_pair("inner fore cleft", cleft(0.121, 0.575), 0.02),
        carved_pair("outer fore cleft", cleft(0.189, 0.575), 0.02),
        carved_pair("inner hind cleft", cleft(0.378, 0.461), 0.02),
        carved_pair("outer hind cleft", cleft(0.442, 0.461), 0.02),
    ]
}

/// A part that is not mirrored.
fn part(name: &'static str, shape: Shape, blend: f64) -> Part {
    Part { name, shape, operation: Operation::Union, blend, mirrored: false }
}

/// A part at +x and its mirror image at −x.
fn mirrored_pair(name: &'static str, shape: Shape, blend: f64) -> Part {
    Part { mirrored: true, ..part(name, shape, blend) }
}

/// A part at +x and its mirror image at −x, both subtracted.
fn carved_pair(name: &'static str, shape: Shape, blend: f64) -> Part {
    Part { operation: Operation::Difference, ..mirrored_pair(name, shape, blend) }
}

/// An ellipsoid; a positive `pitch` (degrees) tilts its top forwards.
fn ellipsoid(centre: [f64; 3], radii: [f64; 3], pitch: f64) -> Shape {
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

/// A chain of round cones through knots `[x, y, z, radius]`.
fn path(knots: &[[f64; 4]]) -> Shape {
    Shape::Path(knots.iter().map(|&[x, y, z, radius]| (DVec3::new(x, y, z), radius)).collect())
}

/// A chain of round cones along the Catmull-Rom spline through knots `[x, y, z, radius]`.
fn spline(knots: &[[f64; 4]]) -> Shape {
    let knot = |i: usize| knots[i.clamp(1, knots.len()) - 1];
    let mut samples = vec![];
    for span in 1..knots.len() {
        let [p, q, r, s] = [knot(span - 1), knot(span), knot(span + 1), knot(span + 2)];
        for step in 0..6 {
            let t = f64::from(step) / 6.0;
            samples.push([0, 1, 2, 3].map(|i| {
                let quadratic = 2.0 * p[i] - 5.0 * q[i] + 4.0 * r[i] - s[i];
                let cubic = 3.0 * (q[i] - r[i]) + s[i] - p[i];
                q[i] + 0.5 * t * (r[i] - p[i] + t * (quadratic + t * cubic))
            }));
        }
    }
    samples.push(knots[knots.len() - 1]);
    path(&samples)
}

/// A triangular plate with a rounded rim of the given radius.
fn plate(corners: [[f64; 3]; 3], radius: f64) -> Shape {
    Shape::Plate { corners: corners.map(DVec3::from_array), radius }
}
