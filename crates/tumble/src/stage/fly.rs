//! Exact flight: gravity, drag and rotation of a body that touches nothing, at any step.

use glam::{DMat3, DQuat, DVec3};

use crate::flight::{Glide, Turn, free_rotation};
use crate::{Batch, BodyModel, BodyState, Model};

/// Lets the bodies that cannot touch anything fly the whole time `h` (s) at once.
pub fn cruise(batch: &mut Batch, h: f64) {
    fly_those(batch, h, false);
}

/// Lets the bodies that may touch something fly for the time `h` (s).
pub fn fly(batch: &mut Batch, h: f64) {
    fly_those(batch, h, true);
}

fn fly_those(batch: &mut Batch, h: f64, near: bool) {
    let model = batch.model;
    let bodies = model.bodies[batch.first..].iter().zip(&mut *batch.bodies);
    let mut lost = batch.rooms[0].tally.drag;
    for ((body, state), &is_near) in bodies.zip(&*batch.near) {
        if is_near == near && body.is_free() {
            lost += fly_body(model, body, state, h);
        }
    }
    batch.tally().drag = lost;
}

/// Lets one body fly; returns the energy that drag takes from it (J).
///
/// Where equal particles carry the mass, drag slows L down and changes nothing else about the
/// rotation: with L(t) = L e^(−γ t) the body turns as one without drag does in the time (1 − e^(−γ h))/γ.
/// With mass spread otherwise drag and gravity are a linear flow of their own, exact while the body
/// does not turn: half of it before and half after a flight without either. Second order in h then, with
/// the right terminal velocity at any h.
pub(crate) fn fly_body(model: &Model, body: &BodyModel, state: &mut BodyState, h: f64) -> f64 {
    let c = model.velocity_damping_stiffness;
    let Some(modes) = body.drag_modes.as_ref().filter(|_| c > 0.0) else {
        return glide(model.gravity, body, state, h, c / body.particle_mass());
    };
    let mut lost = 0.0;
    for part in [0, 1, 2] {
        if part == 1 {
            glide(DVec3::ZERO, body, state, h, 0.0);
            continue;
        }
        let principal = DMat3::from_quat(state.orientation) * body.shape.principal().axes;
        let inward = principal.transpose();
        let (mut v, mut l) = (inward * state.velocity, inward * state.angular_momentum);
        lost += modes.fall(&mut v, &mut l, inward * model.gravity, c, 0.5 * h);
        state.velocity = principal * v;
        state.angular_momentum = principal * l;
    }
    lost
}

/// Flight with drag at one rate γ for both momenta; returns the energy that drag takes (J).
fn glide(gravity: DVec3, body: &BodyModel, state: &mut BodyState, h: f64, rate: f64) -> f64 {
    if rate == 0.0 {
        turn(body, state, h);
        state.position += state.velocity * h + gravity * (0.5 * h * h);
        state.velocity += gravity * h;
        return 0.0;
    }
    let glide = Glide::new(h, rate);
    let spin_energy = turn(body, state, glide.free_time());
    let lost =
        body.mass * glide.loss(state.velocity, gravity) + spin_energy * glide.rotational_loss();
    let (way, velocity) = glide.advance(state.velocity, gravity);
    state.position += way;
    state.velocity = velocity;
    state.angular_momentum *= glide.decay();
    lost
}

/// Turns the body as it does in the time `h` without drag; returns the energy of that rotation (J).
fn turn(body: &BodyModel, state: &mut BodyState, h: f64) -> f64 {
    let (inverse, momentum) = (body.inverse_moments, state.angular_momentum);
    let q = state.orientation;
    if inverse.x == inverse.y && inverse.y == inverse.z {
        // every axis is a principal one, those of the world too
        let small = quaternion(free_rotation(inverse, momentum, h));
        turn_by(state, small * q);
        return 0.5 * inverse.x * momentum.length_squared();
    }
    let axes = &body.shape.principal().axes;
    let momentum = axes.transpose() * (q.conjugate() * momentum);
    let turn = free_rotation(inverse, momentum, h);
    let small = quaternion(Turn { vector: *axes * turn.vector, ..turn });
    turn_by(state, q * small);
    0.5 * momentum.dot(inverse * momentum)
}

/// The turn minus the identity.
fn quaternion(turn: Turn) -> DQuat {
    DQuat::from_xyzw(turn.vector.x, turn.vector.y, turn.vector.z, turn.scalar)
}

/// q ← q + `step`, with what rounding takes kept for the next time.
fn turn_by(state: &mut BodyState, step: DQuat) {
    let (q, rest) = add(state.orientation, step + state.orientation_rest);
    // back to unit length, in the same careful way
    let defect = (q.length_squared() - 1.0) + 2.0 * q.dot(rest);
    let (q, rest) = add_small(q, rest + q * (-0.5 * defect));
    state.orientation = q;
    state.orientation_rest = rest;
}

/// A sum and its rounding error, by component (D. E. Knuth, *The Art of Computer Programming* 2, 4.2.2).
fn add(a: DQuat, b: DQuat) -> (DQuat, DQuat) {
    let sum = a + b;
    let b_of_sum = sum - a;
    (sum, (a - (sum - b_of_sum)) + (b - b_of_sum))
}

/// The same where no component of `b` is larger than that of `a` (T. J. Dekker, Numer. Math. 18 (1971) 224).
fn add_small(a: DQuat, b: DQuat) -> (DQuat, DQuat) {
    let sum = a + b;
    (sum, b - (sum - a))
}
