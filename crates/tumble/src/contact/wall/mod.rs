//! Contact of particles with walls.
//!
//! Normal direction: a spring k δ and a dashpot c_n, whose sum never pulls. Tangential direction: a spring k_t between the
//! particle and its anchor, the point of the wall where it arrived, and a dashpot c_t, together at most μ times the normal
//! force (P. A. Cundall & O. D. L. Strack, Géotechnique 29 (1979) 47). Where the spring alone would exceed that limit, the
//! anchor slips.
//!
//! Normal forces are linear in position, so the particle tree sums them without visiting each particle
//! ([`frictionless`]). Friction has a history, so its particles are listed and visited ([`friction`]).

mod friction;
mod frictionless;
mod listing;
mod near_wall;
#[cfg(test)]
mod tests;

use self::frictionless::NormalSprings;
pub(crate) use self::listing::WallKick;
use self::near_wall::NearWall;
use crate::contact::Kick;
use crate::kinematics::Kinematics;
use crate::{BodyForces, BodyModel, BodyState, FrictionSpring, Model, Surface, WallPlane};

use self::friction::FrictionContacts;

/// Where the results of [`wall_contact_forces`] go.
pub(crate) struct WallContactOutput<'a> {
    /// Forces on the body.
    pub forces: &'a mut BodyForces,
    /// Friction springs after this evaluation.
    pub next_springs: &'a mut Vec<FrictionSpring>,
    /// Buffer for the contacts.
    pub contacts: &'a mut WallContacts,
}

/// The contacts of one body with walls, between the two evaluations of a kick.
#[derive(Clone, Debug, Default)]
pub(crate) struct WallContacts {
    normal_springs: NormalSprings,
    friction: FrictionContacts,
}

/// Computes the wall contact forces on one body, for one kick; `springs` are its friction springs so far.
pub(crate) fn wall_contact_forces(
    model: &Model,
    body: &BodyModel,
    state: &BodyState,
    springs: &[FrictionSpring],
    output: WallContactOutput,
    kick: Kick,
) {
    let WallContactOutput { forces, next_springs, contacts } = output;
    next_springs.clear();
    let Some(kinematics) = contacts.first_evaluation(model, body, state, springs, forces, kick)
    else {
        return;
    };
    if kick.length != 0.0 && forces.max_depth > 0.0 && body.is_damped {
        // a second evaluation at the mid-kick velocities of the first makes dashpots second order
        let mid_kick = kinematics.at_mid_kick(&forces.contact(), kick.length);
        contacts.evaluate(model, &mid_kick, forces);
    }
    contacts.friction.store_springs(&kinematics, next_springs);
}

impl WallContacts {
    /// The first of two evaluations: forces that serve to predict the velocities in the middle of a kick, for bodies that also
    /// touch each other. `springs` are the friction springs of the body so far.
    pub fn predict(
        &mut self,
        model: &Model,
        body: &BodyModel,
        state: &BodyState,
        springs: &[FrictionSpring],
        (forces, next_springs): (&mut BodyForces, &mut Vec<FrictionSpring>),
        kick: Kick,
    ) {
        next_springs.clear();
        if let Some(kinematics) = self.first_evaluation(model, body, state, springs, forces, kick) {
            self.friction.store_springs(&kinematics, next_springs);
        }
    }

    /// The second evaluation, at the velocities in the middle of the kick.
    pub fn evaluate_again(
        &mut self,
        model: &Model,
        mid_kick: &Kinematics,
        forces: &mut BodyForces,
        next_springs: &mut Vec<FrictionSpring>,
    ) {
        next_springs.clear();
        self.evaluate(model, mid_kick, forces);
        self.friction.store_springs(mid_kick, next_springs);
    }

    /// Finds the contacts of a body with walls, and sets its forces to those at the velocities in the middle of the flight since the
    /// latest kick; `None` where no wall is near.
    fn first_evaluation<'a>(
        &mut self,
        model: &Model,
        body: &'a BodyModel,
        state: &BodyState,
        springs: &[FrictionSpring],
        forces: &mut BodyForces,
        kick: Kick,
    ) -> Option<Kinematics<'a>> {
        forces.clear_contact();
        let is_far = |wall: &WallPlane| wall.depth(state.position) < -body.bounding_radius();
        if springs.is_empty() && model.walls.iter().all(is_far) {
            return None;
        }
        let kinematics = Kinematics::new(body, state);
        // over the time between two kicks a body at rest has no velocity, so that the prediction leaves it at rest
        let mid_flight = match kick.start {
            // a body with joints has no flight of its own
            Some(start) => {
                let Kinematics { velocity, angular_velocity, .. } = Kinematics::new(body, start);
                Kinematics { velocity, angular_velocity, ..Kinematics::new(body, state) }
            }
            None => kinematics.earlier(model, state, 0.5 * kick.length),
        };
        self.normal_springs.update(model, &mid_flight, kick.length);
        self.friction.detect(model, &mid_flight, springs, kick);
        self.evaluate(model, &mid_flight, forces);
        Some(kinematics)
    }

    /// Sets the forces of all contacts at the velocities of `kinematics`.
    fn evaluate(&mut self, model: &Model, kinematics: &Kinematics, forces: &mut BodyForces) {
        forces.clear_contact();
        forces.spring = self.normal_springs.all;
        forces.dashpot = self.normal_springs.dashpots(kinematics);
        forces.max_depth = self.normal_springs.max_depth;
        self.friction.add_forces(model, kinematics, forces);
    }
}

/// Energy in the wall contact springs of one body, normal and tangential (J).
pub(crate) fn elastic_energy(
    model: &Model,
    kinematics: &Kinematics,
    springs: &[FrictionSpring],
) -> f64 {
    let mut energy = 0.0;
    for (wall, law) in model.walls.iter().zip(&kinematics.body.contacts) {
        if let Some(near) = NearWall::new(wall, kinematics) {
            energy += 0.5 * law.stiffness * near.depth_sums(kinematics).squares;
        }
    }
    let tangential = springs.iter().map(|spring| friction::energy(model, kinematics, spring));
    energy + tangential.sum::<f64>()
}

/// How deep the particles or spheres of a body are behind a wall.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WallDepth {
    /// Depth of the deepest one (m); 0 where none is behind it.
    pub depth: f64,
    /// Sum of the depths (m), with the weights of the particles.
    pub sum: f64,
}

/// The depths behind one wall of all particles, or of the spheres about them.
pub(crate) fn depth_in_wall(kinematics: &Kinematics, wall: &WallPlane) -> WallDepth {
    let Surface::Spheres { radius } = kinematics.body.surface else {
        let sum =
            NearWall::new(wall, kinematics).map_or(0.0, |near| near.depth_sums(kinematics).sum);
        return WallDepth { depth: depth_behind(kinematics, wall), sum };
    };
    let particles = kinematics.body.shape.particles().iter();
    let depths = particles
        .map(|r| (wall.depth(kinematics.position + kinematics.rotation * r) + radius).max(0.0));
    depths.fold(WallDepth::default(), |all, depth| WallDepth {
        depth: all.depth.max(depth),
        sum: all.sum + depth,
    })
}

/// Depth of the deepest particle behind a wall (m); 0 where none is behind it.
pub(crate) fn depth_behind(kinematics: &Kinematics, wall: &WallPlane) -> f64 {
    let particles = kinematics.body.shape.particles();
    NearWall::new(wall, kinematics)
        .map_or(0.0, |near| particles.largest(kinematics.level, &near.depth))
}
