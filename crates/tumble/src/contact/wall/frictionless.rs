//! Normal springs and dashpots at walls without friction, as sums over the particle tree.

use super::near_wall::NearWall;
use crate::kinematics::Kinematics;
use crate::shape::AffineSums;
use crate::{ContactLaw, Model, Wrench};

/// The springs of the walls without friction: F = k Σ δ n and τ = R (k Σ δ r × n_b).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NormalSprings {
    /// Sum over all these walls.
    pub all: Wrench,
    /// Sum over those that have a dashpot.
    damped: Wrench,
    /// Whether particles are behind a wall with a dashpot.
    is_damped: bool,
    /// Depth of the deepest particle (m).
    pub max_depth: f64,
}

impl NormalSprings {
    /// The springs at a pose; velocities do not matter.
    pub fn new(model: &Model, kinematics: &Kinematics) -> Self {
        let mut springs = Self::default();
        for (wall, law) in near_walls(model, kinematics) {
            let depths = wall.depth_sums(kinematics);
            if depths.sum <= 0.0 {
                continue;
            }
            let wrench = normal_wrench(kinematics, &wall, law.stiffness, &depths);
            springs.all += wrench;
            if law.damping > 0.0 {
                springs.damped += wrench;
                springs.is_damped = true;
            }
            let search =
                || kinematics.body.shape.particles().largest(kinematics.level, &wall.depth);
            let deepest = depths.largest.unwrap_or_else(search);
            springs.max_depth = springs.max_depth.max(deepest);
        }
        springs
    }

    /// The dashpots at the velocities of `kinematics`: sums of max(0, k δ − c_n u·n), less the springs.
    pub fn dashpots(&self, model: &Model, kinematics: &Kinematics) -> Wrench {
        if !self.is_damped {
            return Wrench::default();
        }
        let mut both = Wrench::default();
        for (wall, law) in near_walls(model, kinematics) {
            if law.damping > 0.0 {
                let force = wall.spring_and_dashpot(kinematics, law);
                let particles = kinematics.body.shape.particles();
                let sums = particles.sums(kinematics.level, &force, Some(&wall.depth));
                both += normal_wrench(kinematics, &wall, 1.0, &sums);
            }
        }
        both - self.damped
    }
}

/// The walls without friction that are within reach.
fn near_walls<'a>(
    model: &'a Model,
    kinematics: &'a Kinematics,
) -> impl Iterator<Item = (NearWall, &'a ContactLaw)> {
    let walls = model.walls.iter().zip(&kinematics.body.contacts);
    walls
        .filter(|(_, law)| law.friction == 0.0)
        .filter_map(|(wall, law)| Some((NearWall::new(wall, kinematics)?, law)))
}

/// The wrench of forces `factor` f n on the particles, from the sums over f.
fn normal_wrench(
    kinematics: &Kinematics,
    wall: &NearWall,
    factor: f64,
    sums: &AffineSums,
) -> Wrench {
    Wrench {
        force: wall.normal * (factor * sums.sum),
        torque: kinematics.rotation * (sums.moment.cross(wall.depth.slope) * factor),
    }
}
