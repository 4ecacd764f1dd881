//! Line 9 and beyond: walls push back every particle that is behind them.
//!
//! Normal: a spring k δ and a dashpot c_n, whose sum never pulls. Tangential: a spring k_t between the
//! particle and the point of the wall where it arrived, its anchor, and a dashpot c_t, together at most μ
//! times the normal force (P. A. Cundall & O. D. L. Strack, Géotechnique 29 (1979) 47). Where the spring alone
//! would pull harder, its anchor slips after the particle.
//!
//! Springs and dashpots along the normal grow evenly through space, so the tree of the shape sums them up
//! ([`normal`]). Friction has a memory, so the particles that feel it are listed and visited ([`friction`]).

mod friction;
mod normal;
mod placed;
#[cfg(test)]
mod tests;

pub(crate) use friction::Touching;
pub(in crate::stage) use friction::within;
pub(crate) use placed::Placed;

use crate::{Batch, BodyForces, BodyModel, BodyState, FrictionSpring, Model, WallPlane};

/// Contact forces on every body that act over the time `h` (s): dashpots feel the mean of the
/// velocities before and after. With h = 0 they feel the velocities as they are.
pub fn contact(batch: &mut Batch, h: f64) {
    let Batch { model, first, bodies, springs, near, forces, next, rooms, .. } = batch;
    let bodies = model.bodies[*first..].iter().zip(&**bodies).zip(&**springs).zip(&**near);
    let touching = &mut rooms[0].touching;
    for ((((body, state), springs), &near), (forces, next)) in
        bodies.zip(forces.iter_mut().zip(next.iter_mut()))
    {
        if near && !body.has_spheres() {
            contact_body(model, body, state, springs, Room { forces, next, touching }, h);
        } else {
            forces.clear_contact();
            next.clear();
        }
    }
}

/// Where the contacts of a body go.
pub(crate) struct Room<'a> {
    /// Its forces.
    pub forces: &'a mut BodyForces,
    /// The friction springs that go on.
    pub next: &'a mut Vec<FrictionSpring>,
    /// Particles in contact, while they are looked at.
    pub touching: &'a mut Touching,
}

/// Contact forces on one body; `springs` are its friction springs so far.
pub(crate) fn contact_body(
    model: &Model,
    body: &BodyModel,
    state: &BodyState,
    springs: &[FrictionSpring],
    room: Room,
    h: f64,
) {
    let Room { forces, next, touching } = room;
    forces.clear_contact();
    next.clear();
    let far = |wall: &WallPlane| wall.depth(state.position) < -body.reach();
    if springs.is_empty() && model.walls.iter().all(far) {
        return;
    }
    let place = Placed::new(body, state);
    let alone = normal::Springs::at(model, &place);
    touching.find(model, &place, springs);
    push(model, &place, &alone, forces, touching);
    if h != 0.0 && forces.max_depth > 0.0 && body.is_damped {
        // a second look with the mean velocity of the first makes the dashpots second order
        let mean = place.half_kicked(&forces.contact(), h);
        push(model, &mean, &alone, forces, touching);
    }
    touching.keep(&place, next);
}

/// All contacts, with the velocities of `place`; `alone` are the springs without friction.
fn push(
    model: &Model,
    place: &Placed,
    alone: &normal::Springs,
    forces: &mut BodyForces,
    touching: &mut Touching,
) {
    forces.clear_contact();
    forces.spring = alone.all;
    forces.dashpot = alone.dashpots(model, place);
    forces.max_depth = alone.max_depth;
    touching.push(model, place, forces);
}
