//! A triangle in its own frame, and four of them side by side.
//!
//! In the frame of a triangle, corner a is the origin, the longest side ab the first axis and the normal the
//! third, so that the distance to it is a distance in the plane and a height. The squared distance is the same
//! to the last bit whether one triangle is asked or four at once, and so depends on nothing but point and triangle.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;

/// Triangles side by side.
pub(super) const WIDTH: usize = 4;

/// The face, the side after corner k (1 + k), corner k (4 + k): what of a triangle is closest to a point.
pub(super) type Feature = usize;
/// The face.
pub(super) const FACE: Feature = 0;
/// The first of the sides ab, bc, ca.
pub(super) const SIDE: Feature = 1;
/// The first of the corners a, b, c.
pub(super) const CORNER: Feature = 4;

/// Triangles lower than this part of their length get a normal from their frame, not the frame from the normal.
const STOUT: f64 = 0.01;

/// A triangle in its own frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Corner a (m).
    pub origin: DVec3,
    /// Unit vector from a to b.
    pub along: DVec3,
    /// Unit vector in the plane, across ab, to the side of c.
    pub across: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Length of ab, the longest side (m).
    pub length: f64,
    /// Corner c along and across ab (m).
    pub apex: [f64; 2],
    /// 1/|ac|² and 1/|bc|² (m⁻²).
    inverse: [f64; 2],
}

/// The closest point of a triangle, seen from a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    /// What it lies on.
    pub feature: Feature,
    /// From it to the point, along, across and normal (m).
    pub offset: DVec3,
    /// The squared distance (m²).
    pub squared: f64,
}

/// The unit vector of any vector that is not zero, however small.
fn direction(v: DVec3) -> DVec3 {
    let size = v.abs().max_element();
    if size == 0.0 {
        return DVec3::ZERO;
    }
    // divided, not multiplied by the inverse: what is along an axis stays so to the bit
    let v = v / size;
    v / v.length()
}

impl Frame {
    /// Which corner comes first: the one that the longest side starts from.
    pub fn first_corner(corners: [DVec3; 3]) -> usize {
        let length = |k: usize| (corners[(k + 1) % 3] - corners[k]).length_squared();
        (1..3).fold(0, |best, k| if length(k) > length(best) { k } else { best })
    }

    /// The frame of a triangle whose longest side is from the first to the second corner.
    pub fn of([a, b, c]: [DVec3; 3]) -> Self {
        let along = direction(b - a);
        let side = c - a;
        // made orthogonal twice: once leaves the rounding of a long thin triangle
        let once = direction(side - along * along.dot(side));
        let twice = direction(once - along * along.dot(once));
        let across = if twice == DVec3::ZERO { along.any_orthonormal_vector() } else { twice };
        // in a plane of two axes the product of two sides is exact, that of two unit vectors is not
        let normal = direction((b - a).cross(side));
        let is_thin = along.cross(side).length() < STOUT * along.dot(b - a);
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

    /// The triangle's area (m²).
    pub fn area(&self) -> f64 {
        0.5 * self.length * self.apex[1]
    }

    /// The corners (m), to rounding.
    pub fn corners(&self) -> [DVec3; 3] {
        let b = self.origin + self.along * self.length;
        let c = self.origin + self.along * self.apex[0] + self.across * self.apex[1];
        [self.origin, b, c]
    }

    /// A point seen in the frame (m).
    #[inline(always)]
    pub fn local(&self, point: DVec3) -> DVec3 {
        self.turned(point - self.origin)
    }

    /// A vector seen in the frame.
    #[inline(always)]
    pub fn turned(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.along), v.dot(self.across), v.dot(self.normal))
    }

    /// A vector of the frame seen from outside.
    #[inline(always)]
    pub fn turned_back(&self, v: DVec3) -> DVec3 {
        self.along * v.x + self.across * v.y + self.normal * v.z
    }

    /// Whether a point of the plane lies in the triangle, or out of it by no more than `slack` (m).
    #[inline(always)]
    pub fn covers(&self, x: f64, y: f64, slack: f64) -> bool {
        let [cx, cy] = self.apex;
        // sides are at most as long as ab
        let slack_area = slack * self.length;
        y >= -slack
            && x * cy - y * cx >= -slack_area
            && (cx - self.length) * y - cy * (x - self.length) >= -slack_area
    }

    /// The closest point, with the arithmetic of [`Group::squared`].
    #[inline(always)]
    pub fn foot(&self, point: DVec3) -> Foot {
        let p = self.local(point);
        let [cx, cy] = self.apex;
        let (bx, px) = (cx - self.length, p.x - self.length);
        let height = p.z * p.z;
        let inside = p.y > 0.0 && p.x * cy - p.y * cx > 0.0 && bx * p.y - cy * px > 0.0;
        if inside {
            return Foot { feature: FACE, offset: DVec3::new(0.0, 0.0, p.z), squared: height };
        }
        // the foot on each side: how far along, and from it to the point
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
                    0.0 => CORNER + side,
                    1.0 => CORNER + (side + 1) % 3,
                    _ => SIDE + side,
                };
                best = (squared, feature, DVec3::new(x, y, p.z));
            }
        }
        Foot { feature: best.1, offset: best.2, squared: best.0 + height }
    }

    /// The solid angle of the triangle seen from a point, positive from behind.
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

/// Four triangles side by side; where there are fewer, the first fills up.
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
    /// The group of one to four triangles with their indices.
    pub fn of(members: &[(u32, Frame)]) -> Self {
        let lanes: [(u32, Frame); WIDTH] =
            std::array::from_fn(|i| *members.get(i).unwrap_or(&members[0]));
        let number = |of: &dyn Fn(&Frame) -> f64| std::array::from_fn(|i| of(&lanes[i].1));
        let vector = |of: &dyn Fn(&Frame) -> DVec3| {
            std::array::from_fn(|axis| std::array::from_fn(|i| of(&lanes[i].1)[axis]))
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

        // into the frame
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

        // to each side, and whether the face is closer
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
