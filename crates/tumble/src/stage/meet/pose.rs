//! Where the bodies are, as contacts between them see it, and how far they have come.

use glam::{DMat3, DQuat, DVec3};

use crate::{BodyModel, BodyState, Integrator, Model, Motion};

/// A body at one place, with the velocities that its contacts are to feel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub position: DVec3,
    pub rotation: DMat3,
    pub velocity: DVec3,
    pub angular_velocity: DVec3,
    /// Velocity and angular velocity in the middle of the flight since the latest kick.
    pub drift_velocity: DVec3,
    pub drift_spin: DVec3,
    /// Velocity of the surface along itself (m/s).
    pub belt: DVec3,
    orientation: DQuat,
    /// No point of the body has come farther than this (m) since it was first seen.
    pub travel: f64,
    /// How far it may come before the lists are made anew (m).
    pub skin: f64,
    /// What its travel may be until then (m).
    pub until: f64,
    /// No point of the body comes farther than this in a step (m).
    pub way: f64,
}

/// What stands for a wall as second body.
static STILL: Pose = Pose {
    position: DVec3::ZERO,
    rotation: DMat3::ZERO,
    velocity: DVec3::ZERO,
    angular_velocity: DVec3::ZERO,
    drift_velocity: DVec3::ZERO,
    drift_spin: DVec3::ZERO,
    belt: DVec3::ZERO,
    orientation: DQuat::IDENTITY,
    travel: 0.0,
    skin: 0.0,
    until: 0.0,
    way: 0.0,
};

/// The body of a number, or what stands for a wall where it is none.
#[inline(always)]
pub(super) fn of(poses: &[Pose], index: u32) -> &Pose {
    poses.get(index as usize).unwrap_or(&STILL)
}

impl Pose {
    /// At a state, its travel counted from here.
    pub fn new(model: &Model, index: usize, state: &BodyState) -> Self {
        let body = &model.bodies[index];
        let rotation = DMat3::from_quat(state.orientation);
        let belt = match &body.motion {
            Motion::Prescribed(given) => rotation * given.surface_velocity,
            Motion::Free => DVec3::ZERO,
        };
        let omega = body.angular_velocity(rotation, state.angular_momentum);
        let (mut drift_velocity, mut drift_spin) = (state.velocity, omega);
        // under `splitting` the latest flight took a whole step, with v' = g − γ v and ω' = −I⁻¹ (ω × L) without drag
        if model.integrator == Integrator::Splitting && body.is_free() {
            let half = 0.5 * model.dt;
            let rate = model.velocity_damping_stiffness / body.particle_mass();
            drift_velocity -= (model.gravity - state.velocity * rate) * half;
            let twist = omega.cross(state.angular_momentum);
            // a sphere keeps its ω
            if twist != DVec3::ZERO {
                drift_spin += body.angular_velocity(rotation, twist) * half;
            }
        }
        Self {
            drift_velocity,
            drift_spin,
            position: state.position,
            rotation,
            velocity: state.velocity,
            angular_velocity: omega,
            belt,
            orientation: state.orientation,
            travel: rounding(body, state),
            skin: 0.0,
            until: 0.0,
            way: model.dt * (length(state.velocity) + length(omega) * body.extent),
        }
    }

    /// At another state, as far as the way there is.
    pub fn moved(&self, model: &Model, index: usize, state: &BodyState) -> Self {
        let body = &model.bodies[index];
        let turn = state.orientation * self.orientation.conjugate();
        // a turn by θ takes a point at r by 2 r sin(θ/2)
        let way = length(state.position - self.position)
            + 2.0 * body.extent * length(DVec3::new(turn.x, turn.y, turn.z));
        // what rounding may hide of the way, and of places that it is held against
        let travel = self.travel + way * (1.0 + 1e-9) + rounding(body, state);
        let travel = travel * (1.0 + 4.0 * f64::EPSILON);
        Self { travel, skin: self.skin, until: self.until, ..Self::new(model, index, state) }
    }

    /// The place of a particle.
    #[inline(always)]
    pub fn place(&self, body: &BodyModel, slot: u32) -> DVec3 {
        self.position + self.rotation * body.shape.particles().at(slot)
    }
}

/// How far rounding may put a point of a body from where it is (m), and then some.
fn rounding(body: &BodyModel, state: &BodyState) -> f64 {
    16.0 * f64::EPSILON * (state.position.length() + body.extent)
}

/// |v| by the processor's own root, which is exact, instead of a call.
#[inline(always)]
fn length(v: DVec3) -> f64 {
    v.length_squared().sqrt()
}
