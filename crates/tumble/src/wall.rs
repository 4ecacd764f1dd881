//! Walls: planes and boxes of planes.

use glam::{DMat3, DQuat, DVec3};

/// A plane that is solid where n·x < d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallPlane {
    /// Unit normal n, pointing out of the wall into the free side.
    pub normal: DVec3,
    /// Offset d (m): the plane is {x : n·x = d}.
    pub offset: f64,
}

impl WallPlane {
    /// The plane {x : normal·x = offset}, solid where normal·x < offset.
    ///
    /// `normal` need not be normalised: both arguments are divided by its length. `None` if it is zero or not
    /// finite.
    pub fn new(normal: DVec3, offset: f64) -> Option<Self> {
        // scaled by the largest component first, to avoid overflow and underflow
        let largest = normal.abs().max_element();
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        let scaled = normal / largest;
        let length = scaled.length();
        let offset = offset / largest / length;
        offset.is_finite().then_some(Self { normal: scaled / length, offset })
    }

    /// Depth of a point behind the wall (m); negative in the free half-space.
    pub fn depth(&self, point: DVec3) -> f64 {
        self.offset - self.normal.dot(point)
    }
}

/// A box of up to six walls that face inwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallBox {
    /// Lowest corner, in the box's own axes (m).
    pub min: DVec3,
    /// Highest corner, in the box's own axes (m).
    pub max: DVec3,
    /// The rotation about the origin from the box's own axes to world axes.
    pub orientation: DQuat,
    /// Whether a face is missing, in the order −x, +x, −y, +y, −z, +z.
    pub open: [bool; 6],
}

impl WallBox {
    /// The names of the faces, in the order of [`WallBox::open`].
    pub const FACES: [&'static str; 6] = ["-x", "+x", "-y", "+y", "-z", "+z"];

    /// The arena of the basic system: a floor at y = −1, sides at x = ±1 and z = ±1, open at the top.
    pub fn arena() -> Self {
        Self {
            min: DVec3::NEG_ONE,
            max: DVec3::ONE,
            orientation: DQuat::IDENTITY,
            open: [false, false, false, true, false, false],
        }
    }

    /// The walls of the box, in the order of [`WallBox::open`].
    pub fn planes(&self) -> Vec<WallPlane> {
        let turn = DMat3::from_quat(self.orientation);
        (0..6)
            .filter(|&face| !self.open[face])
            .map(|face| {
                let axis = face / 2;
                let outward = turn.col(axis);
                // the low face is solid below min, the high face above max
                if face % 2 == 0 {
                    WallPlane { normal: outward, offset: self.min[axis] }
                } else {
                    WallPlane { normal: -outward, offset: -self.max[axis] }
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arena_has_a_floor_and_four_sides() {
        let planes = WallBox::arena().planes();
        assert_eq!(planes.len(), 5);
        let inside = DVec3::new(0.2, 40.0, -0.3);
        assert!(planes.iter().all(|p| p.depth(inside) < 0.0));
        let below = DVec3::new(0.0, -1.25, 0.0);
        let depths: Vec<_> = planes.iter().map(|p| p.depth(below)).filter(|&d| d > 0.0).collect();
        assert_eq!(depths, [0.25]);
    }

    #[test]
    fn the_length_of_the_normal_does_not_matter() {
        for length in [1e-200, 0.5, 3.0, 1e200] {
            let plane = WallPlane::new(DVec3::new(0.0, 3.0, 4.0) * length, 5.0 * length).unwrap();
            assert!((plane.normal - DVec3::new(0.0, 0.6, 0.8)).length() < 1e-15);
            assert!((plane.offset - 1.0).abs() < 1e-15);
        }
        assert_eq!(WallPlane::new(DVec3::ZERO, 0.0), None);
        assert_eq!(WallPlane::new(DVec3::NAN, 0.0), None);
        assert_eq!(WallPlane::new(DVec3::X, f64::INFINITY), None);
    }
}
