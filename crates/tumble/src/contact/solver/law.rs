//! The contact law as a condition on the velocity after the kick.
//!
//! At the kick, in the middle of a step h, let g be the gap (negative inside), u⁻ and u⁺ the relative normal velocities before and after
//! it, and a the relative acceleration without contact. With s between 0 (the force in the middle of the step) and 1 (at its end),
//! α = (1 + 3 s)/4, β = (1 − s)/4 and θ = (1 + s)/2, the impulse is
//!
//! > p = h max(0, −k [g + h (α u⁺ − β u⁻) + ⅛ (1 + 2 s) a h²] − c [θ (u⁺ + ½ a h) + (1 − θ) (u⁻ − ½ a h)]).
//!
//! At s = 0 the spring force is the mean of those at the beginning and the end of the step, so that a linear contact conserves energy;
//! where it closes or opens in between, [`super::normal_impulse`] does so. At s = 1 it is that at the next kick, less ⅛ a h², which damps what
//! the step does not resolve. At rest, u⁺ = −u⁻ = −½ a h, the bracket is the gap at the ends of the step for any s and h, so that bodies rest
//! as deep as their weight asks for, in steps of any length. Friction is the same with k_t, c_t and the stretch ξ, and ends at |p_t| = μ p.
//!
//! The dashpot acts while the points touch: c is multiplied by the part of the step in which they do.
//!
//! An impact that the step does not resolve ([`RESOLVED`]) rebounds at once, with the coefficient of restitution of its dashpots:
//! u⁺ ≥ −e u⁻ (J. J. Moreau, in *Nonsmooth Mechanics and Applications*, Springer 1988).

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

use super::super::patch_damping::{DampingTimes, Patch};
use super::bodies::{LaneInertia, LaneMotion, SolverBody, Velocities};
use super::rows::{Pack, Row, RowLaw};
use crate::lanes::{Columns, LANES, Vec3x8, positive, set, vector};
use crate::{ContactLaw, restitution};

/// The number of steps that an impact must last for the law of springs and dashpots to give its rebound, and what a restitution that is
/// asked for adds to it per damping ratio, for an error of 3 % at most.
const RESOLVED: [f64; 2] = [2.0, 14.0];
/// The slope of a law that lets nothing slide, times the mobility.
const STIFF: f64 = 1e9;
/// s is 0 below the first of these values of K h²/m, and 1 above the second.
const RAMP: [f64; 2] = [4.0, 20.0];

/// What all rows have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// The length h of the step (s).
    pub length: f64,
    /// The speed (m/s) up to which a contact is at rest and does not rebound: that of a body after two steps of fall.
    pub rest_speed: f64,
}

/// Sums over the rows of each lane.
struct LanePatch {
    patches: [Patch; LANES],
    /// Σ c of the dashpots as given.
    damping: [f64; LANES],
}

/// Computes the coefficients of the rows of a pack from the velocities before the kick.
#[inline(always)]
pub(super) fn prepare<S: Simd>(
    simd: S,
    pack: &Pack,
    (rows, laws): (&mut [Row], &mut [RowLaw]),
    (bodies, velocities): (&[SolverBody], &[Velocities]),
    step: Step,
) {
    let inertia =
        [LaneInertia::load(simd, &pack.inertia[0]), LaneInertia::load(simd, &pack.inertia[1])];
    let motion = [
        LaneMotion::gather(simd, velocities, &pack.first),
        LaneMotion::gather(simd, velocities, &pack.second),
    ];
    for (row, law) in rows.iter_mut().zip(&mut *laws) {
        velocities_before(simd, row, law, &motion);
    }
    let patch = LanePatch::new(simd, rows, laws, &inertia, step);
    let mut times = [DampingTimes::default(); LANES];
    let mut ratio = [0.0; LANES];
    for lane in 0..LANES {
        let sums = &patch.patches[lane];
        ratio[lane] = sums.stiffness * sums.inverse_mass * step.length * step.length;
        times[lane] = sums.damping_times(&pack.law(lane));
    }
    let [low, high] = RAMP.map(|limit| f64x8::splat(simd, limit));
    let implicitness = (f64x8::simd_from(simd, ratio) - low) / (high - low);
    let one = f64x8::splat(simd, 1.0);
    let implicitness = positive(simd, one - positive(simd, one - implicitness));
    let lanes = LaneConstants {
        implicitness,
        normal_time: f64x8::simd_from(simd, times.map(|times| times.normal)),
        tangential_time: f64x8::simd_from(simd, times.map(|times| times.tangential)),
        acceleration: relative_acceleration(simd, pack, bodies),
        inertia,
        step,
    };
    for (row, law) in rows.iter_mut().zip(&mut *laws) {
        lanes.coefficients(simd, row, law);
    }
    set_rebounds(simd, pack, rows, laws, &patch, &ratio, step);
}

impl Pack {
    /// The part of the law that decides the dashpots of a patch.
    fn law(&self, lane: usize) -> ContactLaw {
        ContactLaw {
            stiffness: 0.0,
            damping: 0.0,
            damping_ratio: self.damping_ratio[lane],
            asked_damping_ratio: self.asked_damping_ratio[lane],
            friction: 0.0,
            friction_spring: 0.0,
            friction_damping: 0.0,
            friction_damping_factor: self.friction_damping_factor[lane],
        }
    }
}

/// Velocity of the first body relative to the second at the contact: along the normal, and along the surfaces (m/s).
#[inline(always)]
pub(super) fn relative_velocity<S: Simd>(
    simd: S,
    row: &Row,
    motion: &[LaneMotion<S>; 2],
) -> (f64x8<S>, Vec3x8<S>) {
    let n = Vec3x8::load(simd, &row.normal);
    let arm = Vec3x8::load(simd, &row.arms[0]);
    let other_arm = Vec3x8::load(simd, &row.arms[1]);
    let lever = Vec3x8::load(simd, &row.levers[0]);
    let other_lever = Vec3x8::load(simd, &row.levers[1]);
    let [first, second] = motion;
    let between = first.velocity - second.velocity;
    let normal = between.dot(n) + first.angular_velocity.dot(lever)
        - second.angular_velocity.dot(other_lever);
    let u = between + first.angular_velocity.cross(arm) - second.angular_velocity.cross(other_arm);
    (normal, u.perpendicular_to(n))
}

#[inline(always)]
fn velocities_before<S: Simd>(
    simd: S,
    row: &mut Row,
    law: &mut RowLaw,
    motion: &[LaneMotion<S>; 2],
) {
    let (normal, tangential) = relative_velocity(simd, row, motion);
    row.approach = normal.into();
    law.sliding = (tangential + Vec3x8::load(simd, &law.surface_velocity)).store();
}

/// Acceleration of the first bodies relative to the second, without contact (m/s²).
#[inline(always)]
pub(super) fn relative_acceleration<S: Simd>(
    simd: S,
    pack: &Pack,
    bodies: &[SolverBody],
) -> Vec3x8<S> {
    let mut columns = Columns::default();
    for lane in 0..LANES {
        let of_body = |index: u32| bodies[index as usize].acceleration;
        set(&mut columns, lane, of_body(pack.first[lane]) - of_body(pack.second[lane]));
    }
    Vec3x8::load(simd, &columns)
}

impl LanePatch {
    /// The sums over the contacts that touch within the step, with the depths that they reach at the velocities before the kick.
    #[inline(always)]
    fn new<S: Simd>(
        simd: S,
        rows: &[Row],
        laws: &[RowLaw],
        inertia: &[LaneInertia<S>; 2],
        step: Step,
    ) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let (mut stiffness, mut friction_spring, mut force, mut deepest, mut damping) =
            (zero, zero, zero, zero, zero);
        let zeros = Vec3x8::splat(simd, DVec3::ZERO);
        let (mut total, mut torques) = (zeros, [zeros; 2]);
        let h = f64x8::splat(simd, step.length);
        for (row, law) in rows.iter().zip(laws) {
            let load = |values: &[f64; LANES]| f64x8::simd_from(simd, *values);
            let approach = zero - positive(simd, zero - load(&row.approach));
            let depth = positive(simd, zero - load(&law.gap) - approach * h);
            let touches = depth.simd_gt(zero);
            let k = load(&law.stiffness);
            let size = k * depth;
            stiffness += touches.select(k, zero);
            friction_spring += touches.select(load(&law.friction_spring), zero);
            damping += touches.select(load(&law.damping), zero);
            force += size;
            deepest = depth.simd_gt(deepest).select(depth, deepest);
            total += Vec3x8::load(simd, &row.normal) * size;
            for (torque, lever) in torques.iter_mut().zip(&row.levers) {
                *torque += Vec3x8::load(simd, lever) * size;
            }
        }
        // where normals diverge, part of F cancels
        let reduced = inertia[0].inverse_mass + inertia[1].inverse_mass;
        let mut mobility = reduced * total.dot(total);
        for (inertia, torque) in inertia.iter().zip(torques) {
            mobility += torque.dot(inertia.turned(torque));
        }
        let inverse_mass = mobility / (force * force);
        let inverse_mass = inverse_mass.simd_gt(reduced).select(inverse_mass, reduced);
        let store = |lanes: f64x8<S>| <[f64; LANES]>::from(lanes);
        let (stiffness, friction_spring) = (store(stiffness), store(friction_spring));
        let (force, max_depth, inverse_mass) = (store(force), store(deepest), store(inverse_mass));
        let patches = std::array::from_fn(|lane| Patch {
            stiffness: stiffness[lane],
            friction_spring: friction_spring[lane],
            force: force[lane],
            max_depth: max_depth[lane],
            inverse_mass: inverse_mass[lane],
        });
        Self { patches, damping: store(damping) }
    }
}

impl LanePatch {
    /// The damping ratio of the whole patch: that which is asked for, and that of the dashpots as given.
    #[inline(always)]
    fn damping_ratio<S: Simd>(&self, simd: S, pack: &Pack) -> f64x8<S> {
        let load = |values: [f64; LANES]| f64x8::simd_from(simd, values);
        let (zero, half) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 0.5));
        let stiffness = load(self.patches.map(|patch| patch.stiffness));
        let mobility = load(self.patches.map(|patch| patch.inverse_mass));
        let given = half * load(self.damping) * (mobility / stiffness).sqrt();
        load(pack.damping_ratio) + stiffness.simd_gt(zero).select(given, zero)
    }
}

/// What the contacts of each lane have in common.
struct LaneConstants<S: Simd> {
    /// s.
    implicitness: f64x8<S>,
    /// Damping over stiffness (s), see [`DampingTimes`].
    normal_time: f64x8<S>,
    tangential_time: f64x8<S>,
    acceleration: Vec3x8<S>,
    inertia: [LaneInertia<S>; 2],
    step: Step,
}

impl<S: Simd> LaneConstants<S> {
    #[inline(always)]
    fn coefficients(&self, simd: S, row: &mut Row, law: &mut RowLaw) {
        let load = |values: &[f64; LANES]| f64x8::simd_from(simd, *values);
        let splat = |value: f64| f64x8::splat(simd, value);
        let (s, h) = (self.implicitness, splat(self.step.length));
        law.implicitness = s.into();
        let n = Vec3x8::load(simd, &row.normal);
        let touching = self.touching(simd, row, law);
        let c = (load(&law.damping) + load(&law.stiffness) * self.normal_time) * touching;
        let spring = load(&law.friction_spring);
        let c_t = (load(&law.friction_damping) + spring * self.tangential_time) * touching;
        (law.damping, law.friction_damping) = (c.into(), c_t.into());
        let weights = Weights::new(simd, s);
        let along = self.acceleration.dot(n);
        let across = self.acceleration - n * along;

        let k = load(&law.stiffness);
        let normal = weights.law(h, k, c);
        let offset = normal.constant(load(&law.gap), load(&row.approach), along);
        let mobility = self.normal_mobility(simd, row);
        row.slope = normal.slope.into();
        row.offset = offset.into();
        row.normal_mobility = mobility.into();
        row.normal_factor = (splat(1.0) / (splat(1.0) + normal.slope * mobility)).into();
        row.rebound = [f64::NEG_INFINITY; LANES];
        self.ends(simd, row, law, along);

        self.first_stretch(simd, row, law, touching);
        let tangential = weights.closing(simd, load(&law.closing)).law(h, spring, c_t);
        let (stretch, sliding) =
            (Vec3x8::load(simd, &law.stretch), Vec3x8::load(simd, &law.sliding));
        let slope = tangential.slope;
        let surface = Vec3x8::load(simd, &law.surface_velocity) * slope;
        let offset = Vec3x8 {
            x: tangential.constant(stretch.x, sliding.x, across.x),
            y: tangential.constant(stretch.y, sliding.y, across.y),
            z: tangential.constant(stretch.z, sliding.z, across.z),
        };
        let mobility = self.tangential_mobility(simd, row, n);
        row.tangential_slope = slope.into();
        row.tangential_offset = (offset - surface).store();
        row.tangential_mobility = mobility.into();
        row.tangential_factor = (splat(1.0) / (splat(1.0) + slope * mobility)).into();
    }

    /// What is needed where the contact closes or opens within the step: at s = 0 only, since the end of the step is what counts at s = 1.
    #[inline(always)]
    fn ends(&self, simd: S, row: &mut Row, law: &RowLaw, acceleration: f64x8<S>) {
        let load = |values: &[f64; LANES]| f64x8::simd_from(simd, *values);
        let splat = |value: f64| f64x8::splat(simd, value);
        let half = splat(0.5 * self.step.length);
        let (gap, fall) = (load(&law.gap), acceleration * half * half * splat(0.5));
        let start = gap - load(&row.approach) * half + fall;
        let is_middle = self.implicitness.simd_le(splat(0.0));
        row.start_gap = is_middle.select(start, splat(f64::NAN)).into();
        row.end_gap = (gap + fall).into();
        row.half_step = half.into();
        row.half_stiffness = (load(&law.stiffness) * half).into();
        row.half_damping = (load(&law.damping) * half).into();
    }

    /// The stretch of the friction spring of a contact that closes within the step, at the kick: what it will be at the end of the step less
    /// what it gains until then, and so the opposite of a stretch if the contact closes after the kick.
    #[inline(always)]
    fn first_stretch(&self, simd: S, row: &Row, law: &mut RowLaw, touching: f64x8<S>) {
        let load = |values: &[f64; LANES]| f64x8::simd_from(simd, *values);
        let zero = f64x8::splat(simd, 0.0);
        let is_new = load(&law.had_spring).simd_le(zero) & load(&law.friction_spring).simd_gt(zero);
        let closes = is_new & load(&row.start_gap).simd_gt(zero) & touching.simd_gt(zero);
        let closing = closes.select(touching, zero);
        law.closing = closing.into();
        let age = (touching - f64x8::splat(simd, 0.5)) * f64x8::splat(simd, self.step.length);
        let first = Vec3x8::load(simd, &law.sliding) * age;
        let stretch = Vec3x8::select(closes, first, Vec3x8::load(simd, &law.stretch));
        law.stretch = stretch.store();
    }

    /// The part of the step in which the points touch, at the velocity before the kick.
    #[inline(always)]
    fn touching(&self, simd: S, row: &Row, law: &RowLaw) -> f64x8<S> {
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        let (gap, approach) =
            (f64x8::simd_from(simd, law.gap), f64x8::simd_from(simd, row.approach));
        let path = approach.abs() * f64x8::splat(simd, self.step.length);
        let part = f64x8::splat(simd, 0.5) - gap / path;
        let part = positive(simd, part);
        let part = part.simd_gt(one).select(one, part);
        let without_approach = gap.simd_lt(zero).select(one, zero);
        path.simd_gt(zero).select(part, without_approach)
    }

    /// 1/m along the normal; 1 where nothing can move, so that there is something to divide by.
    #[inline(always)]
    fn normal_mobility(&self, simd: S, row: &Row) -> f64x8<S> {
        let [first, second] = &self.inertia;
        let lever = Vec3x8::load(simd, &row.levers[0]);
        let other = Vec3x8::load(simd, &row.levers[1]);
        or_one(simd, first.mobility(lever) + second.mobility(other))
    }

    /// The largest 1/m of all directions along the surfaces.
    #[inline(always)]
    fn tangential_mobility(&self, simd: S, row: &Row, n: Vec3x8<S>) -> f64x8<S> {
        let (t1, t2) = tangents(simd, n);
        let mut matrix = [f64x8::splat(simd, 0.0); 3];
        for (inertia, arm) in self.inertia.iter().zip(&row.arms) {
            let arm = Vec3x8::load(simd, arm);
            let (l1, l2) = (arm.cross(t1), arm.cross(t2));
            let turned = inertia.turned(l1);
            matrix[0] += inertia.inverse_mass + l1.dot(turned);
            matrix[1] += l2.dot(turned);
            matrix[2] += inertia.mobility(l2);
        }
        let half = f64x8::splat(simd, 0.5);
        let [xx, xy, yy] = matrix;
        let (mean, half_difference) = ((xx + yy) * half, (xx - yy) * half);
        or_one(simd, mean + (half_difference * half_difference + xy * xy).sqrt())
    }
}

#[inline(always)]
fn or_one<S: Simd>(simd: S, mobility: f64x8<S>) -> f64x8<S> {
    mobility.simd_gt(f64x8::splat(simd, 0.0)).select(mobility, f64x8::splat(simd, 1.0))
}

/// Two unit vectors perpendicular to n and each other (T. Duff et al., J. Comput. Graph. Tech. 6 (2017) 1).
#[inline(always)]
fn tangents<S: Simd>(simd: S, n: Vec3x8<S>) -> (Vec3x8<S>, Vec3x8<S>) {
    let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
    let sign = n.z.simd_lt(zero).select(zero - one, one);
    let a = (zero - one) / (sign + n.z);
    let b = n.x * n.y * a;
    (
        Vec3x8 { x: one + sign * n.x * n.x * a, y: sign * b, z: zero - sign * n.x },
        Vec3x8 { x: b, y: sign + n.y * n.y * a, z: zero - n.y },
    )
}

/// α, β, θ, 1 − θ, the weight of the fall, and the share of the whole that counts: 1 except in [`Weights::closing`].
#[derive(Clone, Copy)]
pub(super) struct Weights<S: Simd> {
    after: f64x8<S>,
    before: f64x8<S>,
    damped_after: f64x8<S>,
    damped_before: f64x8<S>,
    /// ⅛ (1 + 2 s).
    fall: f64x8<S>,
    share: f64x8<S>,
    half: f64x8<S>,
    zero: f64x8<S>,
}

impl<S: Simd> Weights<S> {
    #[inline(always)]
    pub fn new(simd: S, s: f64x8<S>) -> Self {
        let splat = |value: f64| f64x8::splat(simd, value);
        Self {
            after: (s * splat(3.0) + splat(1.0)) * splat(0.25),
            before: (splat(1.0) - s) * splat(0.25),
            damped_after: (splat(1.0) + s) * splat(0.5),
            damped_before: (splat(1.0) - s) * splat(0.5),
            fall: (s * splat(2.0) + splat(1.0)) * splat(0.125),
            share: splat(1.0),
            half: splat(0.5),
            zero: splat(0.0),
        }
    }

    /// The weights of the friction spring of a contact that is closed for the last part φ > 0 of the step, where `part` is not 0. The mean of
    /// its stretch over the step is ½ φ ξ₁, with the stretch ξ₁ at the end.
    #[inline(always)]
    pub fn closing(self, simd: S, part: f64x8<S>) -> Self {
        let is_closing = part.simd_gt(self.zero);
        Self {
            after: is_closing.select(self.half, self.after),
            before: is_closing.select(self.zero, self.before),
            fall: is_closing.select(f64x8::splat(simd, 0.125), self.fall),
            share: is_closing.select(part * self.half, self.share),
            ..self
        }
    }

    /// The law of a spring k and a dashpot c in a step h.
    #[inline(always)]
    fn law(self, h: f64x8<S>, k: f64x8<S>, c: f64x8<S>) -> LinearLaw<S> {
        let slope = h * (k * h * self.share * self.after + c * self.damped_after);
        LinearLaw { weights: self, h, k, c, slope }
    }

    /// The gap or stretch that the spring force is that of, from that at the kick.
    #[inline(always)]
    pub fn gap(
        &self,
        h: f64x8<S>,
        gap: f64x8<S>,
        (before, after): (f64x8<S>, f64x8<S>),
        acceleration: f64x8<S>,
    ) -> f64x8<S> {
        let path = h * (self.after * after - self.before * before);
        self.share * (gap + path + self.fall * acceleration * h * h)
    }

    /// [`Self::gap`] of a vector.
    #[inline(always)]
    pub fn stretch(
        &self,
        h: f64x8<S>,
        stretch: Vec3x8<S>,
        (before, after): (Vec3x8<S>, Vec3x8<S>),
        acceleration: Vec3x8<S>,
    ) -> Vec3x8<S> {
        Vec3x8 {
            x: self.gap(h, stretch.x, (before.x, after.x), acceleration.x),
            y: self.gap(h, stretch.y, (before.y, after.y), acceleration.y),
            z: self.gap(h, stretch.z, (before.z, after.z), acceleration.z),
        }
    }

    /// [`Self::velocity`] of a vector.
    #[inline(always)]
    pub fn sliding(
        &self,
        h: f64x8<S>,
        (before, after): (Vec3x8<S>, Vec3x8<S>),
        acceleration: Vec3x8<S>,
    ) -> Vec3x8<S> {
        Vec3x8 {
            x: self.velocity(h, (before.x, after.x), acceleration.x),
            y: self.velocity(h, (before.y, after.y), acceleration.y),
            z: self.velocity(h, (before.z, after.z), acceleration.z),
        }
    }

    /// The velocity that the dashpot sees.
    #[inline(always)]
    pub fn velocity(
        &self,
        h: f64x8<S>,
        (before, after): (f64x8<S>, f64x8<S>),
        acceleration: f64x8<S>,
    ) -> f64x8<S> {
        let change = self.half * acceleration * h;
        self.damped_after * (after + change) + self.damped_before * (before - change)
    }
}

/// p = b − a u⁺.
struct LinearLaw<S: Simd> {
    weights: Weights<S>,
    h: f64x8<S>,
    k: f64x8<S>,
    c: f64x8<S>,
    /// a.
    slope: f64x8<S>,
}

impl<S: Simd> LinearLaw<S> {
    /// b, for the gap or stretch at the kick, the velocity before it and the acceleration.
    #[inline(always)]
    fn constant(&self, gap: f64x8<S>, before: f64x8<S>, acceleration: f64x8<S>) -> f64x8<S> {
        let velocities = (before, self.weights.zero);
        let force = self.k * self.weights.gap(self.h, gap, velocities, acceleration)
            + self.c * self.weights.velocity(self.h, velocities, acceleration);
        self.weights.zero - self.h * force
    }
}

/// Sets the velocities of rebound of impacts that the step does not resolve.
fn set_rebounds<S: Simd>(
    simd: S,
    pack: &Pack,
    rows: &mut [Row],
    laws: &[RowLaw],
    patch: &LanePatch,
    ratio: &[f64; LANES],
    step: Step,
) {
    let damping_ratio = patch.damping_ratio(simd, pack);
    // ω h above π over the number of steps
    let [without_damping, by_damping] = RESOLVED.map(|steps| f64x8::splat(simd, steps));
    let asked = f64x8::simd_from(simd, pack.asked_damping_ratio);
    let steps = without_damping + by_damping * asked;
    let limit = f64x8::splat(simd, std::f64::consts::PI) / steps;
    let is_short = f64x8::simd_from(simd, *ratio).simd_gt(limit * limit);
    let damping_ratio: [f64; LANES] = damping_ratio.into();
    let mut coefficients = [f64::NAN; LANES];
    for (row, law) in rows.iter_mut().zip(laws) {
        let approach = f64x8::simd_from(simd, row.approach);
        let end = f64x8::simd_from(simd, law.gap) + approach * f64x8::splat(simd, step.length);
        let hits = approach.simd_lt(f64x8::splat(simd, -step.rest_speed))
            & end.simd_lt(f64x8::splat(simd, 0.0))
            & is_short;
        if !hits.any_true() {
            continue;
        }
        let hits: [f64; LANES] =
            hits.select(f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.0)).into();
        for lane in (0..LANES).filter(|&lane| hits[lane] > 0.0) {
            if coefficients[lane].is_nan() {
                coefficients[lane] = restitution(damping_ratio[lane]);
            }
            row.rebound[lane] = -coefficients[lane] * row.approach[lane];
            stick(row, law, lane);
        }
    }
}

/// The friction of an impact that the step does not resolve: it stops the sliding at once, within its limit. The spring would not have the time
/// to do so.
fn stick(row: &mut Row, law: &RowLaw, lane: usize) {
    let slope = STIFF / row.tangential_mobility[lane];
    row.tangential_slope[lane] = slope;
    row.tangential_factor[lane] = 1.0 / (1.0 + STIFF);
    set(&mut row.tangential_offset, lane, vector(&law.surface_velocity, lane) * -slope);
}
