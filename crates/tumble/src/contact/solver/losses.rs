//! The account of the energy that the contacts take.
//!
//! A contact takes the work of its impulse, −p·(u⁻ + u⁺)/2, from the bodies. Part of it is stored: the change of the energy of its springs
//! from the beginning to the end of the step, with the gap and the stretch that the velocities lead to. Part is lost to dashpots and
//! slip. The rest is the error of the implicit law, *numerical*: none at s = 0 while the contact is closed, and at s = 1 the damping of
//! what the step does not resolve.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

use super::bodies::{LaneInertia, LaneMotion, SolverBody, Velocities};
use super::law::{Step, Weights, relative_acceleration, relative_velocity};
use super::rows::{Pack, Row, RowLaw};
use crate::RunTotals;
use crate::lanes::{Columns, LANES, Vec3x8, largest, positive, sum};

/// Impulses on the first bodies of a pack, their torques about the centres of mass of these, and of the second bodies.
pub(super) type PackImpulses = [Columns; 3];

/// Sums the impulses and losses of a pack, and sets the stretches after the kick.
#[inline(always)]
pub(super) fn account<S: Simd>(
    simd: S,
    pack: &Pack,
    (rows, laws): (&[Row], &mut [RowLaw]),
    (bodies, velocities): (&[SolverBody], &[Velocities]),
    step: Step,
) -> (PackImpulses, RunTotals) {
    let motion = [
        LaneMotion::gather(simd, velocities, &pack.first),
        LaneMotion::gather(simd, velocities, &pack.second),
    ];
    let zero = f64x8::splat(simd, 0.0);
    let zeros = Vec3x8::splat(simd, DVec3::ZERO);
    let acceleration = relative_acceleration(simd, pack, bodies);
    let mut sums = Sums { dashpot: zero, slip: zero, numerical: zero, belt: zero, depth: zero };
    let (mut impulse, mut torques) = (zeros, [zeros; 2]);
    for (row, law) in rows.iter().zip(laws) {
        let (normal, tangential) = sums.add(simd, row, law, &motion, acceleration, step);
        impulse += Vec3x8::load(simd, &row.normal) * normal + tangential;
        torques[0] += Vec3x8::load(simd, &row.levers[0]) * normal
            + Vec3x8::load(simd, &row.arms[0]).cross(tangential);
        torques[1] += Vec3x8::load(simd, &row.levers[1]) * normal
            + Vec3x8::load(simd, &row.arms[1]).cross(tangential);
    }
    // what bodies with prescribed motion push with
    let is_prescribed =
        |index: usize| LaneInertia::load(simd, &pack.inertia[index]).inverse_mass.simd_eq(zero);
    let [first, second] = &motion;
    let power = impulse.dot(first.velocity) + torques[0].dot(first.angular_velocity);
    let other_power = impulse.dot(second.velocity) + torques[1].dot(second.angular_velocity);
    let work = is_prescribed(1).select(other_power, zero) - is_prescribed(0).select(power, zero);
    let losses = RunTotals {
        dashpot: sum(sums.dashpot),
        slip: sum(sums.slip),
        numerical: sum(sums.numerical),
        work: sum(work - sums.belt),
        max_depth: largest(sums.depth),
        ..RunTotals::default()
    };
    let [torque, other_torque] = torques;
    ([impulse.store(), torque.store(), other_torque.store()], losses)
}

/// Sums over the rows of each lane (J, and m for the depth).
struct Sums<S: Simd> {
    dashpot: f64x8<S>,
    slip: f64x8<S>,
    numerical: f64x8<S>,
    /// Power of the surface velocities, times the step.
    belt: f64x8<S>,
    depth: f64x8<S>,
}

impl<S: Simd> Sums<S> {
    /// Adds a row; returns its impulses.
    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        row: &Row,
        law: &mut RowLaw,
        motion: &[LaneMotion<S>; 2],
        acceleration: Vec3x8<S>,
        step: Step,
    ) -> (f64x8<S>, Vec3x8<S>) {
        let load = |values: &[f64; LANES]| f64x8::simd_from(simd, *values);
        let n = Vec3x8::load(simd, &row.normal);
        let (after, sliding) = relative_velocity(simd, row, motion);
        let surface = Vec3x8::load(simd, &law.surface_velocity);
        let sliding = sliding + surface;
        let along = acceleration.dot(n);
        let across = acceleration - n * along;
        let contact = Contact {
            weights: Weights::new(simd, load(&law.implicitness)),
            h: f64x8::splat(simd, step.length),
            zero: f64x8::splat(simd, 0.0),
            half: f64x8::splat(simd, 0.5),
        };
        let (normal, tangential) =
            (load(&row.impulse), Vec3x8::load(simd, &row.tangential_impulse));
        self.depth = {
            let depth = contact.zero - load(&law.gap);
            depth.simd_gt(self.depth).select(depth, self.depth)
        };

        let is_rebound = load(&row.rebound).simd_gt(contact.zero);
        let [dashpot, numerical] = contact.normal(simd, row, law, (after, along), is_rebound);
        // the gap at the next kick
        let next = contact.gap_at_next_kick(load(&law.gap), after, along);
        let one = f64x8::splat(simd, 1.0);
        let keeps = normal.simd_gt(contact.zero) & next.simd_lt(contact.zero);
        law.keeps_spring = keeps.select(one, contact.zero).into();
        let slides = Vec3x8::load(simd, &law.sliding);
        let [friction_dashpot, slip, friction_numerical] =
            contact.tangential(simd, row, law, (slides, sliding), across);
        self.dashpot = self.dashpot + dashpot + friction_dashpot;
        self.slip += slip;
        self.numerical = self.numerical + numerical + friction_numerical;
        self.belt += tangential.dot(surface);
        (normal, tangential)
    }
}

/// What the account of a contact needs.
struct Contact<S: Simd> {
    weights: Weights<S>,
    h: f64x8<S>,
    zero: f64x8<S>,
    half: f64x8<S>,
}

impl<S: Simd> Contact<S> {
    /// Gap or stretch at the beginning and the end of the step, from those at the kick and the velocities before and after it.
    #[inline(always)]
    fn ends(
        &self,
        [start, end]: [f64x8<S>; 2],
        [before, after]: [f64x8<S>; 2],
        acceleration: f64x8<S>,
    ) -> [f64x8<S>; 2] {
        let half = self.h * self.half;
        let fall = acceleration * half * half * self.half;
        [start - before * half + fall, end + after * half + fall]
    }

    /// The gap at the next kick.
    #[inline(always)]
    fn gap_at_next_kick(&self, gap: f64x8<S>, after: f64x8<S>, acceleration: f64x8<S>) -> f64x8<S> {
        gap + self.h * after + acceleration * self.h * self.h * self.half
    }

    /// What the dashpot and the error take.
    #[inline(always)]
    fn normal(
        &self,
        simd: S,
        row: &Row,
        law: &RowLaw,
        (after, acceleration): (f64x8<S>, f64x8<S>),
        is_rebound: fearless_simd::mask64x8<S>,
    ) -> [f64x8<S>; 2] {
        let load = |values: &[f64; LANES]| f64x8::simd_from(simd, *values);
        let (impulse, gap, before) = (load(&row.impulse), load(&law.gap), load(&row.approach));
        let work = self.zero - impulse * (before + after) * self.half;
        let ends = self.ends([gap, gap], [before, after], acceleration);
        let [start, end] = ends;
        let start = positive(simd, self.zero - start);
        let end = positive(simd, self.zero - end);
        let stored = load(&law.stiffness) * self.half * (end * end - start * start);
        let velocity = self.weights.velocity(self.h, (before, after), acceleration);
        let by_law = self.h * load(&law.damping) * velocity * velocity;
        let pushes = impulse.simd_gt(self.zero);
        let rest = work - stored;
        // a dashpot that holds the spring back takes what the spring releases
        let is_damped = load(&law.damping).simd_gt(self.zero);
        let released = is_damped.select(positive(simd, rest), self.zero);
        let dashpot = is_rebound.select(positive(simd, rest), by_law);
        let dashpot = pushes.select(dashpot, released);
        [dashpot, rest - dashpot]
    }

    /// What the dashpot, slip and the error take; sets the stretch after the kick.
    #[inline(always)]
    fn tangential(
        &self,
        simd: S,
        row: &Row,
        law: &mut RowLaw,
        (before, after): (Vec3x8<S>, Vec3x8<S>),
        acceleration: Vec3x8<S>,
    ) -> [f64x8<S>; 3] {
        let load = |values: &[f64; LANES]| f64x8::simd_from(simd, *values);
        let k = load(&law.friction_spring);
        let (impulse, stretch) =
            (Vec3x8::load(simd, &row.tangential_impulse), Vec3x8::load(simd, &law.stretch));
        let one = f64x8::splat(simd, 1.0);
        let closing = load(&law.closing);
        let weights = self.weights.closing(simd, closing);
        let mean = weights.stretch(self.h, stretch, (before, after), acceleration);
        // the spring is held at the limit of its own force, and the dashpot takes what remains of the impulse
        let limit = load(&row.friction) * load(&row.impulse) / self.h;
        let tension = k * mean.dot(mean).sqrt();
        let slips = tension.simd_gt(limit);
        let share = slips.select(limit / tension, one);
        let slipped = mean * (one - share);
        let spring = mean * (self.zero - k * share);
        // of a contact that closes, the stretch at the end is 2/φ times the mean, and slips under 1/φ times the mean force
        let is_closing = closing.simd_gt(self.zero);
        let part = is_closing.select(closing, one);
        let slip_path = slipped * is_closing.select((one + one) / part, one);
        let held = stretch - slip_path;
        law.stretch = held.store();

        let work = self.zero - impulse.dot(before + after) * self.half;
        let [x0, x1] = self.ends([stretch.x, held.x], [before.x, after.x], acceleration.x);
        let [y0, y1] = self.ends([stretch.y, held.y], [before.y, after.y], acceleration.y);
        let [z0, z1] = self.ends([stretch.z, held.z], [before.z, after.z], acceleration.z);
        let pushes = load(&row.impulse).simd_gt(self.zero);
        let had_spring = load(&law.had_spring).simd_gt(self.zero);
        let before_kick = k * self.half * (x0 * x0 + y0 * y0 + z0 * z0);
        let before_kick = had_spring.select(before_kick, self.zero);
        // a contact that ends loses its spring
        let keeps = load(&law.keeps_spring).simd_gt(self.zero);
        let after_kick = k * self.half * (x1 * x1 + y1 * y1 + z1 * z1);
        let stored = keeps.select(after_kick, self.zero) - before_kick;
        let u = self.weights.sliding(self.h, (before, after), acceleration);
        let by_dashpot = impulse - spring * self.h;
        let is_damped = load(&law.friction_damping).simd_gt(self.zero) & pushes;
        let dashpot = positive(simd, self.zero - by_dashpot.dot(u));
        let dashpot = is_damped.select(dashpot, self.zero);
        let slip = (self.zero - spring.dot(slip_path)) / part;
        let slip = keeps.select(slip, positive(simd, work - stored - dashpot));
        [dashpot, slip, work - stored - dashpot - slip]
    }
}
