//! The free rotation of a rigid body, exact to rounding at any step.
//!
//! In principal axes the unit vector u = Rᵀ L/|L| obeys u' = u × ω with ω = |L| I⁻¹ u: Euler's equations.
//! Their right-hand side is quadratic, so the Taylor coefficients of u follow from each other by
//! convolution. A step that turns u by a fraction of a radian needs only a few of them.
//!
//! The orientation needs one more number. Over the time t the body turns by the shortest rotation
//! that takes u(t) back to u₀, followed by a rotation about u₀ by an angle ψ with
//!
//! ψ' = (u + u₀)·ω / (1 + u·u₀),
//!
//! whose Taylor coefficients follow by division. The result depends on the step size only through
//! rounding. Symmetric, spherical, planar and linear bodies and motion near the separatrix need no
//! special cases.
//!
//! A step of many revolutions is divided into substeps. If there would be very many, whole periods of
//! u are taken out first. The period is a complete elliptic integral; after it u returns, and the body
//! has turned about L by a fixed angle (R. Montgomery, *How much does the rigid body rotate?*, Am. J.
//! Phys. 59 (1991) 394). An alternative is elliptic and theta functions: R. van Zon & J. Schofield,
//! J. Comput. Phys. 225 (2007) 145; E. Celledoni, F. Fassò, N. Säfström & A. Zanna, SIAM J. Sci.
//! Comput. 30 (2008) 2084.

use glam::DVec3;

use super::small_rotation::small_rotation;
use super::turn::RotationDelta;

/// λ t of a substep, small enough for fast convergence of the series.
const SUBSTEP: f64 = 0.25;
/// The highest order of the Taylor series; a substep needs fewer terms.
const ORDER: usize = 20;
/// The number of substeps above which whole periods are taken out first.
const MANY_SUBSTEPS: f64 = 256.0;
/// Lower bound on the squared relative distance from the separatrix.
const MIN_SEPARATION: f64 = 1e-300;

/// The rotation of a free body over `time` (s): R(time) = R(0) · turn, in principal axes.
///
/// `inverse` holds the inverse principal moments (1/(kg·m²)), zero for an axis without inertia.
/// `momentum` is the angular momentum (kg·m²/s) in principal axes.
#[inline]
pub fn free_rotation(inverse: DVec3, momentum: DVec3, time: f64) -> RotationDelta {
    small_rotation(inverse, momentum, time).unwrap_or_else(|| any_rotation(inverse, momentum, time))
}

/// As [`free_rotation`], by the general formulas, for any angle.
pub(super) fn any_rotation(inverse: DVec3, momentum: DVec3, time: f64) -> RotationDelta {
    let length = length(momentum);
    if length == 0.0 || time == 0.0 {
        return RotationDelta::NONE;
    }
    let euler = Euler::new(inverse, length);
    let mut u = momentum / length;
    let start = u;
    if euler.is_stationary(u) {
        return RotationDelta::about(u, euler.spin.dot(u * u) * time);
    }
    let mut rest = time;
    let mut turn = RotationDelta::NONE;
    let elliptic = euler.elliptic_parameters(u);
    if elliptic.rate * time.abs() > MANY_SUBSTEPS * SUBSTEP {
        let period = elliptic.period();
        if period < time.abs() {
            rest = libm::fmod(time, period);
            let periods = (time / period).trunc();
            turn = RotationDelta::about(
                start,
                euler.angle_per_period(u, elliptic.rate, period) * periods,
            );
        }
    }
    let substeps = (elliptic.rate * rest.abs() / SUBSTEP).ceil().max(1.0);
    for _ in 0..substeps as u64 {
        let (substep, end) = euler.substep(u, rest / substeps);
        turn = turn.after(substep);
        u = end;
    }
    turn
}

/// The length of a vector, computed without overflow or underflow of the squares.
fn length(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    if largest == 0.0 { 0.0 } else { (v / largest).length() * largest }
}

/// Euler's equations of one body for one magnitude of L.
struct Euler {
    /// |L| I⁻¹ (rad/s): ω = spin · u by components.
    spin: DVec3,
    /// (s_z − s_y, s_x − s_z, s_y − s_x) of `spin`: u_x' = c_x u_y u_z and so on.
    coupling: DVec3,
}

/// Parameters of the elliptic functions that describe u(t).
struct EllipticParameters {
    /// λ (rad/s). No complex pole in λ t is nearer than π/2, whatever the modulus, so a fixed λ t per
    /// substep suits the series.
    rate: f64,
    /// λ and λ k', in units of `range`.
    lambda: f64,
    complement: f64,
    /// The largest minus the smallest component of `spin` (rad/s).
    range: f64,
}

impl EllipticParameters {
    /// The period of u (s), infinite where u is constant.
    fn period(&self) -> f64 {
        let mean = arithmetic_geometric_mean(self.lambda, self.complement);
        std::f64::consts::TAU / (self.range * mean)
    }
}

impl Euler {
    fn new(inverse: DVec3, length: f64) -> Self {
        let spin = inverse * length;
        let coupling = DVec3::new(spin.z - spin.y, spin.x - spin.z, spin.y - spin.x);
        Self { spin, coupling }
    }

    /// Whether u is constant: the body turns uniformly about a principal axis.
    fn is_stationary(&self, u: DVec3) -> bool {
        self.coupling * DVec3::new(u.y * u.z, u.z * u.x, u.x * u.y) == DVec3::ZERO
    }

    /// One substep of time `t`: the rotation, and u at its end.
    fn substep(&self, start: DVec3, t: f64) -> (RotationDelta, DVec3) {
        // Taylor coefficients of u, of u·u₀ and of ψ', times powers of t
        let mut u = [DVec3::ZERO; ORDER + 1];
        let mut along = [0.0; ORDER + 1];
        let mut psi = [0.0; ORDER + 1];
        u[0] = start;
        let spin_start = self.spin * start;
        psi[0] = spin_start.dot(start);
        let (mut end, mut angle) = (DVec3::ZERO, psi[0]);
        for k in 1..=ORDER {
            u[k] = self.derivative(&u, k) * (t / k as f64);
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
        // shortest rotation from u to u₀, computed from their difference to keep the digits of small rotations
        let half = (1.0 - 0.25 * end.length_squared()).sqrt();
        let vector = end.cross(start) / (2.0 * half);
        let back = RotationDelta { scalar: -vector.length_squared() / (1.0 + half), vector };
        (RotationDelta::about(start, angle * t).after(back), (start + end).normalize())
    }

    /// Coefficient k of u', from those of u up to k − 1.
    fn derivative(&self, u: &[DVec3; ORDER + 1], k: usize) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for j in 0..k {
            let (a, b) = (u[j], u[k - 1 - j]);
            sum += DVec3::new(a.y * b.z, a.z * b.x, a.x * b.y);
        }
        self.coupling * sum
    }

    /// The elliptic functions of the motion that passes through u.
    ///
    /// With s_a ≤ s_b ≤ s_c and D_ij = s_j − s_i, u_b is an elliptic sine of λ t. Where u circles axis a,
    /// λ² = D_ab (D_ac u_a² + D_bc u_b²) and λ² k'² = D_ac (D_ab u_a² − D_bc u_c²), so that
    /// T = 4 K(k)/λ = 2π/agm(λ, λ k').
    fn elliptic_parameters(&self, u: DVec3) -> EllipticParameters {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| self.spin[i].total_cmp(&self.spin[j]));
        let [a, b, c] = order;
        let ac = self.spin[c] - self.spin[a];
        if ac == 0.0 {
            return EllipticParameters { rate: 0.0, lambda: 0.0, complement: 0.0, range: 0.0 };
        }
        // in units of D_ac, whose square may overflow
        let ab = (self.spin[b] - self.spin[a]) / ac;
        let bc = (self.spin[c] - self.spin[b]) / ac;
        // the side of the separatrix: u circles axis a where this is positive, else axis c
        let side = ab * u[a] * u[a] - bc * u[c] * u[c];
        let (near, of_near, of_far) = if side > 0.0 { (u[a], ab, bc) } else { (u[c], bc, ab) };
        let lambda = (of_near * (near * near + of_far * u[b] * u[b])).sqrt();
        // on the separatrix itself the period is infinite; rounding makes it finite but long
        let complement = side.abs().max(MIN_SEPARATION).sqrt();
        EllipticParameters { rate: ac * lambda, lambda, complement, range: ac }
    }

    /// The angle by which the body turns about L in one period (rad).
    fn angle_per_period(&self, start: DVec3, rate: f64, period: f64) -> f64 {
        let substeps = (rate * period / SUBSTEP).ceil().max(1.0);
        let (mut u, mut turn) = (start, RotationDelta::NONE);
        for _ in 0..substeps as u64 {
            let (substep, end) = self.substep(u, period / substeps);
            turn = turn.after(substep);
            u = end;
        }
        2.0 * libm::atan2(turn.vector.dot(start), 1.0 + turn.scalar)
    }
}

/// The arithmetic-geometric mean (Gauss); the iteration converges quadratically.
fn arithmetic_geometric_mean(mut a: f64, mut b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return 0.0;
    }
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * (a + b)
}
