//! The state as bytes: step, time, number of bodies; position, velocity, orientation (w, x, y, z),
//! its rest, angular momentum and energy owed of each; number of friction springs of each, and wall, particle
//! anchor and stretch of each spring; the tally.

use tumble::{BodyState, DQuat, DVec3, FrictionSpring, State, Tally};

use super::Bytes;

const BODY: usize = 18 * 8;
const SPRING: usize = 4 + 4 + 6 * 8;

pub(super) fn bytes(state: &State) -> Vec<u8> {
    // taken apart to the last field: one that is added later cannot be forgotten here
    let State { step, time, bodies, springs, tally, .. } = state;
    let spring_count: usize = springs.iter().map(Vec::len).sum();
    let mut out = Vec::with_capacity(64 + bodies.len() * (BODY + 8) + spring_count * SPRING);
    out.extend(step.to_le_bytes());
    put(&mut out, [*time]);
    out.extend((bodies.len() as u64).to_le_bytes());
    for body in bodies {
        let BodyState {
            position,
            velocity,
            orientation,
            orientation_rest,
            angular_momentum,
            energy_owed,
        } = body;
        put(&mut out, position.to_array());
        put(&mut out, velocity.to_array());
        for q in [orientation, orientation_rest] {
            put(&mut out, [q.w, q.x, q.y, q.z]);
        }
        put(&mut out, angular_momentum.to_array());
        put(&mut out, [*energy_owed]);
    }
    for springs in springs {
        out.extend((springs.len() as u64).to_le_bytes());
        for FrictionSpring { wall, particle, anchor, stretch } in springs {
            out.extend(wall.to_le_bytes());
            out.extend(particle.to_le_bytes());
            put(&mut out, anchor.to_array());
            put(&mut out, stretch.to_array());
        }
    }
    let Tally { drag, dashpot, slip, max_depth, evaluations, .. } = *tally;
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
        ..Tally::default()
    };
    let pair_springs = Vec::new();
    from.is_empty().then_some(State { step, time, bodies, springs, pair_springs, tally })
}

fn body(from: &mut Bytes) -> Option<BodyState> {
    Some(BodyState {
        position: vector(from)?,
        velocity: vector(from)?,
        orientation: quaternion(from)?,
        orientation_rest: quaternion(from)?,
        angular_momentum: vector(from)?,
        energy_owed: from.f64()?,
    })
}

fn springs(from: &mut Bytes) -> Option<Vec<FrictionSpring>> {
    let count = from.count(SPRING)?;
    let spring = |_| {
        let (wall, particle) = (from.u32()?, from.u32()?);
        Some(FrictionSpring { wall, particle, anchor: vector(from)?, stretch: vector(from)? })
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
