//! The last stage of every step: is the state still one that physics could have made?

use glam::DMat3;

use super::TooFast;
use crate::{Batch, BodyModel, BodyState, Model, Scratch, State, StepError};

/// Looks for a state with a number that is NaN or infinite, a particle that has come more than half way from
/// one wall to the wall that faces it, and a step that moves a particle that far: both could have
/// passed through.
pub fn check(batch: &mut Batch) {
    let Batch { model, first, bodies, forces, rooms, .. } = batch;
    let bodies = model.bodies[*first..].iter().zip(&**bodies).zip(&**forces);
    rooms[0].problem = (*first..).zip(bodies).find_map(|(index, ((body, state), forces))| {
        let problem = if is_finite(state) { None } else { not_finite(state) };
        let problem = problem.or_else(|| {
            let limit = 0.5 * model.gap?;
            too_deep(model, body, state, forces.max_depth, limit)
                .or_else(|| too_far(model, body, state, limit))
        });
        Some((index, problem?))
    });
}

/// Refuses what [`check`] has found at the end of a step, and two bodies that moved against each other, in one step, by half of
/// what the thinner of them is thick.
///
/// # Errors
/// [`StepError`] names the step, time, body, particle, quantity and value, and a step that would do.
pub fn refuse(model: &Model, state: &State, scratch: &mut Scratch) -> Result<(), StepError> {
    let problem = scratch.rooms.iter_mut().find_map(|room| room.problem.take());
    if let Some((index, Problem { quantity, value, particle, limit })) = problem {
        return Err(StepError {
            step: state.step,
            time: state.time,
            body: model.names[index].clone(),
            particle,
            quantity,
            value,
            other: None,
            // a quarter of the limit leaves room for the motion to go on
            dt: limit.map(|limit| 0.25 * model.dt * limit / value),
        });
    }
    match scratch.meeting.too_fast() {
        Some(pair) => Err(passes_through(model, state, &pair)),
        None => Ok(()),
    }
}

/// Two bodies so fast that one could pass through the other unseen.
fn passes_through(model: &Model, state: &State, pair: &TooFast) -> StepError {
    let name = |body: u32| model.names[body as usize].clone();
    StepError {
        step: state.step,
        time: state.time,
        body: name(pair.body),
        particle: Some(pair.particle as usize),
        quantity: "displacement",
        value: pair.way,
        other: Some(name(pair.other)),
        dt: Some(0.5 * model.dt * pair.limit / pair.way),
    }
}

/// What is wrong with a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Problem {
    quantity: &'static str,
    value: f64,
    particle: Option<usize>,
    limit: Option<f64>,
}

fn is_finite(state: &BodyState) -> bool {
    // zero times what is not finite is NaN, and so is whatever it is added to
    let sum = (state.position + state.velocity + state.angular_momentum) * 0.0;
    let q = state.orientation * 0.0;
    sum.x + sum.y + sum.z + (q.x + q.y) + (q.z + q.w) == 0.0
}

/// The first quantity that is not finite, and its value.
fn not_finite(state: &BodyState) -> Option<Problem> {
    let [qx, qy, qz, qw] = state.orientation.to_array();
    let quantities: [(&str, &[f64]); 4] = [
        ("position", &state.position.to_array()),
        ("velocity", &state.velocity.to_array()),
        ("orientation", &[qw, qx, qy, qz]),
        ("angular_momentum", &state.angular_momentum.to_array()),
    ];
    quantities.iter().find_map(|(quantity, values)| {
        let value = *values.iter().find(|v| !v.is_finite())?;
        Some(Problem { quantity, value, particle: None, limit: None })
    })
}

/// A contact deeper than `limit` (m), with its particle.
fn too_deep(
    model: &Model,
    body: &BodyModel,
    state: &BodyState,
    depth: f64,
    limit: f64,
) -> Option<Problem> {
    if depth <= limit {
        return None;
    }
    let deepest = |index: usize| {
        let (place, _) = body.particle(state, index);
        model.walls.iter().map(|wall| wall.depth(place)).fold(f64::NEG_INFINITY, f64::max)
    };
    let particle =
        (0..body.shape.particles().len()).max_by(|&a, &b| deepest(a).total_cmp(&deepest(b)));
    Some(Problem { quantity: "depth", value: depth, particle, limit: Some(limit) })
}

/// A particle that moves farther than `limit` (m) in a step.
fn too_far(model: &Model, body: &BodyModel, state: &BodyState, limit: f64) -> Option<Problem> {
    // |ω| is at most |L| over the smallest moment, and (a + b)² at most 2 a² + 2 b²: most bodies
    // need no closer look, and no root
    let rim = state.angular_momentum * (body.inverse_moments.max_element() * body.shape.radius());
    let (v, rim) = (state.velocity * model.dt, rim * model.dt);
    if 2.0 * (v.length_squared() + rim.length_squared()) <= limit * limit {
        return None;
    }
    let way = |omega: f64| model.dt * (state.velocity.length() + omega * body.shape.radius());
    let omega =
        body.angular_velocity(DMat3::from_quat(state.orientation), state.angular_momentum).length();
    if way(omega) <= limit {
        return None;
    }
    let speed = |index: usize| body.particle(state, index).1.length();
    let particle =
        (0..body.shape.particles().len()).max_by(|&a, &b| speed(a).total_cmp(&speed(b)))?;
    let value = model.dt * speed(particle);
    (value > limit).then_some(Problem {
        quantity: "displacement",
        value,
        particle: Some(particle),
        limit: Some(limit),
    })
}
