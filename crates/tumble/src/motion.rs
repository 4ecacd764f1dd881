//! Bodies whose motion is given instead of found.

use glam::DVec3;

/// What moves a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Motion {
    /// Forces.
    #[default]
    Free,
    /// Nothing but what is said here: it pushes others and nothing pushes it.
    Prescribed(Prescribed),
}

/// A motion that is given: the body keeps the velocity and the angular velocity that it starts with,
/// about its centre of mass. With neither it is an obstacle that stands still.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// A swing on top of that.
    pub oscillation: Option<Oscillation>,
    /// Velocity of the surface along itself (m/s, body axes), as a conveyor belt has: friction feels it, the body does
    /// not move by it.
    pub surface_velocity: DVec3,
}

/// x(t) = x₀ + A (sin(2π f t + φ) − sin φ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// Amplitude A (m), world axes.
    pub amplitude: DVec3,
    /// Frequency f (Hz).
    pub frequency: f64,
    /// Phase φ at the start (rad).
    pub phase: f64,
}
