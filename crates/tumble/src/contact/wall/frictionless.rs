//! Normal springs and dashpots at walls without friction, as sums over the particle tree.

use super::listing::WallParticle;
use super::near_wall::{NearWall, WallPatch};
use crate::kinematics::Kinematics;
use crate::shape::AffineSums;
use crate::{ContactLaw, Model, Wrench};

/// The springs of the walls without friction: F = k Σ δ n and τ = R (k Σ δ r × n_b).
#[derive(Clone, Debug, Default)]
pub(super) struct NormalSprings {
    /// Sum over all these walls.
    pub all: Wrench,
    /// The walls that have a dashpot.
    damped: Vec<DampedWall>,
    /// Depth of the deepest particle (m).
    pub max_depth: f64,
}

/// A wall with particles behind it and a dashpot.
#[derive(Clone, Debug)]
struct DampedWall {
    wall: NearWall,
    /// The law of each particle.
    law: ContactLaw,
    /// The springs.
    spring: Wrench,
}

impl NormalSprings {
    /// Sets the springs to those at a pose. The velocities, together with the time `h` (s) since the latest kick, tell whether a patch has touched
    /// since then.
    pub fn update(&mut self, model: &Model, kinematics: &Kinematics, h: f64) {
        let springs = self;
        springs.damped.clear();
        (springs.all, springs.max_depth) = (Wrench::default(), 0.0);
        for (wall, law) in near_walls(model, kinematics) {
            let depths = wall.depth_sums(kinematics);
            if depths.sum <= 0.0 {
                continue;
            }
            let spring = normal_wrench(kinematics, &wall, law.stiffness, &depths);
            springs.all += spring;
            let search =
                || kinematics.body.shape.particles().largest(kinematics.level, &wall.depth);
            let deepest = depths.largest.unwrap_or_else(search);
            springs.max_depth = springs.max_depth.max(deepest);
            if law.is_damped() {
                let patch = WallPatch {
                    count: depths.count,
                    depth: depths.sum,
                    moment: kinematics.rotation * depths.moment,
                    max_depth: deepest,
                };
                let law = damped_law(&wall, law, &patch, kinematics, h);
                springs.damped.push(DampedWall { wall, law, spring });
            }
        }
    }

    /// Calls `add` with each particle behind these walls, at the velocities of `kinematics`.
    pub fn list(&self, model: &Model, kinematics: &Kinematics, add: &mut impl FnMut(WallParticle)) {
        let particles = kinematics.body.shape.particles();
        let mut damped = self.damped.iter();
        let mut slots = Vec::new();
        for (index, (wall, law)) in model.walls.iter().zip(&kinematics.body.contacts).enumerate() {
            let near = NearWall::new(wall, kinematics).filter(|_| law.friction == 0.0);
            let Some(near) = near else { continue };
            if near.depth_sums(kinematics).sum <= 0.0 {
                continue;
            }
            let law = if law.is_damped() { damped.next().map(|wall| &wall.law) } else { Some(law) };
            let Some(law) = law else { continue };
            let force = near.spring_and_dashpot(kinematics, law);
            slots.clear();
            particles.collect_positive_slots(kinematics.level, &near.depth, &mut slots);
            for &slot in &slots {
                let r = particles.at(slot);
                let arm = kinematics.rotation * r;
                let weight = particles.weight(particles.index_of_slot(slot) as usize);
                let force = near.normal * (force.at(r).max(0.0) * weight);
                let wrench = Wrench { force, torque: arm.cross(force) };
                add(WallParticle { wall: index, arm, depth: near.depth.at(r), wrench });
            }
        }
    }

    /// The dashpots at the velocities of `kinematics`: sums of max(0, k δ − c_n u·n), less the springs.
    pub fn dashpots(&self, kinematics: &Kinematics) -> Wrench {
        let mut dashpots = Wrench::default();
        for DampedWall { wall, law, spring } in &self.damped {
            let force = wall.spring_and_dashpot(kinematics, law);
            let particles = kinematics.body.shape.particles();
            let sums = particles.sums(kinematics.level, &force, Some(&wall.depth));
            dashpots += normal_wrench(kinematics, wall, 1.0, &sums) - *spring;
        }
        dashpots
    }
}

/// The law of each particle of a patch, in the kick at these velocities.
fn damped_law(
    wall: &NearWall,
    law: &ContactLaw,
    patch: &WallPatch,
    kinematics: &Kinematics,
    h: f64,
) -> ContactLaw {
    let law = wall.law_in_patch(law, patch, kinematics);
    // the sums over the tree have one factor for all particles: that at the centre of force
    let factor = patch.touch_factor(kinematics, wall.normal, h);
    ContactLaw { damping: law.damping * factor, ..law }
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
