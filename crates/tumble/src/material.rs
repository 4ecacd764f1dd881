//! Materials and the contact law between particles and walls.

use std::f64::consts::PI;

/// The normal damping of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Damping {
    /// `collision_damping`: a dashpot c_n (N·s/m).
    Dashpot(f64),
    /// `restitution`: the dashpots for which a body rebounds at e times its speed, 0 < e ≤ 1.
    Restitution(f64),
}

/// The material of contacts, with the quantities of scene files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Stiffness k of a particle's contact spring (N/m).
    pub collision_stiffness: f64,
    /// Stiffness κ per surface area (N/m³), which replaces k if given: a particle of surface area A has
    /// k = κ A, so that the rebound of a body does not depend on the number of its particles. All other
    /// quantities per particle then refer to a particle of mean area, and scale with A.
    pub collision_stiffness_per_area: Option<f64>,
    /// Normal damping.
    pub damping: Damping,
    /// Coulomb coefficient of friction μ.
    pub friction_stiffness: f64,
    /// Stiffness k_t of the tangential spring (N/m); `None` is 2/7 of k.
    pub friction_spring: Option<f64>,
    /// Tangential dashpot c_t of a particle (N·s/m); `None` is half the critical damping of the springs in contact.
    pub friction_damping: Option<f64>,
}

impl Default for Material {
    /// k = 1e4 N/m without damping or friction, as in the basic system.
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

/// Quantities that a wall or a body overrides for its own contacts; the rest comes from the world's material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaterialOverride {
    /// See [`Material::collision_stiffness`]; it also replaces a stiffness per area of the base material.
    pub collision_stiffness: Option<f64>,
    /// See [`Material::collision_stiffness_per_area`]; it takes precedence over `collision_stiffness`.
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
    /// The material `rest` with these values in place of its own.
    pub fn over(self, rest: Material) -> Material {
        let per_area = self.collision_stiffness_per_area;
        let has_stiffness = per_area.is_some() || self.collision_stiffness.is_some();
        Material {
            collision_stiffness: self.collision_stiffness.unwrap_or(rest.collision_stiffness),
            collision_stiffness_per_area: if has_stiffness {
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
    /// An override with all values of the material.
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
    /// The material of contacts between a wall and a body. Values of the wall take precedence over those of
    /// the body, and both over the world's.
    pub fn between(self, wall: MaterialOverride, body: MaterialOverride) -> Self {
        wall.over(body.over(self))
    }

    /// The material of particles with a mean surface area of `area` (m²): a stiffness per area becomes a
    /// stiffness per particle.
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

    /// The contact law.
    ///
    /// Apply [`Material::at_area`] first if the material has a stiffness per area.
    pub fn law(&self) -> ContactLaw {
        let k = self.collision_stiffness;
        let (damping, damping_ratio) = match self.damping {
            Damping::Dashpot(c) => (c, 0.0),
            Damping::Restitution(e) => (0.0, damping_ratio(e)),
        };
        ContactLaw {
            stiffness: k,
            damping,
            damping_ratio,
            asked_damping_ratio: damping_ratio,
            friction: self.friction_stiffness,
            friction_spring: self.friction_spring.unwrap_or(2.0 / 7.0 * k),
            friction_damping: self.friction_damping.unwrap_or(0.0),
            friction_damping_factor: if self.friction_damping.is_none() { 1.0 } else { 0.0 },
        }
    }
}

/// The contact law between the particles of one body and one wall.
///
/// For particles with weights ([`Particles::weight`](crate::Particles::weight)) it is the law at weight 1, and the
/// forces on a particle are multiplied by its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Normal spring k (N/m).
    pub stiffness: f64,
    /// Normal dashpot c_n (N·s/m), as given.
    pub damping: f64,
    /// Damping ratio ζ of all contacts between two bodies, or of a body and a wall, at one instant. It adds to `damping` the
    /// dashpots that give a restitution.
    pub damping_ratio: f64,
    /// The damping ratio of the restitution that the materials ask for, whether their dashpots are among those given or not.
    pub asked_damping_ratio: f64,
    /// Coulomb coefficient μ.
    pub friction: f64,
    /// Tangential spring k_t (N/m).
    pub friction_spring: f64,
    /// Tangential dashpot c_t (N·s/m), as given.
    pub friction_damping: f64,
    /// The part of √(m Σ k_t) that all contacts together add to their tangential dashpots: 1 where none is given.
    pub friction_damping_factor: f64,
}

impl ContactLaw {
    /// Whether only the normal spring acts.
    pub fn is_elastic(&self) -> bool {
        self.damping == 0.0 && self.damping_ratio == 0.0 && self.friction == 0.0
    }

    /// Whether any force depends on velocity: dashpots, and friction, which slips along the velocity.
    pub fn is_damped(&self) -> bool {
        self.damping > 0.0 || self.damping_ratio > 0.0 || self.friction > 0.0
    }

    /// Whether the dashpots of a contact depend on the other contacts between the same bodies.
    pub(crate) fn depends_on_patch(&self) -> bool {
        self.damping_ratio > 0.0 || (self.friction > 0.0 && self.friction_damping_factor > 0.0)
    }

    /// The law of a particle that is alone in contact, with the effective `mass` m (kg).
    pub fn of_single_particle(&self, mass: f64) -> Self {
        self.with_dashpots(
            2.0 * self.damping_ratio * (self.stiffness * mass).sqrt(),
            self.friction_damping_factor * (self.friction_spring * mass).sqrt(),
        )
    }

    /// The law whose dashpots have these additions (N·s/m), and depend on nothing else.
    pub(crate) fn with_dashpots(&self, normal: f64, tangential: f64) -> Self {
        Self {
            damping: self.damping + normal,
            damping_ratio: 0.0,
            friction_damping: self.friction_damping + tangential,
            friction_damping_factor: 0.0,
            ..*self
        }
    }
}

/// Coefficient of restitution of a particle on a spring and dashpot, for the damping ratio ζ = c_n / (2 √(k m)).
///
/// The sum of spring and dashpot is never attractive: the contact ends when the force, not the depth, returns to
/// zero (T. Schwager & T. Pöschel, *Coefficient of restitution and linear-dashpot model revisited*, Granular Matter
/// 9 (2007) 465). Without gravity and with w = √|1 − ζ²|: e = exp(−(ζ/w) θ), θ = atan2(2 ζ w, 2 ζ² − 1), and the
/// hyperbolic equivalent for ζ > 1.
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

/// The damping ratio ζ for a coefficient of restitution `e`, 0 < e ≤ 1, by bisection.
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

    /// The restitution of the damped oscillator, integrated in small steps until the force returns to zero.
    fn integrated(ratio: f64) -> f64 {
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
    fn the_restitution_formula_agrees_with_the_integrated_oscillator() {
        for ratio in [0.01, 0.1, 0.3, 0.7, 0.72, 0.99, 1.5, 3.0] {
            let (formula, found) = (restitution(ratio), integrated(ratio));
            assert!((formula - found).abs() < 2e-4, "ζ = {ratio}: {formula} {found}");
        }
        assert!((restitution(1.0) - integrated(1.0)).abs() < 2e-4);
    }

    #[test]
    fn damping_ratio_is_the_inverse_of_restitution() {
        for e in [0.02, 0.1, 0.135, 0.5, 0.9, 0.999] {
            assert!((restitution(damping_ratio(e)) - e).abs() < 1e-9, "e = {e}");
        }
        assert_eq!(damping_ratio(1.0), 0.0);
    }
}
