//! The state as bytes: step, time, number of bodies; position, velocity, orientation (w, x, y, z),
//! its rest and angular momentum of each; number of friction springs of each, and wall, particle
//! and anchor of each spring; the tally.

use tumble::{BodyState, DQuat, DVec3, FrictionSpring, State, Tally};

use super::Bytes;

const BODY: usize = 17 * 8;
const SPRING: usize = 4 + 4 + 3 * 8;

pub(super) fn bytes(state: &State) -> Vec<u8> {
    let springs: usize = state.springs.iter().map(Vec::len).sum();
    let size = 64 + state.bodies.len() * (BODY + 8) + springs * SPRING;
    let mut out = Vec::with_capacity(size);
    out.extend(state.step.to_le_bytes());
    put(&mut out, [state.time]);
    out.extend((state.bodies.len() as u64).to_le_bytes());
    for body in &state.bodies {
        put(&mut out, body.position.to_array());
        put(&mut out, body.velocity.to_array());
        for q in [body.orientation, body.orientation_rest] {
            put(&mut out, [q.w, q.x, q.y, q.z]);
        }
        put(&mut out, body.angular_momentum.to_array());
    }
    for springs in &state.springs {
        out.extend((springs.len() as u64).to_le_bytes());
        for spring in springs {
            out.extend(spring.wall.to_le_bytes());
            out.extend(spring.particle.to_le_bytes());
            put(&mut out, spring.anchor.to_array());
        }
    }
    let Tally { drag, dashpot, slip, max_depth, evaluations } = state.tally;
    put(&mut out, [drag, dashpot, slip, max_depth]);
    out.extend(evaluations.to_le_bytes());
    out
}

fn put<const N: usize>(out: &mut Vec<u8>, numbers: [f64; N]) {
    out.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

/// The state, and nothing after it.
pub(super) fn parse(mut from: Bytes) -> Option<State> {
    let (step, time) = (from.u64()?, from.f64()?);
    let count = from.count(BODY + 8)?;
    let bodies = (0..count).map(|_| body(&mut from)).collect::<Option<_>>()?;
    let springs = (0..count).map(|_| springs(&mut from)).collect::<Option<_>>()?;
    let tally = Tally {
        drag: from.f64()?,
        dashpot: from.f64()?,
        slip: from.f64()?,
        max_depth: from.f64()?,
        evaluations: from.u64()?,
    };
    from.is_empty().then_some(State { step, time, bodies, springs, tally })
}

fn body(from: &mut Bytes) -> Option<BodyState> {
    Some(BodyState {
        position: vector(from)?,
        velocity: vector(from)?,
        orientation: quaternion(from)?,
        orientation_rest: quaternion(from)?,
        angular_momentum: vector(from)?,
    })
}

fn springs(from: &mut Bytes) -> Option<Vec<FrictionSpring>> {
    let count = from.count(SPRING)?;
    let spring = |_| {
        let (wall, particle) = (from.u32()?, from.u32()?);
        Some(FrictionSpring { wall, particle, anchor: vector(from)? })
    };
    (0..count).map(spring).collect()
}

fn vector(from: &mut Bytes) -> Option<DVec3> {
    Some(DVec3::new(from.f64()?, from.f64()?, from.f64()?))
}

fn quaternion(from: &mut Bytes) -> Option<DQuat> {
    let (w, x, y, z) = (from.f64()?, from.f64()?, from.f64()?, from.f64()?);
    Some(DQuat::from_xyzw(x, y, z, w))
}
