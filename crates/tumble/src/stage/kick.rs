//! The kick: contact forces change the momenta of bodies that stand still for it.

use super::contact::Placed;
use crate::{Batch, BodyForces, BodyModel, BodyState, Tally};

/// v ← v + F h/M, L ← L + τ h, with the contact forces of [`contact`](super::contact()) and [`meet`](super::meet()) over the time
/// `h` (s).
pub fn kick(batch: &mut Batch, h: f64) {
    let mut tally = *batch.tally();
    let bodies = batch.model.bodies[batch.first..].iter().zip(&mut *batch.bodies);
    for (((body, state), forces), &near) in bodies.zip(&*batch.forces).zip(&*batch.near) {
        if !body.is_free() {
            tally += resist(body, state, forces, h);
        } else if near {
            tally += kick_body(body, state, forces, h);
        }
    }
    *batch.tally() = tally;
    // the springs of who flies are left alone: there are none
    let springs = batch.springs.iter_mut().zip(&mut *batch.next);
    for ((springs, next), _) in springs.zip(&*batch.near).filter(|(_, near)| **near) {
        std::mem::swap(springs, next);
    }
}

/// Kicks one body; returns what its contacts lost.
///
/// The place stands still, so a wrench gives the body exactly its power at the mean of the old and
/// new velocities, times h.
pub(crate) fn kick_body(
    body: &BodyModel,
    state: &mut BodyState,
    forces: &BodyForces,
    h: f64,
) -> Tally {
    if forces.max_depth == 0.0 {
        return Tally { slip: forces.slip, ..Tally::default() };
    }
    let total = forces.contact();
    let mean = Placed::new(body, state).half_kicked(&total, h);
    state.velocity += total.force * (h / body.mass);
    state.angular_momentum += total.torque * h;
    Tally {
        dashpot: h * (mean.power_lost(&forces.dashpot) + forces.belt_loss),
        slip: forces.slip,
        work: h * forces.belt_power,
        max_depth: forces.max_depth,
        evaluations: 1,
        ..Tally::default()
    }
}

/// What a body that nothing moves does on those that push it: work against their forces, and the part of
/// the loss in dashpots that its own velocity makes.
pub(crate) fn resist(body: &BodyModel, state: &BodyState, forces: &BodyForces, h: f64) -> Tally {
    let place = Placed::new(body, state);
    Tally {
        work: h * (place.power_lost(&forces.contact()) + forces.belt_power),
        dashpot: h * (place.power_lost(&forces.dashpot) + forces.belt_loss),
        slip: forces.slip,
        max_depth: forces.max_depth,
        ..Tally::default()
    }
}
