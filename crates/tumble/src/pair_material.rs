//! The contact law between two bodies, from the materials of both.

use crate::{ContactLaw, Damping, Material, damping_ratio};

/// The parameters of a body for its contacts with other bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairMaterial {
    /// Stiffness k (N/m).
    pub stiffness: f64,
    /// Normal damping.
    pub damping: PairDamping,
    /// Coulomb coefficient μ.
    pub friction: f64,
    /// Tangential spring k_t (N/m).
    pub friction_spring: f64,
    /// Tangential dashpot c_t (N·s/m); `None` is √(m k_t).
    pub friction_damping: Option<f64>,
    /// 1/M (1/kg); 0 for a body with prescribed motion.
    pub inverse_mass: f64,
    /// The number of particles among which the mass is divided for the contact law: all of them, or 1 for a body
    /// of spheres.
    pub share: f64,
}

/// The normal damping of contacts with other bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairDamping {
    /// The dashpot c_n (N·s/m).
    Dashpot(f64),
    /// The damping ratio ζ = c_n / (2 √(k m)).
    Ratio(f64),
}

impl PairMaterial {
    /// The parameters from a complete material.
    pub fn new(material: &Material, inverse_mass: f64, share: f64) -> Self {
        let k = material.collision_stiffness;
        Self {
            stiffness: k,
            damping: match material.damping {
                Damping::Dashpot(c) => PairDamping::Dashpot(c),
                Damping::Restitution(e) => PairDamping::Ratio(damping_ratio(e)),
            },
            friction: material.friction_stiffness,
            friction_spring: material.friction_spring.unwrap_or(2.0 / 7.0 * k),
            friction_damping: material.friction_damping,
            inverse_mass,
            share,
        }
    }

    /// Whether any force depends on velocity: dashpots, and friction, which slips along the velocity.
    pub fn is_damped(&self) -> bool {
        let normal = match self.damping {
            PairDamping::Dashpot(c) | PairDamping::Ratio(c) => c > 0.0,
        };
        normal || self.friction > 0.0
    }

    /// The contact law of a particle of this body against the `other` body.
    ///
    /// Stiffnesses are harmonic means (two springs in series, each of half length), coefficients of friction
    /// geometric means (zero if either is zero), and dashpots arithmetic means. Dashpots given by a restitution
    /// or by the default √(m k_t) are computed with the k, k_t and m of the pair. Two bodies of the same material
    /// therefore have the law of that material. m is the reduced mass M₁M₂/(M₁ + M₂) divided by the number of
    /// particles of this body that share it.
    pub fn law(&self, other: &Self) -> ContactLaw {
        let mass = 1.0 / ((self.inverse_mass + other.inverse_mass) * self.share);
        let stiffness = harmonic_mean(self.stiffness, other.stiffness);
        let friction_spring = harmonic_mean(self.friction_spring, other.friction_spring);
        let normal = |damping: PairDamping| match damping {
            PairDamping::Dashpot(c) => c,
            PairDamping::Ratio(zeta) => 2.0 * zeta * (stiffness * mass).sqrt(),
        };
        let tangential =
            |damping: Option<f64>| damping.unwrap_or_else(|| (mass * friction_spring).sqrt());
        ContactLaw {
            stiffness,
            damping: 0.5 * (normal(self.damping) + normal(other.damping)),
            friction: (self.friction * other.friction).sqrt(),
            friction_spring,
            friction_damping: 0.5
                * (tangential(self.friction_damping) + tangential(other.friction_damping)),
        }
    }
}

/// The harmonic mean 2 a b / (a + b).
fn harmonic_mean(a: f64, b: f64) -> f64 {
    // exact for equal values
    if a == b { a } else { 2.0 * a * (b / (a + b)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(k: f64, mu: f64, damping: Damping) -> Material {
        Material { collision_stiffness: k, friction_stiffness: mu, damping, ..Material::default() }
    }

    #[test]
    fn two_bodies_of_one_material_have_its_contact_law() {
        let one = material(1e6, 0.3, Damping::Restitution(0.5));
        let (a, b) = (PairMaterial::new(&one, 0.5, 1.0), PairMaterial::new(&one, 0.5, 1.0));
        assert_eq!(a.law(&b), one.law(1.0));
    }

    #[test]
    fn the_contact_law_of_two_spheres_is_symmetric() {
        let a = PairMaterial::new(&material(1e6, 0.3, Damping::Restitution(0.5)), 0.5, 1.0);
        let b = PairMaterial::new(&material(3e5, 0.7, Damping::Dashpot(12.0)), 0.1, 1.0);
        assert_eq!(a.law(&b), b.law(&a));
        let law = a.law(&b);
        assert!(law.stiffness > 3e5 && law.stiffness < 1e6);
    }

    #[test]
    fn the_pair_has_no_friction_if_one_body_has_none_and_a_prescribed_body_has_infinite_mass() {
        let smooth = PairMaterial::new(&material(1e6, 0.0, Damping::Dashpot(0.0)), 0.0, 1.0);
        let rough = PairMaterial::new(&material(1e6, 2.0, Damping::Restitution(0.5)), 0.25, 10.0);
        let law = rough.law(&smooth);
        assert_eq!(law.friction, 0.0);
        // the mean of the dashpot of a particle of 0.4 kg and zero
        let alone = material(1e6, 2.0, Damping::Restitution(0.5)).law(0.4);
        assert!((law.damping / alone.damping - 0.5).abs() < 1e-15);
    }
}
