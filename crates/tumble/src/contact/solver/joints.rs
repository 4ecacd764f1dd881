//! Joints among the iterations: after each of them, all joints act on the velocities that the contacts have left, by a direct solution.

use super::bodies::Velocities;
use crate::joint::JointKick;
use crate::{Model, Wrench};

/// The joints during the iterations.
pub(super) struct IteratedJoints<'a> {
    pub model: &'a Model,
    pub kick: &'a mut JointKick,
}

impl IteratedJoints<'_> {
    /// Lets the joints act; returns the square of the change of the momenta of their bodies (N²·s²).
    pub fn visit(&mut self, bodies: &[Velocities]) -> f64 {
        let Self { model, kick } = self;
        let free = || {
            let joined = model.joints.bodies.iter().map(|&body| body as usize);
            joined.filter(|&body| model.bodies[body].is_free())
        };
        free().for_each(|body| kick.twists[body] = bodies[body].load());
        kick.solve(model);
        let mut change = 0.0;
        for body in free() {
            let (old, _) = bodies[body].load();
            let (v, omega) = kick.twists[body];
            change += (model.bodies[body].mass * (v - old)).length_squared();
            bodies[body].store(v, omega);
        }
        change
    }
}

/// Adds loads over the time `h` (s) to the velocities of the bodies.
pub(super) fn apply_loads(
    model: &Model,
    (poses, forces): (&[crate::contact::pose::BodyPose], &[crate::BodyForces]),
    bodies: &[Velocities],
    h: f64,
) {
    if model.loads.is_empty() {
        return;
    }
    for (index, (body, forces)) in model.bodies.iter().zip(forces).enumerate() {
        let Wrench { force, torque } = forces.load;
        if body.is_free() {
            let (v, omega) = bodies[index].load();
            let turned = body.angular_velocity(poses[index].rotation, torque * h);
            bodies[index].store(v + force * (h / body.mass), omega + turned);
        }
    }
}
