//! Vectors in eight SIMD lanes, with results that do not depend on the SIMD width of the processor.
//!
//! Sums over particles use eight lanes, which are added at the end in a fixed order. Multiplications and additions
//! are not fused.

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*};
use glam::{DMat3, DVec3};

/// The number of lanes.
pub(crate) const LANES: usize = 8;

/// Eight vectors in memory, as arrays of coordinates.
pub(crate) type Columns = [[f64; LANES]; 3];

/// The vector in one lane.
#[inline(always)]
pub(crate) fn vector(columns: &Columns, lane: usize) -> DVec3 {
    DVec3::new(columns[0][lane], columns[1][lane], columns[2][lane])
}

/// Sets the vector in one lane.
#[inline(always)]
pub(crate) fn set(columns: &mut Columns, lane: usize, v: DVec3) {
    for (column, value) in columns.iter_mut().zip(v.to_array()) {
        column[lane] = value;
    }
}

/// Eight vectors in SIMD registers.
#[derive(Clone, Copy)]
pub(crate) struct Vec3x8<S: Simd> {
    pub x: f64x8<S>,
    pub y: f64x8<S>,
    pub z: f64x8<S>,
}

impl<S: Simd> Vec3x8<S> {
    /// The same vector in each lane.
    #[inline(always)]
    pub fn splat(simd: S, v: DVec3) -> Self {
        Self { x: f64x8::splat(simd, v.x), y: f64x8::splat(simd, v.y), z: f64x8::splat(simd, v.z) }
    }

    /// Loads eight vectors from memory.
    #[inline(always)]
    pub fn load(simd: S, columns: &Columns) -> Self {
        let [x, y, z] = columns;
        Self {
            x: f64x8::simd_from(simd, *x),
            y: f64x8::simd_from(simd, *y),
            z: f64x8::simd_from(simd, *z),
        }
    }

    /// Stores eight vectors to memory.
    #[inline(always)]
    pub fn store(self) -> Columns {
        [self.x.into(), self.y.into(), self.z.into()]
    }

    /// A matrix times the vector in each lane.
    #[inline(always)]
    pub fn rotated(self, simd: S, matrix: DMat3) -> Self {
        Self {
            x: self.dot(Self::splat(simd, matrix.row(0))),
            y: self.dot(Self::splat(simd, matrix.row(1))),
            z: self.dot(Self::splat(simd, matrix.row(2))),
        }
    }

    /// a·b in each lane.
    #[inline(always)]
    pub fn dot(self, other: Self) -> f64x8<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// a × b in each lane.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// The component of each vector perpendicular to the unit vector `normal`.
    #[inline(always)]
    pub fn perpendicular_to(self, normal: Self) -> Self {
        self - normal * self.dot(normal)
    }

    /// Each vector divided by a scalar.
    #[inline(always)]
    pub fn divided_by(self, divisor: f64x8<S>) -> Self {
        Self { x: self.x / divisor, y: self.y / divisor, z: self.z / divisor }
    }

    /// `set` in the lanes where `mask` is set, `unset` in the others.
    #[inline(always)]
    pub fn select(mask: mask64x8<S>, set: Self, unset: Self) -> Self {
        Self {
            x: mask.select(set.x, unset.x),
            y: mask.select(set.y, unset.y),
            z: mask.select(set.z, unset.z),
        }
    }

    /// The sum over the lanes.
    #[inline(always)]
    pub fn sum(self) -> DVec3 {
        DVec3::new(sum(self.x), sum(self.y), sum(self.z))
    }
}

impl<S: Simd> std::ops::Add for Vec3x8<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<S: Simd> std::ops::Sub for Vec3x8<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<S: Simd> std::ops::Mul<f64x8<S>> for Vec3x8<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64x8<S>) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<S: Simd> std::ops::AddAssign for Vec3x8<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// The sum over the lanes, in order.
#[inline(always)]
pub(crate) fn sum<S: Simd>(lanes: f64x8<S>) -> f64 {
    <[f64; LANES]>::from(lanes).iter().sum()
}

/// The largest lane or zero, whichever is larger. No lane may be NaN.
#[inline(always)]
pub(crate) fn largest<S: Simd>(lanes: f64x8<S>) -> f64 {
    <[f64; LANES]>::from(lanes).iter().fold(0.0, |m: f64, &lane| m.max(lane))
}

/// Each lane if positive, else zero.
#[inline(always)]
pub(crate) fn positive<S: Simd>(simd: S, lanes: f64x8<S>) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    lanes.simd_gt(zero).select(lanes, zero)
}

/// The SIMD levels that this processor supports, the widest first.
#[cfg(test)]
pub(crate) fn levels() -> Vec<fearless_simd::Level> {
    use fearless_simd::Level;
    let best = Level::new();
    #[cfg(target_arch = "x86_64")]
    let narrower = [best.as_avx2().map(Level::Avx2), best.as_sse4_2().map(Level::Sse4_2)];
    #[cfg(not(target_arch = "x86_64"))]
    let narrower = [None; 2];
    [Some(best)].into_iter().chain(narrower).flatten().chain([Level::baseline()]).collect()
}
