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
    /// Tangential dashpot c_t (N·s/m); `None` is that of [`ContactLaw::friction_damping_factor`].
    pub friction_damping: Option<f64>,
    /// 1/M (1/kg); 0 for a body with prescribed motion.
    pub inverse_mass: f64,
}

/// The normal damping of contacts with other bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairDamping {
    /// The dashpot c_n (N·s/m).
    Dashpot(f64),
    /// The damping ratio ζ, see [`ContactLaw::damping_ratio`].
    Ratio(f64),
}

impl PairMaterial {
    /// The parameters from a complete material.
    pub fn new(material: &Material, inverse_mass: f64) -> Self {
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
    /// geometric means (zero if either is zero), and dashpots and damping ratios arithmetic means: of two bodies of which one has
    /// a dashpot and the other a restitution, each contributes half of its own. Two bodies of the same material
    /// therefore have the law of that material.
    pub fn law(&self, other: &Self) -> ContactLaw {
        let mean = |of: fn(&Self) -> f64| 0.5 * (of(self) + of(other));
        let damping_ratio = mean(|material| match material.damping {
            PairDamping::Dashpot(_) => 0.0,
            PairDamping::Ratio(zeta) => zeta,
        });
        ContactLaw {
            stiffness: harmonic_mean(self.stiffness, other.stiffness),
            damping: mean(|material| match material.damping {
                PairDamping::Dashpot(c) => c,
                PairDamping::Ratio(_) => 0.0,
            }),
            damping_ratio,
            asked_damping_ratio: damping_ratio,
            friction: (self.friction * other.friction).sqrt(),
            friction_spring: harmonic_mean(self.friction_spring, other.friction_spring),
            friction_damping: mean(|material| material.friction_damping.unwrap_or(0.0)),
            friction_damping_factor: mean(|material| {
                if material.friction_damping.is_none() { 1.0 } else { 0.0 }
            }),
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
        let (a, b) = (PairMaterial::new(&one, 0.5), PairMaterial::new(&one, 0.5));
        assert_eq!(a.law(&b), one.law());
    }

    #[test]
    fn the_contact_law_of_two_spheres_is_symmetric() {
        let a = PairMaterial::new(&material(1e6, 0.3, Damping::Restitution(0.5)), 0.5);
        let b = PairMaterial::new(&material(3e5, 0.7, Damping::Dashpot(12.0)), 0.1);
        assert_eq!(a.law(&b), b.law(&a));
        let law = a.law(&b);
        assert!(law.stiffness > 3e5 && law.stiffness < 1e6);
    }

    #[test]
    fn the_pair_has_no_friction_if_one_body_has_none_and_half_the_damping_of_each() {
        let smooth = PairMaterial::new(&material(1e6, 0.0, Damping::Dashpot(0.0)), 0.0);
        let rough = PairMaterial::new(&material(1e6, 2.0, Damping::Restitution(0.5)), 0.25);
        let law = rough.law(&smooth);
        assert_eq!(law.friction, 0.0);
        assert_eq!((law.damping, law.damping_ratio), (0.0, 0.5 * damping_ratio(0.5)));
    }
}
