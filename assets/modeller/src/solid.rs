//! Implicit solids: round primitives, joined and carved with soft seams.
//!
//! A field is negative inside, positive outside and zero on the surface. It is a signed distance
//! only roughly (ellipsoids and blends bend it), which is enough: whoever walks to the surface
//! takes Newton steps along the gradient.

use glam::{DMat3, DVec3};

/// One primitive.
pub enum Shape {
    /// centre, radii, and the rotation from the model's axes to the ellipsoid's own
    Ellipsoid { centre: DVec3, radii: DVec3, to_local: DMat3 },
    /// a path of (point, radius) pairs swept by a ball; two pairs make a round cone
    Path(Vec<(DVec3, f64)>),
    /// a triangular plate with a rounded rim
    Plate { corners: [DVec3; 3], radius: f64 },
}

/// What a part does to the parts before it.
#[derive(Clone, Copy, PartialEq)]
pub enum Act {
    /// adds material
    Join,
    /// takes material away
    Carve,
}

/// A named primitive with the way it meets the rest.
pub struct Part {
    /// for the reader of the table and of the written file
    pub name: &'static str,
    /// the primitive
    pub shape: Shape,
    /// join or carve
    pub act: Act,
    /// width of the soft seam to what came before
    pub blend: f64,
    /// whether the part has a twin at −x
    pub mirrored: bool,
}

/// A list of parts, applied in order, standing on the ground plane y = 0.
pub struct Solid {
    /// in the order in which they are joined or carved
    pub parts: Vec<Part>,
    /// width of the rounding where the solid meets the ground
    pub ground_blend: f64,
}

impl Solid {
    /// The field at `point`: negative inside.
    pub fn field(&self, point: DVec3) -> f64 {
        let twin = DVec3::new(-point.x, point.y, point.z);
        // far outside until the first part joins
        let mut value = 1e3;
        for part in &self.parts {
            value = part.apply(value, point);
            if part.mirrored {
                value = part.apply(value, twin);
            }
        }
        // the ground cuts a flat seat
        soft_max(value, -point.y, self.ground_blend)
    }

    /// The gradient of the field at `point`, from differences over a small tetrahedron.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        const ARMS: [DVec3; 4] = [
            DVec3::new(1.0, -1.0, -1.0),
            DVec3::new(-1.0, 1.0, -1.0),
            DVec3::new(-1.0, -1.0, 1.0),
            DVec3::new(1.0, 1.0, 1.0),
        ];
        let h = 1e-5;
        ARMS.iter().map(|&arm| self.field(point + h * arm) * arm).sum::<DVec3>() / (4.0 * h)
    }

    /// The surface point that Newton steps along the gradient lead to.
    pub fn project(&self, start: DVec3) -> DVec3 {
        let mut point = start;
        for _ in 0..8 {
            let value = self.field(point);
            if libm::fabs(value) < 1e-9 {
                break;
            }
            // a step longer than a cell would jump to another limb
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
        match self.act {
            Act::Join => soft_min(value, distance, self.blend),
            Act::Carve => soft_max(value, -distance, self.blend),
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

/// The smaller of two fields, with a round fillet of width `blend` where they are close
/// (the polynomial smooth minimum of Quilez).
pub fn soft_min(a: f64, b: f64, blend: f64) -> f64 {
    let overlap = (blend - libm::fabs(a - b)).max(0.0);
    a.min(b) - overlap * overlap / (4.0 * blend)
}

/// The larger of two fields, with a round edge of width `blend`.
pub fn soft_max(a: f64, b: f64, blend: f64) -> f64 {
    -soft_min(-a, -b, blend)
}

/// First-order distance to an axis-aligned ellipsoid at the origin.
fn ellipsoid_distance(point: DVec3, radii: DVec3) -> f64 {
    let scaled = (point / radii).length();
    let slope = (point / (radii * radii)).length();
    if slope < 1e-12 { -radii.min_element() } else { scaled * (scaled - 1.0) / slope }
}

/// Distance to a ball whose radius and centre slide from one knot to the next.
fn cone_distance(point: DVec3, from: (DVec3, f64), to: (DVec3, f64)) -> f64 {
    let axis = to.0 - from.0;
    let along = ((point - from.0).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    (point - from.0 - along * axis).length() - (from.1 + along * (to.1 - from.1))
}

/// Distance to a flat triangle.
fn triangle_distance(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let beyond = |from: DVec3, to: DVec3| (to - from).cross(normal).dot(point - from) > 0.0;
    if beyond(a, b) || beyond(b, c) || beyond(c, a) {
        let edge = |from, to| cone_distance(point, (from, 0.0), (to, 0.0));
        edge(a, b).min(edge(b, c)).min(edge(c, a))
    } else {
        libm::fabs(normal.dot(point - a)) / normal.length()
    }
}
