//! The drift: exact flight of a body under gravity and drag, for any time step.

use glam::{DMat3, DQuat, DVec3};

use crate::flight::{LinearDrag, RotationDelta, free_rotation};
use crate::{Batch, BodyModel, BodyState, Model};

/// Advances the bodies in free flight by the whole step `h` (s).
pub fn drift_free_flight(batch: &mut Batch, h: f64) {
    drift_where(batch, h, false);
}

/// Advances the bodies that may touch something by the time `h` (s), without contact.
pub fn drift(batch: &mut Batch, h: f64) {
    drift_where(batch, h, true);
}

fn drift_where(batch: &mut Batch, h: f64, may_touch: bool) {
    let model = batch.model;
    let bodies = model.bodies[batch.first..].iter().zip(&mut *batch.bodies);
    let mut drag_loss = batch.workspaces[0].totals.drag;
    let joints = &model.joints;
    for (index, ((body, state), &body_may_touch)) in
        (batch.first..).zip(bodies.zip(&*batch.may_touch))
    {
        // bodies with joints fly together
        if body_may_touch == may_touch && body.is_free() && !joints.acts_on(index) {
            drag_loss += drift_body(model, body, state, h);
        }
    }
    batch.totals().drag = drag_loss;
}

/// Advances one body in flight; returns the energy that drag takes from it (J).
///
/// Where equal particles carry the mass, drag scales L and does not otherwise change the rotation: with
/// L(t) = L e^(−γ t) the body turns as it would without drag in the time (1 − e^(−γ h))/γ.
///
/// For other mass distributions, drag and gravity are a linear flow that is exact while the body does not turn. One half of
/// it is applied before and one half after a flight without drag and gravity (Strang splitting): second order in h, with
/// the correct terminal velocity at any h.
pub(crate) fn drift_body(model: &Model, body: &BodyModel, state: &mut BodyState, h: f64) -> f64 {
    let c = model.velocity_damping_stiffness;
    let Some(modes) = body.drag_modes.as_ref().filter(|_| c > 0.0) else {
        return uniform_drag_flight(model.gravity, body, state, h, c / body.particle_mass());
    };
    let half_drag = |state: &mut BodyState| {
        let principal = DMat3::from_quat(state.orientation) * body.shape.principal().axes;
        let inward = principal.transpose();
        let (mut v, mut l) = (inward * state.velocity, inward * state.angular_momentum);
        let lost = modes.fall(&mut v, &mut l, inward * model.gravity, c, 0.5 * h);
        state.velocity = principal * v;
        state.angular_momentum = principal * l;
        lost
    };
    let lost = half_drag(state);
    uniform_drag_flight(DVec3::ZERO, body, state, h, 0.0);
    lost + half_drag(state)
}

/// Flight with one drag rate γ (1/s) for both momenta; returns the energy that drag takes (J).
fn uniform_drag_flight(
    gravity: DVec3,
    body: &BodyModel,
    state: &mut BodyState,
    h: f64,
    rate: f64,
) -> f64 {
    if rate == 0.0 {
        rotate(body, state, h);
        state.move_by(state.velocity * h + gravity * (0.5 * h * h));
        state.velocity += gravity * h;
        return 0.0;
    }
    let drag = LinearDrag::new(h, rate);
    let spin_energy = rotate(body, state, drag.free_time());
    let lost =
        body.mass * drag.loss(state.velocity, gravity) + spin_energy * drag.rotational_loss();
    let (displacement, velocity) = drag.advance(state.velocity, gravity);
    state.move_by(displacement);
    state.velocity = velocity;
    state.angular_momentum *= drag.decay();
    lost
}

/// Rotates a torque-free body for the time `h` (s); returns its rotational energy (J).
fn rotate(body: &BodyModel, state: &mut BodyState, h: f64) -> f64 {
    let (inverse, momentum) = (body.inverse_moments, state.angular_momentum);
    let q = state.orientation;
    if inverse.x == inverse.y && inverse.y == inverse.z {
        // isotropic inertia: the world axes are principal axes
        let increment = quaternion(free_rotation(inverse, momentum, h));
        rotate_by(state, increment * q);
        return 0.5 * inverse.x * momentum.length_squared();
    }
    let axes = &body.shape.principal().axes;
    let momentum = axes.transpose() * (q.conjugate() * momentum);
    let turn = free_rotation(inverse, momentum, h);
    let increment = quaternion(RotationDelta { vector: *axes * turn.vector, ..turn });
    rotate_by(state, q * increment);
    0.5 * momentum.dot(inverse * momentum)
}

/// The rotation quaternion minus the identity.
fn quaternion(turn: RotationDelta) -> DQuat {
    DQuat::from_xyzw(turn.vector.x, turn.vector.y, turn.vector.z, turn.scalar)
}

/// q ← q + `increment`, as a compensated sum: the rounding error goes into `orientation_compensation`.
fn rotate_by(state: &mut BodyState, increment: DQuat) {
    let (q, rest) = two_sum(state.orientation, increment + state.orientation_compensation);
    // normalise, again compensated
    let defect = (q.length_squared() - 1.0) + 2.0 * q.dot(rest);
    let (q, rest) = fast_two_sum(q, rest + q * (-0.5 * defect));
    state.orientation = q;
    state.orientation_compensation = rest;
}

/// A sum and its rounding error, by component (2Sum: D. E. Knuth, *The Art of Computer Programming* 2, 4.2.2).
fn two_sum(a: DQuat, b: DQuat) -> (DQuat, DQuat) {
    let sum = a + b;
    let b_of_sum = sum - a;
    (sum, (a - (sum - b_of_sum)) + (b - b_of_sum))
}

/// The same where no component of `b` exceeds that of `a` in magnitude (Fast2Sum: T. J. Dekker, Numer. Math. 18 (1971) 224).
fn fast_two_sum(a: DQuat, b: DQuat) -> (DQuat, DQuat) {
    let sum = a + b;
    (sum, b - (sum - a))
}
