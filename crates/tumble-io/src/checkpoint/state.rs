//! The state as bytes: step, time, number of bodies; position, velocity, orientation (w, x, y, z),
//! its compensation, angular momentum and energy excess of each; number of friction springs of each, and wall, particle
//! anchor and stretch of each spring; number of springs between bodies, and first, second, kind (a byte), particle,
//! other and stretch of each; the totals.

use tumble::{BodyState, ContactKind, DQuat, DVec3, FrictionSpring, PairSpring, RunTotals, State};

use super::bytes::Bytes;

const BODY: usize = 18 * 8;
const SPRING: usize = 4 + 4 + 6 * 8;
const PAIR: usize = 4 * 4 + 1 + 3 * 8;
/// The kinds of contact by their bytes.
const KINDS: [ContactKind; 4] = [
    ContactKind::SphereWall,
    ContactKind::SphereSphere,
    ContactKind::PointMesh,
    ContactKind::MeshPoint,
];

pub(super) fn bytes(state: &State) -> Vec<u8> {
    // destructured completely, so that the compiler reports a new field here
    let State { step, time, bodies, springs, pair_springs, totals } = state;
    let spring_count: usize = springs.iter().map(Vec::len).sum();
    let counted = spring_count * SPRING + pair_springs.len() * PAIR;
    let mut out = Vec::with_capacity(80 + bodies.len() * (BODY + 8) + counted);
    out.extend(step.to_le_bytes());
    put(&mut out, [*time]);
    out.extend((bodies.len() as u64).to_le_bytes());
    for body in bodies {
        let BodyState {
            position,
            velocity,
            orientation,
            orientation_compensation,
            angular_momentum,
            energy_excess,
        } = body;
        put(&mut out, position.to_array());
        put(&mut out, velocity.to_array());
        for q in [orientation, orientation_compensation] {
            put(&mut out, [q.w, q.x, q.y, q.z]);
        }
        put(&mut out, angular_momentum.to_array());
        put(&mut out, [*energy_excess]);
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
    out.extend((pair_springs.len() as u64).to_le_bytes());
    for PairSpring { first, second, kind, particle, other, stretch } in pair_springs {
        out.extend(first.to_le_bytes());
        out.extend(second.to_le_bytes());
        out.push(*kind as u8);
        out.extend(particle.to_le_bytes());
        out.extend(other.to_le_bytes());
        put(&mut out, stretch.to_array());
    }
    let RunTotals { drag, dashpot, slip, work, max_depth, evaluations } = *totals;
    put(&mut out, [drag, dashpot, slip, work, max_depth]);
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
    let pair_springs = pair_springs(&mut from)?;
    let totals = RunTotals {
        drag: from.f64()?,
        dashpot: from.f64()?,
        slip: from.f64()?,
        work: from.f64()?,
        max_depth: from.f64()?,
        evaluations: from.u64()?,
    };
    from.is_empty().then_some(State { step, time, bodies, springs, pair_springs, totals })
}

fn body(from: &mut Bytes) -> Option<BodyState> {
    Some(BodyState {
        position: vector(from)?,
        velocity: vector(from)?,
        orientation: quaternion(from)?,
        orientation_compensation: quaternion(from)?,
        angular_momentum: vector(from)?,
        energy_excess: from.f64()?,
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

fn pair_springs(from: &mut Bytes) -> Option<Vec<PairSpring>> {
    let count = from.count(PAIR)?;
    let spring = |_| {
        Some(PairSpring {
            first: from.u32()?,
            second: from.u32()?,
            kind: *KINDS.get(usize::from(from.take(1)?[0]))?,
            particle: from.u32()?,
            other: from.u32()?,
            stretch: vector(from)?,
        })
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
