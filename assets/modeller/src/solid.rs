//! Implicit solids: smooth unions and differences of rounded primitives.
//!
//! The field is negative inside, positive outside and zero on the surface. It only approximates a signed distance,
//! because ellipsoids and smooth blends distort it. This suffices: points are projected onto the surface by Newton steps
//! along the gradient.

use glam::{DMat3, DVec3};

/// A primitive.
pub enum Shape {
    /// An ellipsoid; `to_local` rotates from the model's axes to its own.
    Ellipsoid { centre: DVec3, radii: DVec3, to_local: DMat3 },
    /// A chain of round cones through (point, radius) pairs.
    Path(Vec<(DVec3, f64)>),
    /// A triangular plate with a rounded rim.
    Plate { corners: [DVec3; 3], radius: f64 },
}

/// The Boolean operation that combines a part with the parts before it.
#[derive(Clone, Copy, PartialEq)]
pub enum Operation {
    /// Adds material.
    Union,
    /// Removes material.
    Difference,
}

/// A named primitive and how it combines with the parts before it.
pub struct Part {
    /// Name, also listed in the header of the file.
    pub name: &'static str,
    /// The primitive.
    pub shape: Shape,
    /// Union or difference.
    pub operation: Operation,
    /// Width of the smooth blend with the parts before it.
    pub blend: f64,
    /// Whether the part also has a mirror image at −x.
    pub mirrored: bool,
}

/// A solid on the ground plane y = 0.
pub struct Solid {
    /// The parts, in the order in which they apply.
    pub parts: Vec<Part>,
    /// Width of the rounded edge at the ground.
    pub ground_blend: f64,
}

impl Solid {
    /// The field at `point`.
    pub fn field(&self, point: DVec3) -> f64 {
        let mirrored = DVec3::new(-point.x, point.y, point.z);
        // far outside before the first part
        let mut value = 1e3;
        for part in &self.parts {
            value = part.apply(value, point);
            if part.mirrored {
                value = part.apply(value, mirrored);
            }
        }
        // cut the solid flat at the ground
        smooth_max(value, -point.y, self.ground_blend)
    }

    /// The gradient of the field at `point`, by finite differences over a small tetrahedron.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        const DIRECTIONS: [DVec3; 4] = [
            DVec3::new(1.0, -1.0, -1.0),
            DVec3::new(-1.0, 1.0, -1.0),
            DVec3::new(-1.0, -1.0, 1.0),
            DVec3::new(1.0, 1.0, 1.0),
        ];
        let h = 1e-5;
        DIRECTIONS.iter().map(|&d| self.field(point + h * d) * d).sum::<DVec3>() / (4.0 * h)
    }

    /// Projects a point onto the surface by Newton steps along the gradient.
    pub fn project(&self, start: DVec3) -> DVec3 {
        let mut point = start;
        for _ in 0..8 {
            let value = self.field(point);
            if libm::fabs(value) < 1e-9 {
                break;
            }
            // a step longer than a grid cell could reach another part of the body
            let gradient = self.gradient(point);
            let step = -value / gradient.length_squared().max(1e-6) * gradient;
            point += step.clamp_length_max(0.03);
        }
        point
    }
}

impl Part {
    fn apply(&self, value: f64, point: DVec3) -> f64 {
        let distance = self.shape.distance(point);
        match self.operation {
            Operation::Union => smooth_min(value, distance, self.blend),
            Operation::Difference => smooth_max(value, -distance, self.blend),
        }
    }
}

impl Shape {
    fn distance(&self, point: DVec3) -> f64 {
        match self {
            Shape::Ellipsoid { centre, radii, to_local } => {
                ellipsoid_distance(*to_local * (point - *centre), *radii)
            }
            Shape::Path(knots) => knots
                .windows(2)
                .map(|pair| cone_distance(point, pair[0], pair[1]))
                .fold(f64::INFINITY, f64::min),
            Shape::Plate { corners, radius } => triangle_distance(point, *corners) - radius,
        }
    }
}

/// Smooth minimum of two fields with a fillet of width `blend` (Quilez, polynomial smooth minimum).
pub fn smooth_min(a: f64, b: f64, blend: f64) -> f64 {
    let overlap = (blend - libm::fabs(a - b)).max(0.0);
    a.min(b) - overlap * overlap / (4.0 * blend)
}

/// Smooth maximum of two fields with a rounded edge of width `blend`.
pub fn smooth_max(a: f64, b: f64, blend: f64) -> f64 {
    -smooth_min(-a, -b, blend)
}

/// First-order approximation of the signed distance to an axis-aligned ellipsoid at the origin.
fn ellipsoid_distance(point: DVec3, radii: DVec3) -> f64 {
    let scaled = (point / radii).length();
    let slope = (point / (radii * radii)).length();
    if slope < 1e-12 { -radii.min_element() } else { scaled * (scaled - 1.0) / slope }
}

/// Approximate signed distance to a round cone, whose radius varies linearly from one end to the other.
fn cone_distance(point: DVec3, from: (DVec3, f64), to: (DVec3, f64)) -> f64 {
    let axis = to.0 - from.0;
    let fraction = ((point - from.0).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    (point - from.0 - fraction * axis).length() - (from.1 + fraction * (to.1 - from.1))
}

/// Distance to a triangle.
fn triangle_distance(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let outside = |from: DVec3, to: DVec3| (to - from).cross(normal).dot(point - from) > 0.0;
    if outside(a, b) || outside(b, c) || outside(c, a) {
        let edge_distance = |from, to| cone_distance(point, (from, 0.0), (to, 0.0));
        edge_distance(a, b).min(edge_distance(b, c)).min(edge_distance(c, a))
    } else {
        libm::fabs(normal.dot(point - a)) / normal.length()
    }
}
