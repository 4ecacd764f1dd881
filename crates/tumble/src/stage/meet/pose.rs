//! Where the bodies are, as contacts between them see it, and how far they have come.

use glam::{DMat3, DQuat, DVec3};

use crate::{BodyModel, BodyState, Motion};

/// A body at one place, with the velocities that its contacts are to feel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pose {
    pub position: DVec3,
    pub rotation: DMat3,
    pub velocity: DVec3,
    pub angular_velocity: DVec3,
    /// Velocity of the surface along itself (m/s).
    pub belt: DVec3,
    orientation: DQuat,
    /// No point of the body has come farther than this (m) since the lists were made.
    pub travel: f64,
}

impl Pose {
    /// At a state, its travel counted from here.
    pub fn new(body: &BodyModel, state: &BodyState) -> Self {
        let rotation = DMat3::from_quat(state.orientation);
        let belt = match &body.motion {
            Motion::Prescribed(given) => rotation * given.surface_velocity,
            Motion::Free => DVec3::ZERO,
        };
        Self {
            position: state.position,
            rotation,
            velocity: state.velocity,
            angular_velocity: body.angular_velocity(rotation, state.angular_momentum),
            belt,
            orientation: state.orientation,
            travel: 0.0,
        }
    }

    /// At another state, as far as the way there is.
    pub fn moved(&self, body: &BodyModel, state: &BodyState) -> Self {
        let turn = state.orientation * self.orientation.conjugate();
        // a turn by θ takes a point at r by 2 r sin(θ/2)
        let way = (state.position - self.position).length()
            + 2.0 * body.extent * DVec3::new(turn.x, turn.y, turn.z).length();
        // what rounding may hide
        Self { travel: self.travel + way * (1.0 + 1e-9), ..Self::new(body, state) }
    }

    /// The place of a particle.
    #[inline(always)]
    pub fn place(&self, body: &BodyModel, slot: u32) -> DVec3 {
        self.position + self.rotation * body.shape.particles().at(slot)
    }

    /// The velocity of the body at an arm from its centre of mass.
    #[inline(always)]
    pub fn velocity_at(&self, arm: DVec3) -> DVec3 {
        self.velocity + self.angular_velocity.cross(arm)
    }
}
