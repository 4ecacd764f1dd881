//! The free rotation over a step during which u moves little: the formulas of
//! [`free_rotation`](super::free_rotation()) with a fixed number of terms, without elliptic functions,
//! trigonometric functions or substeps.
//!
//! The number of terms is known in advance. With the step as the unit of time, u' = u × S u, where
//! S = |L| I⁻¹ h may be shifted by any multiple of the identity. Shifted by the mean of its extremes,
//! |S u| ≤ ε |u| with ε half their difference. From |a × S b| ≤ ε |a| |b| and the recurrence of the
//! Taylor coefficients follows
//!
//! |u_k| ≤ |u_1| ε^(k−1),
//!
//! by the method of majorants (E. Hairer, S. P. Nørsett & G. Wanner, *Solving Ordinary Differential Equations I*,
//! I.8). |u_1| = |u₀ × ω₀| h is at most the angle of the rotation, so the terms after the K-th are at most
//! ε^K/(1 − ε) of that angle. ε is dimensionless and independent of the angle: it is 0 for a sphere.

use glam::DVec3;

use super::turn::RotationDelta;

/// ε up to which ω is constant to rounding. The error of a constant ω is |ω'| h²/2, with |ω'| h² ≤ s_max |u_1|,
/// where s_max is the largest entry of S. The smallest is s_max − 2 ε, and the angle is at least that: the
/// relative error is at most 3 ε/2.
const UNIFORM: f64 = 1.0 / (1u64 << 54) as f64;
/// ε up to which this many terms are enough: ε^K ≤ 2⁻⁵⁴.
const FOUR: f64 = 8.6e-5;
const SIX: f64 = 1.95e-3;
const EIGHT: f64 = 9.2e-3;
pub(super) const ELEVEN: f64 = 3.3e-2;
/// Squared half angle up to which the truncated series of sine and cosine are exact: the next terms are below 3e-19.
const SMALL: f64 = 1.0 / 256.0;
/// The range of L² (in any unit) in which no intermediate result overflows or loses digits.
pub(super) const SQUARES: std::ops::RangeInclusive<f64> = 1e-200..=1e200;

/// The result of [`free_rotation`](super::free_rotation()), or `None` where the general formulas are needed.
#[inline(always)]
pub(super) fn small_rotation(inverse: DVec3, momentum: DVec3, time: f64) -> Option<RotationDelta> {
    let coupling = DVec3::new(inverse.z - inverse.y, inverse.x - inverse.z, inverse.y - inverse.x);
    let half_range =
        coupling.x.abs().max(coupling.y.abs()).max(coupling.z.abs()) * (0.5 * time.abs());
    if half_range * (momentum.x.abs() + momentum.y.abs() + momentum.z.abs()) <= UNIFORM {
        return uniform_rotation(inverse * momentum * time);
    }
    let square = momentum.length_squared();
    let epsilon = half_range * half_range * square;
    // not `>`: NaN is not small
    if !(SQUARES.contains(&square) && epsilon <= ELEVEN * ELEVEN) {
        return None;
    }
    series_rotation(momentum, inverse * time, coupling * time, [square, epsilon])
}

/// The Taylor series with as many terms as ε requires. `inverse` and `coupling` include the factor h;
/// the last argument holds L² and ε².
#[inline(always)]
fn series_rotation(
    start: DVec3,
    inverse: DVec3,
    coupling: DVec3,
    [square, epsilon]: [f64; 2],
) -> Option<RotationDelta> {
    let mut series = Series::new(start, inverse, coupling, square);
    series.add::<2>();
    series.add::<3>();
    series.add::<4>();
    if epsilon > FOUR * FOUR {
        series.add::<5>();
        series.add::<6>();
    }
    if epsilon > SIX * SIX {
        series.add::<7>();
        series.add::<8>();
    }
    if epsilon > EIGHT * EIGHT {
        series.add::<9>();
        series.add::<10>();
        series.add::<11>();
    }
    series.turn()
}

/// A rotation at constant ω, by a small rotation vector `angle` (rad).
#[inline(always)]
fn uniform_rotation(angle: DVec3) -> Option<RotationDelta> {
    let half = 0.5 * angle;
    let (sine, cosine) = sine_cosine(half.length_squared())?;
    Some(RotationDelta { scalar: cosine, vector: half * sine })
}

/// sin a/a and cos a − 1 of a small angle a, from its square.
#[inline(always)]
fn sine_cosine(square: f64) -> Option<(f64, f64)> {
    // not `>`: NaN is not small
    if square.is_nan() || square > SMALL {
        return None;
    }
    let a = square;
    let sine = (-1.0 / 6.0 + a * (1.0 / 120.0)) + a * a * (-1.0 / 5040.0 + a * (1.0 / 362_880.0));
    let cosine = (-0.5 + a * (1.0 / 24.0)) + a * a * (-1.0 / 720.0 + a * (1.0 / 40_320.0));
    Some((1.0 + a * sine, a * cosine))
}

/// Taylor series of L and ψ over one step, which is the unit of time.
///
/// Euler's equations L_x' = c_x L_y L_z, differentiated once more, are linear except for a scalar s common to
/// all three: L_x'' = (b + g + s) L_x and so on, where a = c_y c_z L_x², b = c_z c_x L_y² and g = c_x c_y L_z² at
/// the start, and s = 4 c_x c_y c_z ∫ L_x L_y L_z dt obeys s'' = 4 (ab + bg + ga) + 4 (a + b + g) s + 3 s².
/// Advancing two derivatives at a time halves the chain of dependent operations, which limits the speed.
///
/// ω·L is constant, so φ = ψ/|L| obeys φ' = (ω·L + r·D/(1 + ½ L₀·D/L²))/L², with D = L − L₀ and r half the
/// component of ω₀ perpendicular to L₀. As L₀·L_1 = r·L_1 = 0, the second part is smaller than the angle by ε²,
/// and its k-th term by ε^k/2: K terms of L need K − 1 terms of φ'.
struct Series {
    /// Coefficients of L.
    l: [DVec3; 12],
    /// Coefficients of s.
    s: [f64; 12],
    /// (b + g, g + a, a + b).
    stiffness: DVec3,
    /// 4 (a + b + g).
    sum: f64,
    /// L² and 1/L².
    square: f64,
    inverse_square: f64,
    /// r/L².
    across: DVec3,
    /// Coefficients of 1 + ½ L₀·D/L².
    denominator: [f64; 12],
    /// Coefficients of φ' without its constant part.
    phi: [f64; 12],
    /// Sums of the terms so far: D and φ at the end.
    d: DVec3,
    angle: f64,
}

impl Series {
    /// The first terms: L up to order 1, s up to order 2.
    #[inline(always)]
    fn new(start: DVec3, inverse: DVec3, c: DVec3, square: f64) -> Self {
        let inverse_square = 1.0 / square;
        let omega = inverse * start;
        let angle = omega.dot(start) * inverse_square;
        let across = (omega - angle * start) * (0.5 * inverse_square);
        let (DVec3 { x, y, z }, cl) = (start, c * start);
        let (mut l, mut s) = ([start; 12], [0.0; 12]);
        l[1] = DVec3::new(c.x * (y * z), c.y * (z * x), c.z * (x * y));
        let (a, b, g) = (c.y * x * (c.z * x), c.z * y * (c.x * y), c.x * z * (c.y * z));
        s[1] = 4.0 * cl.x * cl.y * cl.z;
        s[2] = 2.0 * (a * b + g * (a + b));
        let stiffness = DVec3::new(b + g, g + a, a + b);
        let sum = 4.0 * (a + b + g);
        let (denominator, phi, d) = ([0.0; 12], [0.0; 12], l[1]);
        Self { l, s, stiffness, sum, square, inverse_square, across, denominator, phi, d, angle }
    }

    /// Adds term K > 1 of L and term K − 1 of φ'; all earlier terms must be there.
    #[inline(always)]
    fn add<const K: usize>(&mut self) {
        let (l, s) = (&mut self.l, &mut self.s);
        if K > 4 {
            let k = K - 2;
            let mut sum = 0.0;
            for j in 1..k - 2 {
                sum += s[j] * s[k - 2 - j];
            }
            s[k] = (self.sum * s[k - 2] + 3.0 * sum) * (1.0 / (k * (k - 1)) as f64);
        }
        let mut sum = self.stiffness * l[K - 2];
        for j in 1..K - 1 {
            sum += s[j] * l[K - 2 - j];
        }
        l[K] = sum * (1.0 / (K * (K - 1)) as f64);
        self.d += l[K];
        if K < 3 {
            return;
        }
        if K > 4 {
            self.denominator[K - 3] = (0.5 * self.inverse_square) * l[0].dot(l[K - 3]);
        }
        let mut phi = self.across.dot(l[K - 1]);
        for j in 2..K - 2 {
            phi -= self.denominator[j] * self.phi[K - 1 - j];
        }
        self.phi[K - 1] = phi;
        self.angle += phi * (1.0 / K as f64);
    }

    /// The rotation at the end of the step; `None` if the angle is too large for the series of sine and cosine.
    ///
    /// With c = cos ψ/2, s = sin ψ/2 and h² = 1 − d²/4, the shortest rotation from u to u₀ followed by the
    /// rotation by ψ about u₀ is (c h, (s (u₀ + d/2) + c d × u₀/2)/h), where u = L/|L| and d = u − u₀.
    #[inline(always)]
    fn turn(&self) -> Option<RotationDelta> {
        let (start, d, half) = (self.l[0], self.d, 0.5 * self.angle);
        let (sine, c) = sine_cosine(half * half * self.square)?;
        // 1/h − 1 and h − 1; x is below 3e-4
        let x = 0.25 * d.length_squared() * self.inverse_square;
        let more = x * (0.5 + x * (3.0 / 8.0 + x * (5.0 / 16.0 + x * (35.0 / 128.0))));
        let less = more - x * (1.0 + more);
        let along = (start + 0.5 * d) * (sine * half);
        let across = d.cross(start) * ((0.5 + 0.5 * c) * self.inverse_square);
        Some(RotationDelta { scalar: c + less + c * less, vector: (along + across) * (1.0 + more) })
    }
}
