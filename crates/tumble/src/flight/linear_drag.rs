//! Motion of a point under gravity and linear drag: x'' = g − γ x'.

use glam::DVec3;

/// The exact solution over one time interval h with drag rate γ.
///
/// It is written in terms of z = γ h and φ₁ = (1 − e⁻ᶻ)/z, φ₂ = (1 − φ₁)/z, φ₃ = (½ − φ₂)/z, which are
/// regular at γ = 0.
#[derive(Clone, Copy, Debug)]
pub struct LinearDrag {
    time: f64,
    rate: f64,
    /// φ at z.
    once: Phi,
    /// φ at 2 z.
    twice: Phi,
}

/// The functions φ₁, φ₂, φ₃.
#[derive(Clone, Copy, Debug)]
struct Phi {
    one: f64,
    two: f64,
    three: f64,
}

impl Phi {
    fn new(z: f64) -> Self {
        if z.abs() < 0.5 {
            // φ₃ = Σ (−z)ⁿ/(n + 3)!; the others follow from it without cancellation
            let mut term = 1.0 / 6.0;
            let mut three = term;
            for n in 1..14 {
                term *= -z / f64::from(n + 3);
                three += term;
                // the rest is below rounding; without drag this ends the loop at once
                if term.abs() < 1e-18 {
                    break;
                }
            }
            let two = 0.5 - z * three;
            return Self { one: 1.0 - z * two, two, three };
        }
        let one = -libm::expm1(-z) / z;
        let two = (1.0 - one) / z;
        Self { one, two, three: (0.5 - two) / z }
    }
}

impl LinearDrag {
    /// The solution over `time` h (s) with drag rate `rate` γ (1/s), F = −γ M v.
    pub fn new(time: f64, rate: f64) -> Self {
        let z = rate * time;
        Self { time, rate, once: Phi::new(z), twice: Phi::new(2.0 * z) }
    }

    /// e^(−γ h), the factor by which drag reduces a momentum.
    pub fn decay(&self) -> f64 {
        if self.rate == 0.0 { 1.0 } else { libm::exp(-self.rate * self.time) }
    }

    /// (1 − e^(−γ h))/γ (s): the time in which a body without drag, with the initial angular momentum,
    /// turns by the same rotation.
    pub fn free_time(&self) -> f64 {
        self.time * self.once.one
    }

    /// The displacement (m) and the final velocity (m/s), from the initial velocity and gravity.
    pub fn advance(&self, velocity: DVec3, gravity: DVec3) -> (DVec3, DVec3) {
        let h = self.time;
        let displacement = velocity * (h * self.once.one) + gravity * (h * h * self.once.two);
        (displacement, velocity * self.decay() + gravity * (h * self.once.one))
    }

    /// γ ∫ v² dt (m²/s²): the energy lost to drag per kilogram, from the initial velocity and gravity.
    pub fn loss(&self, velocity: DVec3, gravity: DVec3) -> f64 {
        let h = self.time;
        let (one, two) = (self.once, self.twice);
        self.rate
            * h
            * (velocity.length_squared() * two.one
                + 2.0 * h * velocity.dot(gravity) * (2.0 * two.two - one.two)
                + h * h * gravity.length_squared() * (4.0 * two.three - 2.0 * one.three))
    }

    /// 1 − e^(−2 γ h): the fraction of the rotational energy lost to drag.
    pub fn rotational_loss(&self) -> f64 {
        2.0 * self.rate * self.time * self.twice.one
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For drag rates from zero to far beyond 1/h.
    #[test]
    fn the_loss_to_drag_equals_the_loss_of_kinetic_and_gravitational_energy() {
        let (v, g) = (DVec3::new(3.0, -2.0, 5.0), DVec3::new(0.3, -9.8, 0.1));
        for rate in [0.0, 1e-12, 1e-3, 0.24, 0.26, 0.49, 0.51, 1.0, 30.0, 5e3] {
            for time in [1e-3, 0.5, 1.0, -0.01] {
                let drag = LinearDrag::new(time, rate);
                let (displacement, end) = drag.advance(v, g);
                let lost = 0.5 * (v.length_squared() - end.length_squared()) + g.dot(displacement);
                let kinetic = 0.5 * end.length_squared() + 0.5 * v.length_squared();
                let error = (lost - drag.loss(v, g)).abs();
                let bound = 1e-14 * (kinetic + displacement.length() * 10.0);
                assert!(error < bound, "rate {rate}, time {time}: {error:e}");
            }
        }
    }

    #[test]
    fn two_half_steps_equal_one_step() {
        let (v, g) = (DVec3::new(3.0, -2.0, 5.0), DVec3::new(0.3, -9.8, 0.1));
        for rate in [0.0, 1e-9, 0.7, 40.0] {
            let (whole, half) = (LinearDrag::new(0.5, rate), LinearDrag::new(0.25, rate));
            let (first, middle) = half.advance(v, g);
            let (second, end) = half.advance(middle, g);
            let (displacement, once) = whole.advance(v, g);
            assert!((first + second - displacement).length() < 1e-14);
            assert!((end - once).length() < 1e-14);
        }
    }
}
