//! Coulomb friction: a tangential spring and dashpot, together at most μ times the normal force.
//!
//! The spring force is limited to μ F_n first, where its stretch is stored. The dashpot may use what remains of the limit.

use fearless_simd::{Simd, f64x8, prelude::*};

use crate::lanes::{Vec3x8, positive};

/// The stretch of eight springs that slip, each of length `limit`: they were at `old` at the latest kick, and would be at
/// `stretch` without the limit. `u` is the tangential velocity now.
///
/// A spring stretches until it reaches the limit, where its length is |ξ| = `limit`, and from then on obeys
/// ξ' = u − ξ (u·ξ)/ξ²: it turns into the direction of u. For a constant u, with ψ the angle between ξ and u and x = |u| t/|ξ|,
/// tan(ψ/2) decreases by the factor e⁻ˣ, which is 1/(1 + x + x²/2) here. If the direction of u changes at a constant rate, the
/// same holds for a direction between that in the middle of the flight and that now, x/(2 + x) of the way: the middle while the spring
/// takes many steps to turn, and the direction now where it follows at once. So the direction of slip is of second
/// order. The scaling of `stretch` to the limit would be of first order.
#[inline(always)]
pub(in crate::contact) fn slip<S: Simd>(
    simd: S,
    old: Vec3x8<S>,
    stretch: Vec3x8<S>,
    limit: f64x8<S>,
    u: Vec3x8<S>,
) -> Vec3x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let path = stretch - old;
    // the part of the path within the limit; none where the spring is beyond it all the way
    let a = path.dot(path);
    let b = old.dot(path);
    let square = b * b - a * (old.dot(old) - limit * limit);
    let root = (positive(simd, square).sqrt() - b) / a;
    let is_crossing = square.simd_gt(zero) & root.simd_gt(zero) & root.simd_lt(one);
    let within = is_crossing.select(root, zero);
    let start = unit(simd, old + path * within);
    // the length is that at the limit throughout, which changes with the normal force
    let length = (old.dot(old).sqrt() + limit) * 0.5;
    // with r = 1/(1 + x) both factors are free of singularities
    let rest = a.sqrt() * (one - within);
    let r = length.simd_gt(zero).select(length / (length + rest), zero);
    let decrease = r * r * 2.0 / (r * r + 1.0);
    let weight = (one - r) / (one + r);
    let (middle, now) = (unit(simd, path), unit(simd, u));
    // the velocity may just have been reversed: then slip is about to end
    let weight = middle.dot(now).simd_gt(zero).select(weight, zero);
    let direction = unit(simd, middle + (now - middle) * weight);
    // tan(ψ/2) = sin ψ/(1 + cos ψ), in a form that has no singularity at ψ = π
    let cos = start.dot(direction);
    let across = start - direction * cos;
    let plus = one + cos;
    let minus = (one - cos) * decrease * decrease;
    let scale = (plus + minus).simd_gt(zero).select(limit / (plus + minus), zero);
    (direction * (plus - minus) + across * (decrease * 2.0)) * scale
}

/// Unit vectors; zero stays zero.
#[inline(always)]
fn unit<S: Simd>(simd: S, vectors: Vec3x8<S>) -> Vec3x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let length = vectors.dot(vectors).sqrt();
    vectors * length.simd_gt(zero).select(f64x8::splat(simd, 1.0) / length, zero)
}

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
