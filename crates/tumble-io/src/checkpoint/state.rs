//! Encodes the state as bytes and decodes it.
//!
//! In this order:
//!
//! - step, time, number of bodies;
//! - for each body: position, compensation of the position (absent in version 3), velocity, orientation (w, x, y, z),
//!   compensation of the orientation (w, x, y, z), angular momentum, energy excess;
//! - for each body: number of wall friction springs, and for each spring: wall, particle, anchor, stretch;
//! - number of friction springs between bodies, and for each spring: first body, second body, kind of
//!   contact (one byte), particle, other, stretch;
//! - number of impulses of these contacts, and for each: normal, tangential (absent before version 5);
//! - time since the latest kick, and the exponent of the division of steps (likewise);
//! - the totals (the last three are absent before version 5);
//! - number of joints, and for each: coordinate, six forces; their two totals (absent before version 6).

use tumble::{
    BodyState, ContactImpulse, ContactKind, DQuat, DVec3, FrictionSpring, JointState, PairSpring,
    RunTotals, State,
};

use super::OLDEST_VERSION;
use super::bytes::Bytes;

/// Bytes of a body.
const BODY_LENGTH: usize = 21 * 8;
/// The same in version 3.
const OLD_BODY_LENGTH: usize = 18 * 8;
/// Bytes of a wall friction spring.
const SPRING_LENGTH: usize = 4 + 4 + 6 * 8;
/// Bytes of a friction spring between bodies.
const PAIR_SPRING_LENGTH: usize = 4 * 4 + 1 + 3 * 8;
/// Bytes of an impulse.
const IMPULSE_LENGTH: usize = 4 * 8;
/// Bytes of a joint.
const JOINT_LENGTH: usize = 7 * 8;
/// The first version with impulses.
const FIRST_WITH_IMPULSES: u32 = 5;
/// The first version with joints.
const FIRST_WITH_JOINTS: u32 = 6;
/// The kinds of contact, indexed by their byte.
const CONTACT_KINDS: [ContactKind; 4] = [
    ContactKind::SphereWall,
    ContactKind::SphereSphere,
    ContactKind::PointMesh,
    ContactKind::MeshPoint,
];

/// Encodes a state.
pub(super) fn encode(state: &State) -> Vec<u8> {
    // destructured completely, so that the compiler reports a new field here
    let State {
        step,
        time,
        bodies,
        springs,
        pair_springs,
        pair_impulses,
        since_kick,
        step_divisions,
        joints,
        totals,
    } = state;
    let spring_count: usize = springs.iter().map(Vec::len).sum();
    let spring_bytes = spring_count * SPRING_LENGTH
        + pair_springs.len() * PAIR_SPRING_LENGTH
        + pair_impulses.len() * IMPULSE_LENGTH;
    let mut out = Vec::with_capacity(80 + bodies.len() * (BODY_LENGTH + 8) + spring_bytes);
    out.extend(step.to_le_bytes());
    push_numbers(&mut out, [*time]);
    out.extend((bodies.len() as u64).to_le_bytes());
    for body in bodies {
        let BodyState {
            position,
            position_compensation,
            velocity,
            orientation,
            orientation_compensation,
            angular_momentum,
            energy_excess,
        } = body;
        push_numbers(&mut out, position.to_array());
        push_numbers(&mut out, position_compensation.to_array());
        push_numbers(&mut out, velocity.to_array());
        for q in [orientation, orientation_compensation] {
            push_numbers(&mut out, [q.w, q.x, q.y, q.z]);
        }
        push_numbers(&mut out, angular_momentum.to_array());
        push_numbers(&mut out, [*energy_excess]);
    }
    for springs in springs {
        out.extend((springs.len() as u64).to_le_bytes());
        for FrictionSpring { wall, particle, anchor, stretch } in springs {
            out.extend(wall.to_le_bytes());
            out.extend(particle.to_le_bytes());
            push_numbers(&mut out, anchor.to_array());
            push_numbers(&mut out, stretch.to_array());
        }
    }
    out.extend((pair_springs.len() as u64).to_le_bytes());
    for PairSpring { first, second, kind, particle, other, stretch } in pair_springs {
        out.extend(first.to_le_bytes());
        out.extend(second.to_le_bytes());
        out.push(*kind as u8);
        out.extend(particle.to_le_bytes());
        out.extend(other.to_le_bytes());
        push_numbers(&mut out, stretch.to_array());
    }
    out.extend((pair_impulses.len() as u64).to_le_bytes());
    for ContactImpulse { normal, tangential } in pair_impulses {
        push_numbers(&mut out, [*normal]);
        push_numbers(&mut out, tangential.to_array());
    }
    push_numbers(&mut out, [*since_kick]);
    out.extend(step_divisions.to_le_bytes());
    let RunTotals { drag, dashpot, slip, work, max_depth, evaluations, .. } = *totals;
    push_numbers(&mut out, [drag, dashpot, slip, work, max_depth]);
    out.extend(evaluations.to_le_bytes());
    let RunTotals { numerical, iterations, not_converged, .. } = *totals;
    push_numbers(&mut out, [numerical]);
    out.extend(iterations.to_le_bytes());
    out.extend(not_converged.to_le_bytes());
    out.extend((joints.len() as u64).to_le_bytes());
    for JointState { coordinate, force } in joints {
        push_numbers(&mut out, [*coordinate]);
        push_numbers(&mut out, *force);
    }
    push_numbers(&mut out, [totals.motor, totals.joint_friction]);
    out
}

fn push_numbers<const N: usize>(out: &mut Vec<u8>, numbers: [f64; N]) {
    out.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

/// Decodes a state of the format `version`; `None` if the bytes are invalid or are followed by others.
pub(super) fn decode(mut bytes: Bytes, version: u32) -> Option<State> {
    let is_old = version == OLDEST_VERSION;
    let (step, time) = (bytes.u64()?, bytes.f64()?);
    let count = bytes.count(if is_old { OLD_BODY_LENGTH } else { BODY_LENGTH } + 8)?;
    let bodies = (0..count).map(|_| body(&mut bytes, is_old)).collect::<Option<_>>()?;
    let springs = (0..count).map(|_| springs(&mut bytes)).collect::<Option<_>>()?;
    let pair_springs = pair_springs(&mut bytes)?;
    let has_impulses = version >= FIRST_WITH_IMPULSES;
    let pair_impulses = if has_impulses { impulses(&mut bytes)? } else { Vec::new() };
    let since_kick = if has_impulses { bytes.f64()? } else { 0.0 };
    let step_divisions = if has_impulses { bytes.u32()? } else { 0 };
    let mut totals = RunTotals {
        drag: bytes.f64()?,
        dashpot: bytes.f64()?,
        slip: bytes.f64()?,
        work: bytes.f64()?,
        max_depth: bytes.f64()?,
        evaluations: bytes.u64()?,
        ..RunTotals::default()
    };
    if has_impulses {
        totals.numerical = bytes.f64()?;
        (totals.iterations, totals.not_converged) = (bytes.u64()?, bytes.u64()?);
    }
    let has_joints = version >= FIRST_WITH_JOINTS;
    let joints = if has_joints { joints(&mut bytes)? } else { Vec::new() };
    if has_joints {
        (totals.motor, totals.joint_friction) = (bytes.f64()?, bytes.f64()?);
    }
    let state = State {
        step,
        time,
        bodies,
        springs,
        pair_springs,
        pair_impulses,
        since_kick,
        step_divisions,
        joints,
        totals,
    };
    bytes.is_empty().then_some(state)
}

fn body(bytes: &mut Bytes, is_old: bool) -> Option<BodyState> {
    Some(BodyState {
        position: vector(bytes)?,
        position_compensation: if is_old { DVec3::ZERO } else { vector(bytes)? },
        velocity: vector(bytes)?,
        orientation: quaternion(bytes)?,
        orientation_compensation: quaternion(bytes)?,
        angular_momentum: vector(bytes)?,
        energy_excess: bytes.f64()?,
    })
}

fn springs(bytes: &mut Bytes) -> Option<Vec<FrictionSpring>> {
    let count = bytes.count(SPRING_LENGTH)?;
    let spring = |_| {
        let (wall, particle) = (bytes.u32()?, bytes.u32()?);
        Some(FrictionSpring { wall, particle, anchor: vector(bytes)?, stretch: vector(bytes)? })
    };
    (0..count).map(spring).collect()
}

fn pair_springs(bytes: &mut Bytes) -> Option<Vec<PairSpring>> {
    let count = bytes.count(PAIR_SPRING_LENGTH)?;
    let spring = |_| {
        Some(PairSpring {
            first: bytes.u32()?,
            second: bytes.u32()?,
            kind: *CONTACT_KINDS.get(usize::from(bytes.take(1)?[0]))?,
            particle: bytes.u32()?,
            other: bytes.u32()?,
            stretch: vector(bytes)?,
        })
    };
    (0..count).map(spring).collect()
}

fn impulses(bytes: &mut Bytes) -> Option<Vec<ContactImpulse>> {
    let count = bytes.count(IMPULSE_LENGTH)?;
    let impulse = |_| Some(ContactImpulse { normal: bytes.f64()?, tangential: vector(bytes)? });
    (0..count).map(impulse).collect()
}

fn joints(bytes: &mut Bytes) -> Option<Vec<JointState>> {
    let count = bytes.count(JOINT_LENGTH)?;
    let joint = |_| {
        let coordinate = bytes.f64()?;
        let mut force = [0.0; 6];
        for value in &mut force {
            *value = bytes.f64()?;
        }
        Some(JointState { coordinate, force })
    };
    (0..count).map(joint).collect()
}

fn vector(bytes: &mut Bytes) -> Option<DVec3> {
    Some(DVec3::new(bytes.f64()?, bytes.f64()?, bytes.f64()?))
}

fn quaternion(bytes: &mut Bytes) -> Option<DQuat> {
    let (w, x, y, z) = (bytes.f64()?, bytes.f64()?, bytes.f64()?, bytes.f64()?);
    Some(DQuat::from_xyzw(x, y, z, w))
}
