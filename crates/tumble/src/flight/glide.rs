//! The flight of a point through a medium that brakes it: x'' = g − γ x'.

use glam::DVec3;

/// The exact solution over one time h, for drag at the rate γ: with z = γ h and
/// φ₁ = (1 − e⁻ᶻ)/z, φ₂ = (1 − φ₁)/z, φ₃ = (½ − φ₂)/z it has no singularity at γ = 0.
#[derive(Clone, Copy, Debug)]
pub struct Glide {
    time: f64,
    rate: f64,
    once: Phi,
    twice: Phi,
}

#[derive(Clone, Copy, Debug)]
struct Phi {
    one: f64,
    two: f64,
    three: f64,
}

impl Phi {
    fn of(z: f64) -> Self {
        if z.abs() < 0.5 {
            // φ₃ = Σ (−z)ⁿ/(n + 3)!, and the others from it without cancellation
            let mut term = 1.0 / 6.0;
            let mut three = term;
            for n in 1..14 {
                term *= -z / f64::from(n + 3);
                three += term;
                // what is left is below rounding: at once where there is no drag
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

impl Glide {
    /// Over `time` h (s) with drag at `rate` γ (1/s), F = −γ M v.
    pub fn new(time: f64, rate: f64) -> Self {
        let z = rate * time;
        Self { time, rate, once: Phi::of(z), twice: Phi::of(2.0 * z) }
    }

    /// e^(−γ h): what is left of a momentum.
    pub fn decay(&self) -> f64 {
        if self.rate == 0.0 { 1.0 } else { libm::exp(-self.rate * self.time) }
    }

    /// (1 − e^(−γ h))/γ (s): for how long a body without drag would have to turn, with the angular
    /// momentum of the start, to end up in the same orientation.
    pub fn free_time(&self) -> f64 {
        self.time * self.once.one
    }

    /// Way (m) and new velocity (m/s) from the velocity and gravity.
    pub fn advance(&self, velocity: DVec3, gravity: DVec3) -> (DVec3, DVec3) {
        let h = self.time;
        let way = velocity * (h * self.once.one) + gravity * (h * h * self.once.two);
        (way, velocity * self.decay() + gravity * (h * self.once.one))
    }

    /// γ ∫ v² dt (m²/s²): what drag takes from each kilogram that moves with `velocity` at the start.
    pub fn loss(&self, velocity: DVec3, gravity: DVec3) -> f64 {
        let h = self.time;
        let (one, two) = (self.once, self.twice);
        self.rate
            * h
            * (velocity.length_squared() * two.one
                + 2.0 * h * velocity.dot(gravity) * (2.0 * two.two - one.two)
                + h * h * gravity.length_squared() * (4.0 * two.three - 2.0 * one.three))
    }

    /// 1 − e^(−2 γ h): the part of a rotational energy that drag takes.
    pub fn rotational_loss(&self) -> f64 {
        2.0 * self.rate * self.time * self.twice.one
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Energy is conserved by the closed forms themselves, from no drag to hopeless drag.
    #[test]
    fn what_drag_takes_is_what_kinetic_and_gravitational_energy_lose() {
        let (v, g) = (DVec3::new(3.0, -2.0, 5.0), DVec3::new(0.3, -9.8, 0.1));
        for rate in [0.0, 1e-12, 1e-3, 0.24, 0.26, 0.49, 0.51, 1.0, 30.0, 5e3] {
            for time in [1e-3, 0.5, 1.0, -0.01] {
                let glide = Glide::new(time, rate);
                let (way, end) = glide.advance(v, g);
                let gone = 0.5 * (v.length_squared() - end.length_squared()) + g.dot(way);
                let scale =
                    0.5 * end.length_squared() + 0.5 * v.length_squared() + way.length() * 10.0;
                let off = (gone - glide.loss(v, g)).abs();
                assert!(off < 1e-14 * scale, "rate {rate}, time {time}: {off:e}");
            }
        }
    }

    #[test]
    fn two_halves_are_one_whole() {
        let (v, g) = (DVec3::new(3.0, -2.0, 5.0), DVec3::new(0.3, -9.8, 0.1));
        for rate in [0.0, 1e-9, 0.7, 40.0] {
            let (whole, half) = (Glide::new(0.5, rate), Glide::new(0.25, rate));
            let (first, middle) = half.advance(v, g);
            let (second, end) = half.advance(middle, g);
            let (way, once) = whole.advance(v, g);
            assert!((first + second - way).length() < 1e-14);
            assert!((end - once).length() < 1e-14);
        }
    }
}
