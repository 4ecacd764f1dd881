//! The normal impulse of a contact that closes or opens within the step.
//!
//! Let g₀ and g₁ be the gaps at the beginning and the end of the step. The spring force at s = 0 is the loss of the energy
//! V = ½ k min(g, 0)² over the path, F = −(V(g₁) − V(g₀))/(g₁ − g₀): the discrete gradient (O. Gonzalez, J. Nonlinear Sci. 6 (1996)
//! 449), with which an elastic impact conserves energy however few steps it lasts. While the contact is closed, F is the mean
//! −½ k (g₀ + g₁) and the law is linear. While it is open, F = 0. Otherwise a part of the path is in contact:
//!
//! > F = ½ k g₁²/(g₀ − g₁) while it closes, and F = ½ k g₀²/(g₁ − g₀) while it opens.
//!
//! The impulse is p = h F − h c ū with the mean velocity ū of the step, and g₁ = g + ½ h u⁺ + ⅛ a h² depends on it, so that g₁ is the root
//! of a quadratic equation.

use fearless_simd::{Simd, SimdMask, f64x8, prelude::*};

use super::rows::Row;
use crate::lanes::positive;

/// The impulse (N·s) that the law asks for, where `free` is the velocity (m/s) without the impulse of this contact.
#[inline(always)]
pub(super) fn normal_impulse<S: Simd>(simd: S, row: &Row, free: f64x8<S>) -> f64x8<S> {
    let load = |values| f64x8::simd_from(simd, values);
    let zero = f64x8::splat(simd, 0.0);
    let linear = (load(row.offset) - load(row.slope) * free) * load(row.normal_factor);
    let start = load(row.start_gap);
    let half_step = load(row.half_step);
    // g₁ = without + per_impulse p
    let without = load(row.end_gap) + half_step * free;
    let per_impulse = half_step * load(row.normal_mobility);
    let closes = start.simd_gt(zero);
    let opens = start.simd_le(zero) & (without + per_impulse * linear).simd_gt(zero);
    let meets = closes & without.simd_lt(zero);
    let impulse = closes.select(zero, linear);
    if !(opens | meets).any_true() {
        return positive(simd, impulse);
    }
    let partial =
        Partial { start, without, per_impulse, stiffness: load(row.half_stiffness), row, free };
    let impulse = meets.select(partial.closing(simd), impulse);
    positive(simd, opens.select(partial.opening(simd), impulse))
}

/// A contact that is closed for a part of the step.
struct Partial<'a, S: Simd> {
    /// g₀ (m).
    start: f64x8<S>,
    /// g₁ without the impulse (m), and its change by an impulse of 1 N·s (m/(N·s)).
    without: f64x8<S>,
    per_impulse: f64x8<S>,
    /// ½ k h (N·s/m).
    stiffness: f64x8<S>,
    row: &'a Row,
    free: f64x8<S>,
}

impl<S: Simd> Partial<'_, S> {
    /// p (1 + `factor`) = h F − `impulse`: what the dashpot takes.
    #[inline(always)]
    fn dashpot(&self, simd: S) -> (f64x8<S>, f64x8<S>) {
        let damping = f64x8::simd_from(simd, self.row.half_damping);
        let approach = f64x8::simd_from(simd, self.row.approach);
        let mobility = f64x8::simd_from(simd, self.row.normal_mobility);
        (damping * mobility, damping * (self.free + approach))
    }

    /// p = (d₁ less `without`)/`per_impulse`, with the depth d₁ = −g₁ from
    /// (½ k h + m) d₁² + (m g₀ − q) d₁ − q g₀ = 0, where m is the impulse per m of g₁ and q the impulse that is left at g₁ = 0.
    #[inline(always)]
    fn closing(&self, simd: S) -> f64x8<S> {
        let one = f64x8::splat(simd, 1.0);
        let (factor, taken) = self.dashpot(simd);
        let m = (one + factor) / self.per_impulse;
        let q = taken - self.without * m;
        let depth = root(simd, self.stiffness + m, m * self.start - q, q * self.start);
        // without a root the dashpot alone stops the bodies at the first touch
        (f64x8::splat(simd, 0.0) - self.without - positive(simd, depth)) / self.per_impulse
    }

    /// The same with the path y = g₁ − g₀ from m y² + (q − m (`without` − g₀)) y − ½ k h g₀² = 0.
    #[inline(always)]
    fn opening(&self, simd: S) -> f64x8<S> {
        let one = f64x8::splat(simd, 1.0);
        let (factor, taken) = self.dashpot(simd);
        let m = (one + factor) / self.per_impulse;
        let path = self.without - self.start;
        let y = root(simd, m, taken - m * path, self.stiffness * self.start * self.start);
        (y - path) / self.per_impulse
    }
}

/// The larger root of a x² + b x − c = 0, for a > 0; 0 where there is none.
#[inline(always)]
fn root<S: Simd>(simd: S, a: f64x8<S>, b: f64x8<S>, c: f64x8<S>) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let (two, four) = (f64x8::splat(simd, 2.0), f64x8::splat(simd, 4.0));
    let square = positive(simd, b * b + four * a * c).sqrt();
    // the form without cancellation
    let is_positive = b.simd_gt(zero);
    let numerator = is_positive.select(two * c, square - b);
    let denominator = is_positive.select(b + square, two * a);
    numerator / denominator
}
