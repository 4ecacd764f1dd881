//! Position and velocity of a body, in the form that forces are computed from.

use fearless_simd::Level;
use glam::{DMat3, DVec3};

use crate::{BodyModel, BodyState, Model, Wrench};

/// A body at one pose, with the velocities that its contact forces see.
pub(crate) struct Kinematics<'a> {
    pub body: &'a BodyModel,
    pub position: DVec3,
    /// R, the orientation as a matrix.
    pub rotation: DMat3,
    pub velocity: DVec3,
    /// ω, world axes.
    pub angular_velocity: DVec3,
    /// The SIMD level in which sums over particles run; no result depends on it.
    pub level: Level,
}

impl<'a> Kinematics<'a> {
    /// Pose and velocities of `state`.
    pub fn new(body: &'a BodyModel, state: &BodyState) -> Self {
        let rotation = DMat3::from_quat(state.orientation);
        Self {
            body,
            position: state.position,
            rotation,
            velocity: state.velocity,
            angular_velocity: body.angular_velocity(rotation, state.angular_momentum),
            level: Level::new(),
        }
    }

    /// The same pose with the velocities in the middle of a kick by `wrench` over the time `h` (s).
    pub fn at_mid_kick(&self, wrench: &Wrench, h: f64) -> Self {
        let angular_acceleration = self.body.angular_velocity(self.rotation, wrench.torque);
        Self {
            velocity: self.velocity + wrench.force * (0.5 * h / self.body.mass),
            angular_velocity: self.angular_velocity + angular_acceleration * (0.5 * h),
            ..*self
        }
    }

    /// The same pose with the velocities at a `time` (s) earlier in flight, to first order. M v' = F + M g and, in the world
    /// frame, I ω' = τ − ω × L, with force and torque of the drag.
    pub fn earlier(&self, model: &Model, state: &BodyState, time: f64) -> Self {
        let (force, torque) = self.drag(model);
        let torque = torque - self.angular_velocity.cross(state.angular_momentum);
        let is_turning_evenly = torque == DVec3::ZERO;
        let acceleration = if is_turning_evenly {
            torque
        } else {
            self.body.angular_velocity(self.rotation, torque)
        };
        Self {
            velocity: self.velocity - (model.gravity + force / self.body.mass) * time,
            angular_velocity: self.angular_velocity - acceleration * time,
            ..*self
        }
    }

    /// Force and torque of the drag of the medium: F = −c (N v + ω × S) and τ = −c (S × v + G ω).
    fn drag(&self, model: &Model) -> (DVec3, DVec3) {
        let (c, moments) = (model.velocity_damping_stiffness, self.body.shape.moments());
        if c == 0.0 {
            return (DVec3::ZERO, DVec3::ZERO);
        }
        let Self { rotation, velocity, angular_velocity: omega, .. } = *self;
        let first = rotation * moments.first;
        let second = rotation * (moments.second * (rotation.transpose() * omega));
        let force = velocity * moments.count + omega.cross(first);
        (force * -c, (first.cross(velocity) + second) * -c)
    }

    /// Power that a wrench takes from the body, −(F·v + τ·ω) (W).
    pub fn dissipated_power(&self, wrench: &Wrench) -> f64 {
        -(wrench.force.dot(self.velocity) + wrench.torque.dot(self.angular_velocity))
    }

    /// Kinetic energy ½ M v² + ½ L·ω (J).
    pub fn kinetic_energy(&self, angular_momentum: DVec3) -> f64 {
        0.5 * self.body.mass * self.velocity.length_squared()
            + 0.5 * angular_momentum.dot(self.angular_velocity)
    }
}
