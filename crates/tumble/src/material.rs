//! What a contact is made of.

use std::f64::consts::PI;

/// How a contact loses energy along its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping {
    /// `collision_damping`: a dashpot c_n (N·s/m).
    Dashpot(f64),
    /// `restitution`: the dashpot that throws a single particle back at e times its speed, 0 < e ≤ 1.
    Restitution(f64),
}

/// The material of contacts, as scenes say it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Stiffness k of a particle's contact spring (N/m).
    pub collision_stiffness: f64,
    /// Stiffness κ of a surface (N/m³), instead of k where it is given: a particle has k = κ A, A its share of
    /// the body's surface, so that how a body bounces does not depend on how finely it is sampled. All else
    /// that is said per particle is then said of a particle of mean area, and scales with A.
    pub collision_stiffness_per_area: Option<f64>,
    /// Its dashpot.
    pub damping: Damping,
    /// Coulomb coefficient of friction μ.
    pub friction_stiffness: f64,
    /// Stiffness k_t of the tangential spring (N/m); `None` is 2/7 of k.
    pub friction_spring: Option<f64>,
    /// Tangential dashpot c_t (N·s/m); `None` is √(m k_t), half of what is critical for one particle.
    pub friction_damping: Option<f64>,
}

impl Default for Material {
    /// k = 1e4 N/m without dashpot or friction, as in the basic system.
    fn default() -> Self {
        Self {
            collision_stiffness: 1e4,
            collision_stiffness_per_area: None,
            damping: Damping::Dashpot(0.0),
            friction_stiffness: 0.0,
            friction_spring: None,
            friction_damping: None,
        }
    }
}

/// What a wall or a body says about its own contacts; the rest comes from the world's material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaterialOverride {
    /// See [`Material::collision_stiffness`]; takes the place of a stiffness per area of the rest.
    pub collision_stiffness: Option<f64>,
    /// See [`Material::collision_stiffness_per_area`]; heard before `collision_stiffness` if both are given.
    pub collision_stiffness_per_area: Option<f64>,
    /// See [`Material::damping`].
    pub damping: Option<Damping>,
    /// See [`Material::friction_stiffness`].
    pub friction_stiffness: Option<f64>,
    /// See [`Material::friction_spring`].
    pub friction_spring: Option<f64>,
    /// See [`Material::friction_damping`].
    pub friction_damping: Option<f64>,
}

impl MaterialOverride {
    /// These values over a material that says the rest.
    pub fn over(self, rest: Material) -> Material {
        let per_area = self.collision_stiffness_per_area;
        let says_stiffness = per_area.is_some() || self.collision_stiffness.is_some();
        Material {
            collision_stiffness: self.collision_stiffness.unwrap_or(rest.collision_stiffness),
            collision_stiffness_per_area: if says_stiffness {
                per_area
            } else {
                rest.collision_stiffness_per_area
            },
            damping: self.damping.unwrap_or(rest.damping),
            friction_stiffness: self.friction_stiffness.unwrap_or(rest.friction_stiffness),
            friction_spring: self.friction_spring.or(rest.friction_spring),
            friction_damping: self.friction_damping.or(rest.friction_damping),
        }
    }
}

impl From<Material> for MaterialOverride {
    /// One that says everything that the material says.
    fn from(material: Material) -> Self {
        Self {
            collision_stiffness: match material.collision_stiffness_per_area {
                Some(_) => None,
                None => Some(material.collision_stiffness),
            },
            collision_stiffness_per_area: material.collision_stiffness_per_area,
            damping: Some(material.damping),
            friction_stiffness: Some(material.friction_stiffness),
            friction_spring: material.friction_spring,
            friction_damping: material.friction_damping,
        }
    }
}

impl Material {
    /// The material between a wall and a body: what only one of them says holds, and a wall is
    /// heard before a body.
    pub fn between(self, wall: MaterialOverride, body: MaterialOverride) -> Self {
        wall.over(body.over(self))
    }

    /// The material of particles that share a surface of `area` (m²) each, at the mean: a stiffness per area
    /// becomes one per particle.
    pub fn at_area(self, area: f64) -> Self {
        match self.collision_stiffness_per_area {
            Some(stiffness) => Self {
                collision_stiffness: stiffness * area,
                collision_stiffness_per_area: None,
                ..self
            },
            None => self,
        }
    }

    /// The law of contact for particles of `mass` m (kg). Of a material with a stiffness per area,
    /// [`Material::at_area`] is to be taken first.
    pub fn law(&self, mass: f64) -> ContactLaw {
        let k = self.collision_stiffness;
        let friction_spring = self.friction_spring.unwrap_or(2.0 / 7.0 * k);
        ContactLaw {
            stiffness: k,
            damping: match self.damping {
                Damping::Dashpot(c) => c,
                Damping::Restitution(e) => 2.0 * damping_ratio(e) * (k * mass).sqrt(),
            },
            friction: self.friction_stiffness,
            friction_spring,
            friction_damping: self.friction_damping.unwrap_or((mass * friction_spring).sqrt()),
        }
    }
}

/// The law of contact between the particles of one body and one wall. Where they have weights
/// ([`Particles::weight`](crate::Particles::weight)) it is the law of one that weighs 1, and all forces of a particle
/// are multiplied by its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Normal spring k (N/m).
    pub stiffness: f64,
    /// Normal dashpot c_n (N·s/m).
    pub damping: f64,
    /// Coulomb coefficient μ.
    pub friction: f64,
    /// Tangential spring k_t (N/m).
    pub friction_spring: f64,
    /// Tangential dashpot c_t (N·s/m).
    pub friction_damping: f64,
}

impl ContactLaw {
    /// Whether nothing but the normal spring acts, so that the law is a sum over depths.
    pub fn is_elastic(&self) -> bool {
        self.damping == 0.0 && self.friction == 0.0
    }

    /// Whether a force depends on velocity.
    pub fn is_damped(&self) -> bool {
        self.damping > 0.0 || (self.friction > 0.0 && self.friction_damping > 0.0)
    }
}

/// Coefficient of restitution of a particle on a spring and dashpot whose sum never pulls, without
/// gravity, for the damping ratio ζ = c_n / (2 √(k m)).
///
/// The contact ends when the force, not the depth, is back at zero: T. Schwager & T. Pöschel, *Coefficient
/// of restitution and linear-dashpot model revisited*, Granular Matter 9 (2007) 465. With
/// w = √|1 − ζ²|: e = exp(−(ζ/w) θ), θ = atan2(2 ζ w, 2 ζ² − 1), and its hyperbolic twin for ζ > 1.
pub fn restitution(ratio: f64) -> f64 {
    let z = ratio;
    let w2 = 1.0 - z * z;
    if w2.abs() < 1e-9 {
        return libm::exp(-2.0);
    }
    let w = w2.abs().sqrt();
    if w2 > 0.0 {
        libm::exp(-z / w * (PI - libm::atan2(2.0 * z * w, 1.0 - 2.0 * z * z)))
    } else {
        // (z + w)/(z − w) = (z + w)²
        libm::pow(z + w, -2.0 * z / w)
    }
}

/// The damping ratio ζ that gives the restitution `e`, 0 < e ≤ 1, by bisection: e falls as ζ grows.
pub fn damping_ratio(e: f64) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while restitution(high) > e && high < 1e6 {
        high *= 2.0;
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if restitution(middle) > e { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The damped oscillator itself, in small steps, until the force is back at zero.
    fn measured(ratio: f64) -> f64 {
        let (mut x, mut v, h) = (0.0f64, 1.0f64, 1e-5);
        loop {
            let a = |x: f64, v: f64| -x - 2.0 * ratio * v;
            let (k1x, k1v) = (v, a(x, v));
            let (k2x, k2v) = (v + 0.5 * h * k1v, a(x + 0.5 * h * k1x, v + 0.5 * h * k1v));
            let (x1, v1) = (x + h * k2x, v + h * k2v);
            if a(x1, v1) >= 0.0 {
                return -v1;
            }
            (x, v) = (x1, v1);
        }
    }

    #[test]
    fn the_formula_is_that_of_the_oscillator() {
        for ratio in [0.01, 0.1, 0.3, 0.7, 0.72, 0.99, 1.5, 3.0] {
            let (formula, found) = (restitution(ratio), measured(ratio));
            assert!((formula - found).abs() < 2e-4, "ζ = {ratio}: {formula} {found}");
        }
        assert!((restitution(1.0) - measured(1.0)).abs() < 2e-4);
    }

    #[test]
    fn restitution_and_ratio_are_inverse() {
        for e in [0.02, 0.1, 0.135, 0.5, 0.9, 0.999] {
            assert!((restitution(damping_ratio(e)) - e).abs() < 1e-9, "e = {e}");
        }
        assert_eq!(damping_ratio(1.0), 0.0);
    }
}
