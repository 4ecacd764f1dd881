//! A triangle in its local frame, and groups of four triangles for SIMD.
//!
//! In the local frame, vertex a is the origin, the longest edge ab the first axis and the normal the third. The
//! distance to the triangle then separates into a distance in the plane and a height. Scalar and SIMD code compute
//! squared distances with the same arithmetic, so that the result depends on point and triangle only.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;

/// Triangles per group.
pub(super) const WIDTH: usize = 4;

/// A feature of a triangle: the face, the edge after vertex k (1 + k), or vertex k (4 + k).
pub(super) type Feature = usize;
/// The face.
pub(super) const FACE: Feature = 0;
/// The first of the edges ab, bc, ca.
pub(super) const EDGE: Feature = 1;
/// The first of the vertices a, b, c.
pub(super) const VERTEX: Feature = 4;

/// The ratio of height to longest edge below which the normal is computed from the in-plane axes, not the other way
/// round.
const THIN: f64 = 0.01;

/// A triangle with its local frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Vertex a (m).
    pub origin: DVec3,
    /// Unit vector from a to b.
    pub along: DVec3,
    /// Unit vector in the plane, perpendicular to ab, towards c.
    pub across: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Length of ab, the longest edge (m).
    pub length: f64,
    /// Coordinates of vertex c along and across ab (m).
    pub apex: [f64; 2],
    /// 1/|ac|² and 1/|bc|² (m⁻²).
    inverse: [f64; 2],
}

/// The point of a triangle closest to a query point.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClosestPoint {
    /// The feature on which it lies.
    pub feature: Feature,
    /// The vector from it to the query point, in the local frame (m).
    pub offset: DVec3,
    /// The squared distance (m²).
    pub squared: f64,
}

/// The unit vector along a vector, without underflow; zero for the zero vector.
fn direction(v: DVec3) -> DVec3 {
    let size = v.abs().max_element();
    if size == 0.0 {
        return DVec3::ZERO;
    }
    // division, not multiplication by the inverse, keeps vectors along an axis exact
    let v = v / size;
    v / v.length()
}

impl Frame {
    /// The vertex at which the longest edge starts.
    pub fn first_corner(corners: [DVec3; 3]) -> usize {
        let length = |k: usize| (corners[(k + 1) % 3] - corners[k]).length_squared();
        (1..3).fold(0, |best, k| if length(k) > length(best) { k } else { best })
    }

    /// The frame of a triangle whose longest edge runs from the first to the second vertex.
    pub fn new([a, b, c]: [DVec3; 3]) -> Self {
        let along = direction(b - a);
        let side = c - a;
        // orthogonalised twice, because of rounding in long thin triangles
        let once = direction(side - along * along.dot(side));
        let twice = direction(once - along * along.dot(once));
        let across = if twice == DVec3::ZERO { along.any_orthonormal_vector() } else { twice };
        // for triangles in a coordinate plane the product of two edges is exact, that of two unit vectors is not
        let normal = direction((b - a).cross(side));
        let is_thin = along.cross(side).length() < THIN * along.dot(b - a);
        let (across, normal) =
            if is_thin { (across, along.cross(across)) } else { (normal.cross(along), normal) };
        let length = along.dot(b - a);
        let apex = [along.dot(side), across.dot(side)];
        let inverse = [apex[0], apex[0] - length].map(|x| {
            let inverse = 1.0 / (x * x + apex[1] * apex[1]);
            if inverse.is_finite() { inverse } else { 0.0 }
        });
        Self { origin: a, along, across, normal, length, apex, inverse }
    }

    /// The area (m²).
    pub fn area(&self) -> f64 {
        0.5 * self.length * self.apex[1]
    }

    /// The vertices (m), up to rounding.
    pub fn corners(&self) -> [DVec3; 3] {
        let b = self.origin + self.along * self.length;
        let c = self.origin + self.along * self.apex[0] + self.across * self.apex[1];
        [self.origin, b, c]
    }

    /// The local coordinates of a point (m).
    #[inline(always)]
    pub fn local(&self, point: DVec3) -> DVec3 {
        self.local_vector(point - self.origin)
    }

    /// A vector transformed to the local frame.
    #[inline(always)]
    fn local_vector(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.along), v.dot(self.across), v.dot(self.normal))
    }

    /// A vector transformed from the local frame.
    #[inline(always)]
    pub fn world_vector(&self, v: DVec3) -> DVec3 {
        self.along * v.x + self.across * v.y + self.normal * v.z
    }

    /// Whether a point of the plane is in the triangle, or outside by at most `slack` (m).
    #[inline(always)]
    pub fn covers(&self, x: f64, y: f64, slack: f64) -> bool {
        let [cx, cy] = self.apex;
        // no edge is longer than ab
        let slack_area = slack * self.length;
        y >= -slack
            && x * cy - y * cx >= -slack_area
            && (cx - self.length) * y - cy * (x - self.length) >= -slack_area
    }

    /// The closest point, with the arithmetic of [`Group::squared`].
    #[inline(always)]
    pub fn closest_point(&self, point: DVec3) -> ClosestPoint {
        let p = self.local(point);
        let [cx, cy] = self.apex;
        let (bx, px) = (cx - self.length, p.x - self.length);
        let height = p.z * p.z;
        let inside = p.y > 0.0 && p.x * cy - p.y * cx > 0.0 && bx * p.y - cy * px > 0.0;
        if inside {
            let offset = DVec3::new(0.0, 0.0, p.z);
            return ClosestPoint { feature: FACE, offset, squared: height };
        }
        // the closest point of each edge: its parameter, and the offset from it
        let ab = p.x.max(0.0).min(self.length);
        let ca = ((p.x * cx + p.y * cy) * self.inverse[0]).clamp(0.0, 1.0);
        let bc = ((px * bx + p.y * cy) * self.inverse[1]).clamp(0.0, 1.0);
        let sides = [
            (p.x - ab, p.y, ab / self.length, 0),
            (px - bc * bx, p.y - bc * cy, bc, 1),
            (p.x - ca * cx, p.y - ca * cy, 1.0 - ca, 2),
        ];
        let mut best = (f64::INFINITY, 0, DVec3::ZERO);
        for (x, y, along, side) in sides {
            let squared = x * x + y * y;
            if squared < best.0 {
                let feature = match along {
                    0.0 => VERTEX + side,
                    1.0 => VERTEX + (side + 1) % 3,
                    _ => EDGE + side,
                };
                best = (squared, feature, DVec3::new(x, y, p.z));
            }
        }
        ClosestPoint { feature: best.1, offset: best.2, squared: best.0 + height }
    }

    /// The solid angle of the triangle seen from a point, positive on the inner side.
    ///
    /// Source: A. van Oosterom and J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125.
    pub fn solid_angle(&self, point: DVec3) -> f64 {
        let [a, b, c] = self.corners().map(|corner| corner - point);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let across = a.dot(b.cross(c));
        let along = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * libm::atan2(across, along)
    }
}

/// Four triangles in SIMD layout; missing ones repeat the first.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Group {
    origin: [[f64; WIDTH]; 3],
    along: [[f64; WIDTH]; 3],
    across: [[f64; WIDTH]; 3],
    normal: [[f64; WIDTH]; 3],
    length: [f64; WIDTH],
    apex: [[f64; WIDTH]; 2],
    inverse: [[f64; WIDTH]; 2],
    /// The triangles' indices in the mesh.
    pub index: [u32; WIDTH],
}

impl Group {
    /// A group of one to four triangles with their indices.
    pub fn new(members: &[(u32, Frame)]) -> Self {
        let lanes: [(u32, Frame); WIDTH] =
            std::array::from_fn(|i| *members.get(i).unwrap_or(&members[0]));
        let number = |field: &dyn Fn(&Frame) -> f64| std::array::from_fn(|i| field(&lanes[i].1));
        let vector = |field: &dyn Fn(&Frame) -> DVec3| {
            std::array::from_fn(|axis| std::array::from_fn(|i| field(&lanes[i].1)[axis]))
        };
        Self {
            origin: vector(&|t| t.origin),
            along: vector(&|t| t.along),
            across: vector(&|t| t.across),
            normal: vector(&|t| t.normal),
            length: number(&|t| t.length),
            apex: [number(&|t| t.apex[0]), number(&|t| t.apex[1])],
            inverse: [number(&|t| t.inverse[0]), number(&|t| t.inverse[1])],
            index: std::array::from_fn(|i| lanes[i].0),
        }
    }

    /// One of the triangles.
    #[inline(always)]
    pub fn frame(&self, lane: usize) -> Frame {
        let vector = |v: &[[f64; WIDTH]; 3]| DVec3::new(v[0][lane], v[1][lane], v[2][lane]);
        Frame {
            origin: vector(&self.origin),
            along: vector(&self.along),
            across: vector(&self.across),
            normal: vector(&self.normal),
            length: self.length[lane],
            apex: self.apex.map(|x| x[lane]),
            inverse: self.inverse.map(|x| x[lane]),
        }
    }

    /// The squared distances (m²) to a point.
    #[inline(always)]
    pub fn squared<S: Simd>(&self, simd: S, point: [f64x4<S>; 3]) -> [f64; WIDTH] {
        let zero = f64x4::splat(simd, 0.0);
        let one = f64x4::splat(simd, 1.0);

        // local coordinates
        let [x, y, z] = point;
        let away = [
            x - load(simd, &self.origin[0]),
            y - load(simd, &self.origin[1]),
            z - load(simd, &self.origin[2]),
        ];
        let x = dot(simd, away, &self.along);
        let y = dot(simd, away, &self.across);
        let z = dot(simd, away, &self.normal);
        let length = load(simd, &self.length);
        let (cx, cy) = (load(simd, &self.apex[0]), load(simd, &self.apex[1]));
        let (bx, px) = (cx - length, x - length);

        // distance to each edge, and whether the face is closer
        let ab = x.max(zero).min(length);
        let ca = ((x * cx + y * cy) * load(simd, &self.inverse[0])).max(zero).min(one);
        let bc = ((px * bx + y * cy) * load(simd, &self.inverse[1])).max(zero).min(one);
        let to_ab = squared(x - ab, y);
        let to_bc = squared(px - bc * bx, y - bc * cy);
        let to_ca = squared(x - ca * cx, y - ca * cy);
        let inside =
            y.simd_gt(zero) & (x * cy - y * cx).simd_gt(zero) & (bx * y - cy * px).simd_gt(zero);
        let plane = inside.select(zero, to_ab.min(to_bc).min(to_ca));
        (plane + z * z).into()
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, lanes: &[f64; WIDTH]) -> f64x4<S> {
    f64x4::simd_from(simd, *lanes)
}

#[inline(always)]
fn dot<S: Simd>(simd: S, [x, y, z]: [f64x4<S>; 3], axis: &[[f64; WIDTH]; 3]) -> f64x4<S> {
    x * load(simd, &axis[0]) + y * load(simd, &axis[1]) + z * load(simd, &axis[2])
}

#[inline(always)]
fn squared<S: Simd>(x: f64x4<S>, y: f64x4<S>) -> f64x4<S> {
    x * x + y * y
}
