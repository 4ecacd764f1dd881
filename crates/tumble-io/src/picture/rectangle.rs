//! A flat rectangle in space.

use glam::DVec3;

/// Position, axes and size of a floor or wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    /// Centre (m).
    pub centre: DVec3,
    /// Unit vector along the first side.
    pub u: DVec3,
    /// Unit vector along the second side.
    pub v: DVec3,
    /// Unit normal towards the bodies.
    pub normal: DVec3,
    /// Half lengths of the sides along `u` and `v` (m).
    pub half: [f64; 2],
}
