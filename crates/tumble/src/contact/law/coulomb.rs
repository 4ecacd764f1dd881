//! Coulomb friction: a tangential spring and dashpot, together at most μ times the normal force.
//!
//! The spring force is limited to μ F_n first, where its stretch is stored. The dashpot may use what remains of the limit.

use fearless_simd::{Simd, f64x8, prelude::*};

use crate::lanes::{Vec3x8, positive};

/// The largest β in [0, 1] with |spring + β dashpot| ≤ limit: the fraction of the tangential dashpot that the limit μ F_n allows.
#[inline(always)]
pub(in crate::contact) fn dashpot_fraction<S: Simd>(
    simd: S,
    spring: Vec3x8<S>,
    dashpot: Vec3x8<S>,
    limit: f64x8<S>,
) -> f64x8<S> {
    // the larger root of |spring + β dashpot|² = limit²
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let a = dashpot.dot(dashpot);
    let b = spring.dot(dashpot);
    let c = positive(simd, limit * limit - spring.dot(spring));
    let root = positive(simd, b * b + a * c).sqrt();
    let beta = positive(simd, (root - b) / a);
    let beta = beta.simd_lt(one).select(beta, one);
    a.simd_gt(zero).select(beta, zero)
}
