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

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};
    use glam::{DMat3, DVec3};

    use super::*;
    use crate::lanes::{LANES, vector};

    /// Length of the springs (m) and speed of the slip (m/s).
    const LIMIT: f64 = 1e-3;
    const SPEED: f64 = 2.0;

    /// Slip velocity at a time (s); its direction turns by 30 rad/s.
    fn velocity(time: f64) -> DVec3 {
        DMat3::from_rotation_y(0.3 + 30.0 * time) * DVec3::X * SPEED
    }

    fn slipped(old: DVec3, stretch: DVec3, u: DVec3) -> DVec3 {
        dispatch!(Level::new(), simd => {
            let of = |v: DVec3| Vec3x8::splat(simd, v);
            let limit = f64x8::splat(simd, LIMIT);
            vector(&slip(simd, of(old), of(stretch), limit, of(u)).store(), LANES - 1)
        })
    }

    /// The stretch after `time` (s) in steps of `h` (s), from a right angle to the velocity.
    fn stepped(time: f64, h: f64) -> DVec3 {
        let mut stretch = DMat3::from_rotation_y(1.0) * velocity(0.0).normalize() * LIMIT;
        for step in 0..(time / h).round() as u32 {
            let t = f64::from(step) * h;
            stretch = slipped(stretch, stretch + velocity(t + 0.5 * h) * h, velocity(t + h));
            assert!((stretch.length() / LIMIT - 1.0).abs() < 1e-14);
        }
        stretch
    }

    /// The angle θ of ξ obeys θ' = (u/L) sin(φ − θ): tiny steps of the midpoint method.
    fn exact(time: f64) -> DVec3 {
        let (mut angle, count) = (1.3, 100_000);
        let h = time / f64::from(count);
        let rate = |t: f64, angle: f64| SPEED / LIMIT * libm::sin(0.3 + 30.0 * t - angle);
        for step in 0..count {
            let t = f64::from(step) * h;
            angle += h * rate(t + 0.5 * h, angle + 0.5 * h * rate(t, angle));
        }
        DMat3::from_rotation_y(angle) * DVec3::X * LIMIT
    }

    #[test]
    fn the_direction_of_slip_is_of_second_order() {
        let time = 1.6e-3;
        let error = |h: f64| (stepped(time, h) - exact(time)).length() / LIMIT;
        let order = libm::log2(error(1e-4) / error(5e-5));
        assert!((order - 2.0).abs() < 0.15, "{order}");
    }

    /// In steps in which it slips by many times its length, the spring follows the velocity at the end of the step, with
    /// the lag L/u of the exact solution.
    #[test]
    fn the_direction_of_slip_is_that_now_in_large_steps() {
        let h = 0.01;
        let lag =
            (stepped(0.1, h).normalize() - velocity(0.1 - LIMIT / SPEED).normalize()).length();
        assert!(lag < 0.01, "{lag}");
    }

    #[test]
    fn slip_is_finite_in_every_limit() {
        let reversed = slipped(DVec3::X * -LIMIT, DVec3::X * 0.1, DVec3::X);
        assert!((reversed - DVec3::X * LIMIT).length() < 1e-15, "{reversed}");
        // beyond a limit that has shrunk, at rest
        let shrunk = slipped(DVec3::X * 0.1, DVec3::X * 0.1, DVec3::ZERO);
        assert!((shrunk - DVec3::X * LIMIT).length() < 1e-15, "{shrunk}");
        // from no stretch
        let new = slipped(DVec3::ZERO, DVec3::Z * 0.1, DVec3::Z);
        assert!((new - DVec3::Z * LIMIT).length() < 1e-15, "{new}");
        // about to be reversed by the kick
        let last = slipped(DVec3::X * LIMIT, DVec3::X * 0.1, -DVec3::X);
        assert!((last - DVec3::X * LIMIT).length() < 1e-15, "{last}");
        let no_limit = dispatch!(Level::new(), simd => {
            let of = |v: DVec3| Vec3x8::splat(simd, v);
            let zero = f64x8::splat(simd, 0.0);
            vector(&slip(simd, of(DVec3::X), of(-DVec3::X), zero, of(DVec3::Z)).store(), 0)
        });
        assert_eq!(no_limit, DVec3::ZERO);
    }
}
