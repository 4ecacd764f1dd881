//! Free and prescribed motion of bodies.

use glam::DVec3;

/// How a body moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Motion {
    /// By forces.
    #[default]
    Free,
    /// By a prescribed motion: it acts on other bodies, but no force acts on it.
    Prescribed(Prescribed),
}

/// A prescribed motion: the body keeps its initial velocity and angular velocity about its centre of mass.
///
/// With both zero it is a static obstacle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// An oscillation added to the uniform motion.
    pub oscillation: Option<Oscillation>,
    /// Tangential velocity of the surface (m/s, body axes), as of a conveyor belt. It affects friction but does not
    /// move the body.
    pub surface_velocity: DVec3,
}

/// A sinusoidal displacement: x(t) = x₀ + A (sin(2π f t + φ) − sin φ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// Amplitude A (m), world axes.
    pub amplitude: DVec3,
    /// Frequency f (Hz).
    pub frequency: f64,
    /// Phase φ at the start (rad).
    pub phase: f64,
}
