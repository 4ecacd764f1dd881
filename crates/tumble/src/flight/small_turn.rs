//! The free rotation over a step that is short beside the motion of u: the formulas of
//! [`free_rotation`](super::free_rotation()) with a fixed number of terms, and no elliptic functions,
//! sines or pieces.
//!
//! How many terms there must be is known beforehand. With time counted in steps u' = u × S u, where S = |L| I⁻¹ h
//! may be shifted by any multiple of 1: by the mean of its extremes, so that |S u| ≤ ε |u|, ε being half
//! their difference. From |a × S b| ≤ ε |a| |b| and the recurrence of the Taylor coefficients follows
//!
//! |u_k| ≤ |u_1| ε^(k−1),
//!
//! by the method of majorants (E. Hairer, S. P. Nørsett & G. Wanner, *Solving Ordinary Differential Equations I*,
//! I.8). |u_1| = |u₀ × ω₀| h is no more than the angle turned, so that the terms after the K-th are at most
//! ε^K/(1 − ε) of the turn. ε has no unit, and says nothing of how far a body turns: it is 0 for a sphere.

use glam::DVec3;

use super::Turn;

/// ε up to which ω stays where it is. The turn differs from that by |ω'| h²/2, with |ω'| h² ≤ s_max |u_1|, where
/// s_max is the largest number in S, s_max − 2 ε the smallest, and the turn at least that: by 3 ε/2 of itself.
const EVEN: f64 = 1.0 / (1u64 << 54) as f64;
/// ε up to which so many terms are enough: ε^K ≤ 2⁻⁵⁴.
const FOUR: f64 = 8.6e-5;
const SIX: f64 = 1.95e-3;
const EIGHT: f64 = 9.2e-3;
const ELEVEN: f64 = 3.3e-2;
/// Squared half angle up to which the terms kept of sine and cosine are enough: the next ones are below 3e-19.
const SMALL: f64 = 1.0 / 256.0;
/// L² (in any unit) beside which no intermediate result overflows or loses digits.
const SQUARES: std::ops::RangeInclusive<f64> = 1e-200..=1e200;

/// The turn of [`free_rotation`](super::free_rotation()), or `None` where it needs the general formulas.
#[inline(always)]
pub(super) fn small_turn(inverse: DVec3, momentum: DVec3, time: f64) -> Option<Turn> {
    let couple = DVec3::new(inverse.z - inverse.y, inverse.x - inverse.z, inverse.y - inverse.x);
    let apart = couple.x.abs().max(couple.y.abs()).max(couple.z.abs()) * (0.5 * time.abs());
    if apart * (momentum.x.abs() + momentum.y.abs() + momentum.z.abs()) <= EVEN {
        return even_turn(inverse * momentum * time);
    }
    let square = momentum.length_squared();
    let epsilon = apart * apart * square;
    // not `>`: NaN is not small
    if !(SQUARES.contains(&square) && epsilon <= ELEVEN * ELEVEN) {
        return None;
    }
    series(momentum, inverse * time, couple * time, [square, epsilon])
}

/// With as many terms as ε needs; given are L², ε², and the inverse moments times the step.
#[inline(always)]
fn series(
    start: DVec3,
    inverse: DVec3,
    couple: DVec3,
    [square, epsilon]: [f64; 2],
) -> Option<Turn> {
    let mut path = Path::new(start, inverse, couple, square);
    path.add::<2>();
    path.add::<3>();
    path.add::<4>();
    if epsilon > FOUR * FOUR {
        path.add::<5>();
        path.add::<6>();
    }
    if epsilon > SIX * SIX {
        path.add::<7>();
        path.add::<8>();
    }
    if epsilon > EIGHT * EIGHT {
        path.add::<9>();
        path.add::<10>();
        path.add::<11>();
    }
    path.turn()
}

/// By a small `angle` (rad) along an axis.
#[inline(always)]
pub(super) fn even_turn(angle: DVec3) -> Option<Turn> {
    let half = 0.5 * angle;
    let (sine, cosine) = sine_cosine(half.length_squared())?;
    Some(Turn { scalar: cosine, vector: half * sine })
}

/// sin a/a and cos a − 1 of a small angle, from its square.
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

/// The way of L and ψ over one step, which is the unit of time, by their Taylor series.
///
/// Euler's equations L_x' = c_x L_y L_z, differentiated once more, are linear but for one number s that all three
/// share: L_x'' = (b + g + s) L_x and so on, where a = c_y c_z L_x², b = c_z c_x L_y² and g = c_x c_y L_z² at the start, and
/// s = 4 c_x c_y c_z ∫ L_x L_y L_z dt obeys s'' = 4 (ab + bg + ga) + 4 (a + b + g) s + 3 s². Two derivatives a time,
/// a chain of half the length: what the processor waits for.
///
/// ω·L is constant, so that φ = ψ/|L| obeys φ' = (ω·L + r·D/(1 + ½ L₀·D/L²))/L², D = L − L₀ and r being half the part
/// of ω₀ across L₀. As L₀·L_1 = r·L_1 = 0, what is added is smaller than the turn by ε², and its k-th term
/// by ε^k/2: K terms of L go with K − 1 of φ'.
struct Path {
    /// Coefficients of L.
    l: [DVec3; 12],
    /// Of s.
    s: [f64; 12],
    /// (b + g, g + a, a + b).
    pull: DVec3,
    /// 4 (a + b + g).
    sum: f64,
    /// L² and 1/L².
    square: f64,
    inverse_square: f64,
    /// r/L².
    across: DVec3,
    /// Coefficients of 1 + ½ L₀·D/L².
    bend: [f64; 12],
    /// Of φ' without its mean.
    phi: [f64; 12],
    /// Sums of the terms so far: D and φ at the end.
    d: DVec3,
    angle: f64,
}

impl Path {
    /// With its first terms: those of L up to the first, of s up to the second.
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
        let pull = DVec3::new(b + g, g + a, a + b);
        let sum = 4.0 * (a + b + g);
        let (bend, phi, d) = ([0.0; 12], [0.0; 12], l[1]);
        Self { l, s, pull, sum, square, inverse_square, across, bend, phi, d, angle }
    }

    /// Term K > 1 of L and K − 1 of φ', after all before them.
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
        let mut sum = self.pull * l[K - 2];
        for j in 1..K - 1 {
            sum += s[j] * l[K - 2 - j];
        }
        l[K] = sum * (1.0 / (K * (K - 1)) as f64);
        self.d += l[K];
        if K < 3 {
            return;
        }
        if K > 4 {
            self.bend[K - 3] = (0.5 * self.inverse_square) * l[0].dot(l[K - 3]);
        }
        let mut phi = self.across.dot(l[K - 1]);
        for j in 2..K - 2 {
            phi -= self.bend[j] * self.phi[K - 1 - j];
        }
        self.phi[K - 1] = phi;
        self.angle += phi * (1.0 / K as f64);
    }

    /// With c = cos ψ/2, s = sin ψ/2 and h² = 1 − d²/4, the shortest rotation from u to u₀ and then the one
    /// by ψ about u₀ are together (c h, (s (u₀ + d/2) + c d × u₀/2)/h), where u = L/|L|, d = u − u₀.
    #[inline(always)]
    fn turn(&self) -> Option<Turn> {
        let (start, d, half) = (self.l[0], self.d, 0.5 * self.angle);
        let (sine, c) = sine_cosine(half * half * self.square)?;
        // 1/h − 1 and h − 1; x is below 3e-4
        let x = 0.25 * d.length_squared() * self.inverse_square;
        let more = x * (0.5 + x * (3.0 / 8.0 + x * (5.0 / 16.0 + x * (35.0 / 128.0))));
        let less = more - x * (1.0 + more);
        let along = (start + 0.5 * d) * (sine * half);
        let across = d.cross(start) * ((0.5 + 0.5 * c) * self.inverse_square);
        Some(Turn { scalar: c + less + c * less, vector: (along + across) * (1.0 + more) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::free_rotation::any_turn;
    use proptest::prelude::*;

    fn inverse() -> impl Strategy<Value = DVec3> {
        let nearly = prop::array::uniform3(0.0..1.0f64);
        prop_oneof![
            4 => prop::array::uniform3(0.0..1.0f64).prop_map(DVec3::from_array),
            // equal but for rounding, and but for more
            2 => (nearly, -16.0..-1.0f64)
                .prop_map(|(a, e)| DVec3::ONE + DVec3::from_array(a) * 10f64.powf(e)),
            // needle and disc
            2 => (0.0..0.1f64, 1.0..1e3f64).prop_map(|(a, b)| DVec3::new(b, 1.0, 1.0 + a)),
            2 => (0.0..1e-6f64).prop_map(|a| DVec3::new(1.0, 0.5, 0.5 + a)),
            // sphere, line, plane, point
            1 => Just(DVec3::ONE),
            1 => Just(DVec3::new(0.0, 1.0, 1.0)),
            1 => Just(DVec3::new(1.0, 1.0, 0.0)),
            1 => Just(DVec3::ZERO),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Both are some roundings off the truth, and the general formulas end with a term of 1e-18.
        #[test]
        fn small_turns_are_what_the_general_formulas_say(
            inverse in inverse(),
            axis in prop::array::uniform3(-1.0..1.0f64),
            thin in prop::array::uniform3(prop_oneof![3 => Just(0.0), 1 => -30.0..0.0f64]),
            angle in (-12.0..0.0f64).prop_map(|e| 10f64.powf(e)),
            scales in (-60.0..60.0f64, -20.0..20.0f64),
            backwards in any::<bool>(),
        ) {
            let [size, pace] = [scales.0, scales.1].map(|e| 10f64.powf(e));
            let momentum = DVec3::from_array(axis) * DVec3::from_array(thin.map(|e| 10f64.powf(e)));
            let spin = (inverse * momentum).length();
            prop_assume!(momentum.length() > 0.0 && (spin > 0.0 || inverse == DVec3::ZERO));
            let time = if spin > 0.0 { angle / spin } else { angle };
            let time = if backwards { -time } else { time };
            let arguments = (inverse / size, momentum * (size * pace), time / pace);
            let general = any_turn(arguments.0, arguments.1, arguments.2);
            if let Some(small) = small_turn(arguments.0, arguments.1, arguments.2) {
                let all = general.vector.length();
                let off = (small.vector - general.vector).length();
                prop_assert!(off <= 3e-15 * all + 2e-18, "off by {:e} of {all:e}", off / all);
                let off = (small.scalar - general.scalar).abs();
                prop_assert!(off <= 3e-16 * all + 2e-18, "scalar off by {:e} of {all:e}", off / all);
            } else {
                let apart = inverse.max_element() - inverse.min_element();
                let epsilon = 0.5 * apart * momentum.length() * time.abs();
                let is_extreme = !SQUARES.contains(&arguments.1.length_squared());
                prop_assert!(
                    epsilon > 0.99 * ELEVEN || angle > 0.12 || is_extreme,
                    "{epsilon:e} was refused"
                );
            }
        }
    }

    /// What no square can hold goes the general way.
    #[test]
    fn extremes_are_refused() {
        let inverse = DVec3::new(1.0, 2.0, 3.0);
        for size in [1e-200, 1e200, f64::INFINITY, f64::NAN] {
            assert!(small_turn(inverse / size, DVec3::ONE * size, 1e-3).is_none(), "{size}");
        }
    }
}
