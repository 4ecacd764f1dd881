//! A wall in the frame of a body: no particle is rotated to find its depth.

use crate::contact::patch_damping::{Patch, mobility, touch_factor};
use crate::kinematics::Kinematics;
use crate::shape::{AffineFunction, AffineSums};
use crate::{ContactLaw, WallPlane, Wrench};
use glam::DVec3;

/// Sums over the particles of a body behind one wall, each multiplied by its weight.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WallPatch {
    /// Number of particles.
    pub count: f64,
    /// Σ δ (m).
    pub depth: f64,
    /// Σ δ a, with a from the centre of mass to the particle, world axes (m²).
    pub moment: DVec3,
    /// The largest δ (m).
    pub max_depth: f64,
}

impl WallPatch {
    /// From the centre of mass to the centre of the spring forces (m).
    pub fn arm(&self) -> DVec3 {
        self.moment / self.depth
    }

    /// The touch factor of the patch, at the velocity of its centre of force, over the time `h` (s) since the latest kick.
    pub fn touch_factor(&self, kinematics: &Kinematics, normal: DVec3, h: f64) -> f64 {
        let u = kinematics.velocity + kinematics.angular_velocity.cross(self.arm());
        touch_factor(self.max_depth, -h * u.dot(normal))
    }
}

/// A wall within reach of a body.
#[derive(Clone, Debug)]
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

    /// The law of each particle of a patch at this wall.
    pub fn law_in_patch(
        &self,
        law: &ContactLaw,
        patch: &WallPatch,
        kinematics: &Kinematics,
    ) -> ContactLaw {
        if !law.depends_on_patch() || patch.depth <= 0.0 {
            return *law;
        }
        let body = kinematics.body;
        let arm = patch.arm();
        let wrench = Wrench { force: self.normal, torque: arm.cross(self.normal) };
        let times = Patch {
            stiffness: law.stiffness * patch.count,
            friction_spring: law.friction_spring * patch.count,
            force: law.stiffness * patch.depth,
            max_depth: patch.max_depth,
            // the part that turns the body may be lost to rounding
            inverse_mass: mobility(body, kinematics.rotation, &wrench).max(1.0 / body.mass),
        }
        .damping_times(law);
        law.with_dashpots(law.stiffness * times.normal, law.friction_spring * times.tangential)
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
