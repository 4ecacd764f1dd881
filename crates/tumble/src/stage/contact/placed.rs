//! A body at one place, and a wall as its particles see it.

use fearless_simd::Level;
use glam::{DMat3, DVec3};

use crate::shape::{Ramp, RampSums};
use crate::{BodyModel, BodyState, ContactLaw, FrictionSpring, Model, WallPlane, Wrench};

/// A body at one place, with the velocities that its contacts are to feel.
pub(crate) struct Placed<'a> {
    pub(super) body: &'a BodyModel,
    pub(super) position: DVec3,
    pub(super) rotation: DMat3,
    pub(super) velocity: DVec3,
    pub(super) angular_velocity: DVec3,
    /// Which registers of the processor sums over particles run in; no result depends on it.
    pub(super) level: Level,
}

impl<'a> Placed<'a> {
    /// With the velocities of `state`.
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

    /// At the same place, half a kick of `wrench` over the time `h` later.
    pub fn half_kicked(&self, wrench: &Wrench, h: f64) -> Self {
        let spin = self.body.angular_velocity(self.rotation, wrench.torque);
        Self {
            velocity: self.velocity + wrench.force * (0.5 * h / self.body.mass),
            angular_velocity: self.angular_velocity + spin * (0.5 * h),
            ..*self
        }
    }

    /// What takes energy along this motion: −(F·v + τ·ω) (W).
    pub fn power_lost(&self, wrench: &Wrench) -> f64 {
        -(wrench.force.dot(self.velocity) + wrench.torque.dot(self.angular_velocity))
    }

    /// ½ M v² + ½ L·ω (J).
    pub fn kinetic_energy(&self, angular_momentum: DVec3) -> f64 {
        0.5 * self.body.mass * self.velocity.length_squared()
            + 0.5 * angular_momentum.dot(self.angular_velocity)
    }

    /// Energy in the contact springs, normal and tangential (J).
    pub fn elastic_energy(&self, model: &Model, springs: &[FrictionSpring]) -> f64 {
        let mut energy = 0.0;
        for (wall, law) in model.walls.iter().zip(&self.body.contacts) {
            if let Some(near) = NearWall::of(wall, self) {
                energy += 0.5 * law.stiffness * near.depths(self).squares;
            }
        }
        energy + springs.iter().map(|spring| self.stored(model, spring)).sum::<f64>()
    }

    /// Energy in one friction spring (J).
    fn stored(&self, model: &Model, spring: &FrictionSpring) -> f64 {
        let stiffness = self.body.contacts[spring.wall as usize].friction_spring;
        let weight = self.body.shape.particles().weight(spring.particle as usize);
        0.5 * stiffness * self.stretch(model, spring).length_squared() * weight
    }

    /// Depth of the deepest particle behind a wall (m); 0 where none is behind it.
    pub fn depth_behind(&self, wall: &WallPlane) -> f64 {
        let particles = self.body.shape.particles();
        NearWall::of(wall, self).map_or(0.0, |near| particles.largest(self.level, &near.depth))
    }

    /// From the anchor of a friction spring to its particle, along the wall (m).
    pub(super) fn stretch(&self, model: &Model, spring: &FrictionSpring) -> DVec3 {
        let arm = self.rotation * self.body.shape.particles().get(spring.particle as usize);
        let normal = model.walls[spring.wall as usize].normal;
        let way = self.position + arm - spring.anchor;
        way - normal * way.dot(normal)
    }
}

/// A wall within reach of a body, seen from the body frame: no particle is rotated to find its depth.
pub(super) struct NearWall {
    /// δ(r) = (d − n·x) − n_b·r, with n_b = Rᵀ n (m).
    pub depth: Ramp,
    /// n.
    pub normal: DVec3,
}

impl NearWall {
    /// `None` where the wall is out of reach of the whole body.
    pub fn of(wall: &WallPlane, place: &Placed) -> Option<Self> {
        let offset = wall.depth(place.position);
        // the farthest particle is not behind the wall: none is
        if offset < -place.body.reach() {
            return None;
        }
        let depth = Ramp { offset, slope: place.rotation.transpose() * wall.normal };
        Some(Self { depth, normal: wall.normal })
    }

    /// Sums of the depths behind the wall.
    pub fn depths(&self, place: &Placed) -> RampSums {
        place.body.shape.particles().sums(place.level, &self.depth, None)
    }

    /// The force of spring and dashpot together, without the clamp: k δ − c_n u·n, which is even in space
    /// since u·n = v·n + (ω × R r)·n = v·n + (n × ω)·R r.
    pub fn damped(&self, place: &Placed, law: &ContactLaw) -> Ramp {
        let (k, c, n) = (law.stiffness, law.damping, self.normal);
        let turning = place.rotation.transpose() * n.cross(place.angular_velocity);
        Ramp {
            offset: k * self.depth.offset - c * place.velocity.dot(n),
            slope: self.depth.slope * k + turning * c,
        }
    }
}
