//! The free rotation of a rigid body, exact to rounding at any step.
//!
//! In principal axes the unit vector u = Rᵀ L/|L| obeys u' = u × ω with ω = |L| I⁻¹ u: Euler's equations.
//! Their right-hand side is a product of components, so the Taylor coefficients of u follow from
//! each other by convolution, and a step that turns u by a fraction of a radian needs a handful of them.
//!
//! The orientation then needs one more number. The rotation of the body over the time t is the
//! shortest one that takes u(t) back to u₀, followed by one about u₀ by an angle ψ with
//!
//! ψ' = (u + u₀)·ω / (1 + u·u₀),
//!
//! whose Taylor coefficients follow by division. Nothing in this depends on a step size but
//! rounding, and nothing is special about symmetric, spherical, flat or line-like bodies or about
//! the separatrix.
//!
//! A step of many turns is cut into pieces. One of very many is first cut by the period of u, which
//! is a complete elliptic integral: after it u is back, and the body has turned about L by a fixed
//! angle (R. Montgomery, *How much does the rigid body rotate?*, Am. J. Phys. 59 (1991) 394). Another way to
//! the same end are elliptic and theta functions: R. van Zon & J. Schofield, J. Comput. Phys. 225 (2007) 145;
//! E. Celledoni, F. Fassò, N. Säfström & A. Zanna, SIAM J. Sci. Comput. 30 (2008) 2084.

use glam::DVec3;

use super::small_turn::small_turn;

/// λ t of a piece, so that its series converges fast.
const PIECE: f64 = 0.25;
/// Coefficients kept at most; a piece needs fewer.
const ORDER: usize = 20;
/// Pieces in a step from which on it pays to take whole periods out.
const MANY_PIECES: f64 = 256.0;
/// Distance from the separatrix, squared and relative, below which u counts as this far from it.
const NEAREST: f64 = 1e-300;

/// A rotation minus the identity: small ones keep all their digits.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Scalar part minus 1.
    pub scalar: f64,
    /// Vector part.
    pub vector: DVec3,
}

impl Turn {
    const NONE: Self = Self { scalar: 0.0, vector: DVec3::ZERO };

    /// By `angle` (rad) about a unit `axis`.
    fn about(axis: DVec3, angle: f64) -> Self {
        let (sin, cos) = libm::sincos(0.5 * angle);
        // cos − 1 without cancellation where the angle is small
        let scalar = if cos > 0.5 { -sin * sin / (1.0 + cos) } else { cos - 1.0 };
        Self { scalar, vector: axis * sin }
    }

    /// This turn after `first`.
    fn after(self, first: Self) -> Self {
        let (a, b) = (self, first);
        Self {
            scalar: a.scalar + b.scalar + a.scalar * b.scalar - a.vector.dot(b.vector),
            vector: a.vector
                + b.vector
                + a.scalar * b.vector
                + b.scalar * a.vector
                + a.vector.cross(b.vector),
        }
    }
}

/// How a body with the principal inverse moments `inverse` (1/(kg·m²), zero for an axis without
/// inertia) and the angular momentum `momentum` (kg·m²/s, principal axes) turns in `time` (s):
/// R(time) = R(0) · turn, in principal axes.
#[inline]
pub fn free_rotation(inverse: DVec3, momentum: DVec3, time: f64) -> Turn {
    small_turn(inverse, momentum, time).unwrap_or_else(|| any_turn(inverse, momentum, time))
}

/// [`free_rotation`], however far.
pub(super) fn any_turn(inverse: DVec3, momentum: DVec3, time: f64) -> Turn {
    let length = length(momentum);
    if length == 0.0 || time == 0.0 {
        return Turn::NONE;
    }
    let euler = Euler::new(inverse, length);
    let mut u = momentum / length;
    let start = u;
    if euler.stands(u) {
        return Turn::about(u, euler.spin.dot(u * u) * time);
    }
    let mut rest = time;
    let mut turn = Turn::NONE;
    let pace = euler.pace(u);
    if pace.rate * time.abs() > MANY_PIECES * PIECE {
        let period = pace.period();
        if period < time.abs() {
            rest = libm::fmod(time, period);
            let periods = (time / period).trunc();
            turn = Turn::about(start, euler.angle_of_period(u, pace.rate, period) * periods);
        }
    }
    let pieces = (pace.rate * rest.abs() / PIECE).ceil().max(1.0);
    for _ in 0..pieces as u64 {
        let (piece, end) = euler.piece(u, rest / pieces);
        turn = turn.after(piece);
        u = end;
    }
    turn
}

/// Length without overflow or underflow of the squares.
fn length(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    if largest == 0.0 { 0.0 } else { (v / largest).length() * largest }
}

/// Euler's equations of one body at one length of L.
struct Euler {
    /// |L| I⁻¹ (rad/s): ω = spin · u by components.
    spin: DVec3,
    /// (s_z − s_y, s_x − s_z, s_y − s_x) of `spin`: u_x' = c_x u_y u_z and so on.
    couple: DVec3,
}

/// How fast u moves on its closed way.
struct Pace {
    /// λ of the elliptic functions that u is made of (rad/s); no complex pole is nearer than π/2 to
    /// λ t, whatever the modulus, so that pieces of λ t are right for their series.
    rate: f64,
    /// λ and its complement, in units of `apart`.
    lambda: f64,
    complement: f64,
    /// The difference of the largest and the smallest of ω's factors (rad/s).
    apart: f64,
}

impl Pace {
    /// The time after which u comes back (s), infinite where it does not move.
    fn period(&self) -> f64 {
        let mean = arithmetic_geometric_mean(self.lambda, self.complement);
        std::f64::consts::TAU / (self.apart * mean)
    }
}

impl Euler {
    fn new(inverse: DVec3, length: f64) -> Self {
        let spin = inverse * length;
        let couple = DVec3::new(spin.z - spin.y, spin.x - spin.z, spin.y - spin.x);
        Self { spin, couple }
    }

    /// Whether u stays where it is: about a principal axis the body turns evenly, for ever.
    fn stands(&self, u: DVec3) -> bool {
        self.couple * DVec3::new(u.y * u.z, u.z * u.x, u.x * u.y) == DVec3::ZERO
    }

    /// One piece of time `t`: its turn, and u at its end.
    fn piece(&self, start: DVec3, t: f64) -> (Turn, DVec3) {
        // coefficients of u, of u·u₀, of (u + u₀)·ω and of ψ', times powers of t
        let mut u = [DVec3::ZERO; ORDER + 1];
        let mut along = [0.0; ORDER + 1];
        let mut psi = [0.0; ORDER + 1];
        u[0] = start;
        let spin_start = self.spin * start;
        psi[0] = spin_start.dot(start);
        let (mut end, mut angle) = (DVec3::ZERO, psi[0]);
        for k in 1..=ORDER {
            u[k] = self.next(&u, k) * (t / k as f64);
            along[k] = u[k].dot(start);
            // ω·u is constant (twice the energy over |L|), so only ω·u₀ changes
            let mut sum = spin_start.dot(u[k]);
            for j in 1..=k {
                sum -= along[j] * psi[k - j];
            }
            psi[k] = 0.5 * sum;
            end += u[k];
            angle += psi[k] / (k + 1) as f64;
            if u[k].abs().max_element() < 1e-18 {
                break;
            }
        }
        // shortest rotation from u to u₀, from their difference so that small turns keep their digits
        let half = (1.0 - 0.25 * end.length_squared()).sqrt();
        let vector = end.cross(start) / (2.0 * half);
        let back = Turn { scalar: -vector.length_squared() / (1.0 + half), vector };
        (Turn::about(start, angle * t).after(back), (start + end).normalize())
    }

    /// Coefficient k of u', from those of u up to k − 1.
    fn next(&self, u: &[DVec3; ORDER + 1], k: usize) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for j in 0..k {
            let (a, b) = (u[j], u[k - 1 - j]);
            sum += DVec3::new(a.y * b.z, a.z * b.x, a.x * b.y);
        }
        self.couple * sum
    }

    /// With s_a ≤ s_b ≤ s_c and D_ij = s_j − s_i, u_b is an elliptic sine of λ t, on the side of a with
    /// λ² = D_ab (D_ac u_a² + D_bc u_b²) and λ² k'² = D_ac (D_ab u_a² − D_bc u_c²), so that
    /// T = 4 K(k)/λ = 2π/agm(λ, λ k').
    fn pace(&self, u: DVec3) -> Pace {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| self.spin[i].total_cmp(&self.spin[j]));
        let [a, b, c] = order;
        let ac = self.spin[c] - self.spin[a];
        if ac == 0.0 {
            return Pace { rate: 0.0, lambda: 0.0, complement: 0.0, apart: 0.0 };
        }
        // in units of D_ac, whose square may overflow
        let ab = (self.spin[b] - self.spin[a]) / ac;
        let bc = (self.spin[c] - self.spin[b]) / ac;
        // which side of the separatrix: u circles axis a where this is above 0, else axis c
        let side = ab * u[a] * u[a] - bc * u[c] * u[c];
        let (near, of_near, of_far) = if side > 0.0 { (u[a], ab, bc) } else { (u[c], bc, ab) };
        let lambda = (of_near * (near * near + of_far * u[b] * u[b])).sqrt();
        // on the separatrix itself any rounding brings u back, after a long time
        let complement = side.abs().max(NEAREST).sqrt();
        Pace { rate: ac * lambda, lambda, complement, apart: ac }
    }

    /// How far the body turns about L in one period (rad).
    fn angle_of_period(&self, start: DVec3, rate: f64, period: f64) -> f64 {
        let pieces = (rate * period / PIECE).ceil().max(1.0);
        let (mut u, mut turn) = (start, Turn::NONE);
        for _ in 0..pieces as u64 {
            let (piece, end) = self.piece(u, period / pieces);
            turn = turn.after(piece);
            u = end;
        }
        2.0 * libm::atan2(turn.vector.dot(start), 1.0 + turn.scalar)
    }
}

/// Gauss's mean of two numbers; it converges quadratically.
fn arithmetic_geometric_mean(mut a: f64, mut b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return 0.0;
    }
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * (a + b)
}
