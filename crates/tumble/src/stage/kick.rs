//! The kick: contact forces change the momenta of bodies that stand still for it.

use super::contact::Placed;
use crate::{BodyForces, BodyModel, BodyState, Model, Scratch, State, Tally, parallel};

/// v ← v + F h/M, L ← L + τ h, with the contact forces of [`contact`](super::contact()) and [`meet`](super::meet()) over the time
/// `h` (s).
pub fn kick(model: &Model, state: &mut State, scratch: &mut Scratch, h: f64) {
    let Scratch { forces, near, springs, tallies, meeting, .. } = scratch;
    let (forces, near) = (&*forces, &*near);
    parallel::tally_bodies(&mut state.tally, &mut state.bodies, tallies, |index, body_state| {
        let (body, forces) = (&model.bodies[index], &forces[index]);
        if !body.is_free() {
            resist(body, body_state, forces, h)
        } else if near[index] {
            kick_body(body, body_state, forces, h)
        } else {
            Tally::default()
        }
    });
    // the springs of who flies are left alone: there are none
    for (index, springs) in springs.iter_mut().enumerate().filter(|(index, _)| near[*index]) {
        std::mem::swap(&mut state.springs[index], springs);
    }
    meeting.keep(&mut state.pair_springs);
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
