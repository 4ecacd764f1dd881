//! The particles of a body at walls, one by one, with the same law as their sums.

use glam::DVec3;

use super::WallContacts;
use crate::contact::Kick;
use crate::contact::pose::BodyPose;
use crate::kinematics::Kinematics;
use crate::{
    BodyForces, BodyModel, BodyState, Contact, ContactPartner, FrictionSpring, Model, Wrench,
};

/// A particle behind a wall.
pub(super) struct WallParticle {
    /// Index of the wall.
    pub wall: usize,
    /// From the centre of mass to the particle (m).
    pub arm: DVec3,
    /// Its depth (m).
    pub depth: f64,
    /// Force and torque on the body.
    pub wrench: Wrench,
}

/// The contacts of one body with walls at a kick.
pub(crate) struct WallKick<'a> {
    contacts: WallContacts,
    /// Pose and velocities at the kick.
    kinematics: Kinematics<'a>,
    /// The same with the velocities that dashpots see.
    seen: Kinematics<'a>,
    /// The forces.
    pub forces: BodyForces,
}

impl<'a> WallKick<'a> {
    /// The contacts of a body with these friction springs at a kick; `None` where no wall is near.
    pub fn new(
        model: &Model,
        (body, state): (&'a BodyModel, &BodyState),
        springs: &[FrictionSpring],
        kick: Kick,
    ) -> Option<Self> {
        let (mut contacts, mut forces) = (WallContacts::default(), BodyForces::default());
        let kinematics =
            contacts.first_evaluation(model, body, state, springs, &mut forces, kick)?;
        let seen = kinematics.earlier(model, state, 0.5 * kick.length);
        Some(Self { contacts, kinematics, seen, forces })
    }

    fn has_dashpots(&self) -> bool {
        self.forces.max_depth > 0.0 && self.kinematics.body.is_damped
    }

    /// Evaluates dashpots at the velocities in the middle of the kick of length `h` (s) by these forces alone.
    pub fn evaluate_at_mid_kick(&mut self, model: &Model, h: f64) {
        if self.has_dashpots() {
            self.seen = self.kinematics.at_mid_kick(&self.forces.contact(), h);
            self.contacts.evaluate(model, &self.seen, &mut self.forces);
        }
    }

    /// Evaluates dashpots at the velocities of `pose`.
    pub fn evaluate_at_velocities(&mut self, model: &Model, pose: &BodyPose) {
        if self.has_dashpots() {
            self.seen.velocity = pose.velocity;
            self.seen.angular_velocity = pose.angular_velocity;
            self.contacts.evaluate(model, &self.seen, &mut self.forces);
        }
    }

    /// Appends the particles behind walls as contacts of body number `body`.
    pub fn list(&self, model: &Model, body: usize, listed: &mut Vec<Contact>) {
        let Self { contacts, seen, .. } = self;
        let mut add = |particle: WallParticle| {
            let WallParticle { wall, arm, depth, wrench } = particle;
            listed.push(Contact {
                body,
                other: ContactPartner::Wall(wall),
                point: seen.position + arm,
                normal: model.walls[wall].normal,
                depth,
                force: wrench.force,
                torque: wrench.torque,
                other_torque: DVec3::ZERO,
            });
        };
        contacts.normal_springs.list(model, seen, &mut add);
        contacts.friction.list(model, seen, &mut add);
    }
}
