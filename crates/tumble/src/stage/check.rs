//! The last stage of a step: checks for finite numbers, penetration depth and displacement.

use glam::DMat3;

use crate::contact::deep_contact::DeepContact;
use crate::contact::tunnelling::TunnellingRisk;
use crate::workspace::Failure;
use crate::{Batch, BodyDepth, BodyModel, BodyState, Model, Scratch, State, StepError};

/// Looks for numbers that are NaN or infinite, for particles deeper in a wall than half the distance to the wall that faces
/// it, and for particles that move farther than that in one step: both could have passed through.
pub fn check(batch: &mut Batch) {
    let Batch { model, first, bodies, forces, workspaces, .. } = batch;
    let bodies = model.bodies[*first..].iter().zip(&**bodies).zip(&**forces);
    workspaces[0].failure = (*first..).zip(bodies).find_map(|(index, ((body, state), forces))| {
        let failure = if is_finite(state) { None } else { not_finite(state) };
        let failure = failure.or_else(|| {
            let limit = 0.5 * model.wall_gap?;
            too_deep(model, body, state, forces.max_depth, limit)
                .or_else(|| too_far(model, body, state, limit))
        });
        Some((index, failure?))
    });
}

/// Reports what [`check`] found, or else two bodies whose relative displacement in one step exceeds the tunnelling limit of their
/// contact, half of what the one would have to pass through, or whose depth in each other exceeds half of that limit.
///
/// # Errors
/// [`StepError`] names the step, time, body, particle, quantity and value, and a time step that would do.
pub fn report_failure(
    model: &Model,
    state: &State,
    scratch: &mut Scratch,
) -> Result<(), StepError> {
    let failure = scratch.workspaces.iter_mut().find_map(|workspace| workspace.failure.take());
    if let Some((index, Failure { quantity, value, particle, limit })) = failure {
        return Err(StepError {
            step: state.step,
            time: state.time,
            body: model.names[index].clone(),
            particle,
            quantity,
            value,
            other: None,
            // a quarter of the limit, so that the run can continue with a margin
            dt: limit.map(|limit| 0.25 * model.dt * limit / value),
            body_depth: None,
        });
    }
    if let Some(failure) = scratch.joints.failure.take() {
        return Err(StepError {
            step: state.step,
            time: state.time,
            body: model.joints.list[failure.joint].name.clone(),
            particle: None,
            quantity: StepError::CONSTRAINT,
            value: failure.error,
            other: None,
            dt: Some(0.5 * model.dt),
            body_depth: None,
        });
    }
    if let Some(risk) = scratch.body_contacts.tunnelling_risk() {
        return Err(tunnelling_error(model, state, &risk));
    }
    match scratch.body_contacts.check_depths(model, state.time) {
        Some(deep) => Err(depth_error(model, state, &deep)),
        None => Ok(()),
    }
}

/// Two bodies so deep in each other that they may pass through.
fn depth_error(model: &Model, state: &State, deep: &DeepContact) -> StepError {
    let found = BodyDepth::new(model, state, deep);
    StepError {
        step: state.step,
        time: state.time,
        body: found.first.clone(),
        particle: None,
        quantity: "depth",
        value: found.depth,
        other: Some(found.second.as_str().into()),
        dt: found.dt,
        body_depth: Some(Box::new(found)),
    }
}

/// Two bodies so fast that one could pass through the other within a step.
fn tunnelling_error(model: &Model, state: &State, risk: &TunnellingRisk) -> StepError {
    let name = |body: u32| model.names[body as usize].clone();
    StepError {
        step: state.step,
        time: state.time,
        body: name(risk.body),
        particle: Some(risk.particle as usize),
        quantity: "displacement",
        value: risk.displacement,
        other: Some(name(risk.other).into()),
        dt: Some(0.5 * model.dt * risk.limit / risk.displacement),
        body_depth: None,
    }
}

fn is_finite(state: &BodyState) -> bool {
    // 0 · x is NaN where x is not finite, and a sum with NaN is NaN
    let sum = (state.position + state.velocity + state.angular_momentum) * 0.0;
    let q = state.orientation * 0.0;
    sum.x + sum.y + sum.z + (q.x + q.y) + (q.z + q.w) == 0.0
}

/// The first quantity that is not finite, and its value.
fn not_finite(state: &BodyState) -> Option<Failure> {
    let [qx, qy, qz, qw] = state.orientation.to_array();
    let quantities: [(&str, &[f64]); 4] = [
        ("position", &state.position.to_array()),
        ("velocity", &state.velocity.to_array()),
        ("orientation", &[qw, qx, qy, qz]),
        ("angular_momentum", &state.angular_momentum.to_array()),
    ];
    quantities.iter().find_map(|(quantity, values)| {
        let value = *values.iter().find(|v| !v.is_finite())?;
        Some(Failure { quantity, value, particle: None, limit: None })
    })
}

/// A contact deeper than `limit` (m), and its particle.
fn too_deep(
    model: &Model,
    body: &BodyModel,
    state: &BodyState,
    depth: f64,
    limit: f64,
) -> Option<Failure> {
    if depth <= limit {
        return None;
    }
    let depth_of = |index: usize| {
        let (position, _) = body.particle(state, index);
        model.walls.iter().map(|wall| wall.depth(position)).fold(f64::NEG_INFINITY, f64::max)
    };
    let particle =
        (0..body.shape.particles().len()).max_by(|&a, &b| depth_of(a).total_cmp(&depth_of(b)));
    Some(Failure { quantity: "depth", value: depth, particle, limit: Some(limit) })
}

/// A particle that moves farther than `limit` (m) in a step.
fn too_far(model: &Model, body: &BodyModel, state: &BodyState, limit: f64) -> Option<Failure> {
    // a cheap bound first: |ω| ≤ |L| / I_min and (a + b)² ≤ 2 a² + 2 b²
    let rim = state.angular_momentum * (body.inverse_moments.max_element() * body.shape.radius());
    let (v, rim) = (state.velocity * model.dt, rim * model.dt);
    if 2.0 * (v.length_squared() + rim.length_squared()) <= limit * limit {
        return None;
    }
    let displacement =
        |omega: f64| model.dt * (state.velocity.length() + omega * body.shape.radius());
    let omega =
        body.angular_velocity(DMat3::from_quat(state.orientation), state.angular_momentum).length();
    if displacement(omega) <= limit {
        return None;
    }
    let speed = |index: usize| body.particle(state, index).1.length();
    let particle =
        (0..body.shape.particles().len()).max_by(|&a, &b| speed(a).total_cmp(&speed(b)))?;
    let value = model.dt * speed(particle);
    (value > limit).then_some(Failure {
        quantity: "displacement",
        value,
        particle: Some(particle),
        limit: Some(limit),
    })
}
