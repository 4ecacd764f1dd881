//! A wall in the frame of a body: no particle is rotated to find its depth.

use crate::kinematics::Kinematics;
use crate::shape::{AffineFunction, AffineSums};
use crate::{ContactLaw, WallPlane};
use glam::DVec3;

/// A wall within reach of a body.
pub(super) struct NearWall {
    /// δ(r) = (d − n·x) − n_b·r, with n_b = Rᵀ n (m).
    pub depth: AffineFunction,
    /// n, world axes.
    pub normal: DVec3,
}

impl NearWall {
    /// `None` where no particle of the body can be behind the wall.
    pub fn new(wall: &WallPlane, kinematics: &Kinematics) -> Option<Self> {
        let offset = wall.depth(kinematics.position);
        if offset < -kinematics.body.bounding_radius() {
            return None;
        }
        let depth = AffineFunction { offset, slope: kinematics.rotation.transpose() * wall.normal };
        Some(Self { depth, normal: wall.normal })
    }

    /// Sums over the depths of the particles behind the wall.
    pub fn depth_sums(&self, kinematics: &Kinematics) -> AffineSums {
        kinematics.body.shape.particles().sums(kinematics.level, &self.depth, None)
    }

    /// Force of spring and dashpot as a function of position, k δ − c_n u·n, before it is clamped to zero. It is linear in r
    /// since u·n = v·n + (ω × R r)·n = v·n + (n × ω)·R r.
    pub fn spring_and_dashpot(&self, kinematics: &Kinematics, law: &ContactLaw) -> AffineFunction {
        let (k, c, n) = (law.stiffness, law.damping, self.normal);
        let rotational = kinematics.rotation.transpose() * n.cross(kinematics.angular_velocity);
        AffineFunction {
            offset: k * self.depth.offset - c * kinematics.velocity.dot(n),
            slope: self.depth.slope * k + rotational * c,
        }
    }
}
