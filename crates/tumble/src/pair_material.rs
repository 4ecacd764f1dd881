//! The law of contact between two bodies, from what each of them is made of.

use crate::{ContactLaw, Damping, Material, damping_ratio};

/// What a body brings into its contacts with other bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairMaterial {
    /// Stiffness k (N/m).
    pub stiffness: f64,
    /// The dashpot c_n (N·s/m), or the damping ratio that a restitution comes from.
    pub damping: PairDamping,
    /// Coulomb coefficient μ.
    pub friction: f64,
    /// Tangential spring k_t (N/m).
    pub friction_spring: f64,
    /// Tangential dashpot c_t (N·s/m); `None` is √(m k_t).
    pub friction_damping: Option<f64>,
    /// 1/M (1/kg); 0 for a body that nothing moves.
    pub inverse_mass: f64,
    /// How many of its particles share the mass of the body where they touch: all of them, or one where each has
    /// a sphere of its own.
    pub share: f64,
}

/// How a body damps its contacts with other bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PairDamping {
    /// c_n (N·s/m).
    Dashpot(f64),
    /// ζ = c_n / (2 √(k m)).
    Ratio(f64),
}

impl PairMaterial {
    /// From a material with every key filled in.
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

    /// Whether a force depends on velocity.
    pub fn is_damped(&self) -> bool {
        let normal = match self.damping {
            PairDamping::Dashpot(c) | PairDamping::Ratio(c) => c > 0.0,
        };
        normal || (self.friction > 0.0 && self.friction_damping != Some(0.0))
    }

    /// The law where a particle of this body touches the `other`.
    ///
    /// Stiffnesses are harmonic means (two springs in series, each half as long), coefficients of friction are
    /// geometric means (nothing sticks to what is frictionless), dashpots arithmetic means, those that
    /// come from a restitution or from m computed with the k, k_t and m of the pair. Two bodies
    /// of one material therefore meet by its own numbers. m is what the two bodies weigh against each
    /// other, M₁M₂/(M₁ + M₂), shared by the particles of this body.
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

/// 2 a b / (a + b).
fn harmonic_mean(a: f64, b: f64) -> f64 {
    // equal ones keep their bits
    if a == b { a } else { 2.0 * a * (b / (a + b)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(k: f64, mu: f64, damping: Damping) -> Material {
        Material { collision_stiffness: k, friction_stiffness: mu, damping, ..Material::default() }
    }

    #[test]
    fn two_bodies_of_one_material_meet_by_its_numbers() {
        let one = material(1e6, 0.3, Damping::Restitution(0.5));
        let (a, b) = (PairMaterial::new(&one, 0.5, 1.0), PairMaterial::new(&one, 0.5, 1.0));
        assert_eq!(a.law(&b), one.law(1.0));
    }

    #[test]
    fn the_order_of_two_spheres_does_not_matter() {
        let a = PairMaterial::new(&material(1e6, 0.3, Damping::Restitution(0.5)), 0.5, 1.0);
        let b = PairMaterial::new(&material(3e5, 0.7, Damping::Dashpot(12.0)), 0.1, 1.0);
        assert_eq!(a.law(&b), b.law(&a));
        let law = a.law(&b);
        assert!(law.stiffness > 3e5 && law.stiffness < 1e6);
    }

    #[test]
    fn nothing_sticks_to_what_is_frictionless_and_a_held_body_weighs_without_end() {
        let smooth = PairMaterial::new(&material(1e6, 0.0, Damping::Dashpot(0.0)), 0.0, 1.0);
        let rough = PairMaterial::new(&material(1e6, 2.0, Damping::Restitution(0.5)), 0.25, 10.0);
        let law = rough.law(&smooth);
        assert_eq!(law.friction, 0.0);
        // half the dashpot of a particle of 0.4 kg: the other half has none
        let alone = material(1e6, 2.0, Damping::Restitution(0.5)).law(0.4);
        assert!((law.damping / alone.damping - 0.5).abs() < 1e-15);
    }
}
