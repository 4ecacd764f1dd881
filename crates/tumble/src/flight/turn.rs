//! Small rotations without loss of digits.

use glam::DVec3;

/// A unit quaternion minus the identity, so that a small rotation keeps all its digits.
#[derive(Clone, Copy, Debug)]
pub struct RotationDelta {
    /// Scalar part minus 1.
    pub scalar: f64,
    /// Vector part.
    pub vector: DVec3,
}

impl RotationDelta {
    /// No rotation.
    pub(super) const NONE: Self = Self { scalar: 0.0, vector: DVec3::ZERO };

    /// The rotation by `angle` (rad) about a unit `axis`.
    pub(super) fn about(axis: DVec3, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(0.5 * angle);
        // cos − 1 without cancellation where the angle is small
        let scalar = if cos > 0.5 { -sin * sin / (1.0 + cos) } else { cos - 1.0 };
        Self { scalar, vector: axis * sin }
    }

    /// The product of two rotations: `first`, then this one.
    pub(super) fn after(self, first: Self) -> Self {
        let (a, b) = (self, first);
        Self {
            scalar: a.scalar + b.scalar + a.scalar * b.scalar - a.vector.dot(b.vector),
            vector: a.vector
                + b.vector
                + a.scalar * b.vector
                + b.scalar * a.vector
                + a.vector.cross(b.vector),
        }
    }
}
