//! Moments of the particles of a shape, and the mass-scaled matrix of the forces that act on them.

use glam::{DMat3, DVec3};

use super::mass::{PrincipalAxes, inertia_from_second_moment, outer};
use super::particles::Particles;

/// Sums over the particles, for the closed forms of drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleMoments {
    /// The number of particles, N.
    pub count: f64,
    /// Σ rᵢ (m), zero where equal particles carry the mass.
    pub first: DVec3,
    /// Σ (rᵢ·rᵢ 1 − rᵢ rᵢᵀ) (m²).
    pub second: DMat3,
    /// Whether equal particles carry the mass, so that drag acts on both momenta at one rate.
    pub carries_mass: bool,
}

impl ParticleMoments {
    /// The moments of unweighted particles.
    pub(super) fn new(particles: &Particles, carries_mass: bool) -> Self {
        let first = if carries_mass { DVec3::ZERO } else { particles.iter().sum() };
        let second = particles.iter().fold(DMat3::ZERO, |sum, r| sum + outer(r, r));
        Self {
            count: particles.len() as f64,
            first,
            second: inertia_from_second_moment(second),
            carries_mass,
        }
    }

    /// The moments with each particle multiplied by its weight.
    pub(super) fn weighted(particles: &Particles) -> Self {
        let (mut count, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for (index, r) in particles.iter().enumerate() {
            let weight = particles.weight(index);
            count += weight;
            first += r * weight;
            second += outer(r, r) * weight;
        }
        let second = inertia_from_second_moment(second);
        Self { count, first, second, carries_mass: false }
    }
}

/// The quadratic form Σ |uᵢ|² of the particles' velocities in mass-scaled coordinates.
///
/// The coordinates are √M v and √I ω in principal axes, so that the kinetic energy is half their squared
/// length. The eigenvalues are then the rates of a force −uᵢ on every particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MassScaledForm {
    /// √M.
    pub root_mass: f64,
    /// √I by principal axis, 0 where there is no inertia.
    pub root_inertia: DVec3,
    /// 1/√I by principal axis, 0 where there is no inertia.
    pub inverse_root_inertia: DVec3,
    /// The matrix (1/kg).
    pub matrix: [[f64; 6]; 6],
}

impl MassScaledForm {
    /// The form for a body of `mass` (kg) with these principal axes for unit mass.
    pub fn new(moments: &ParticleMoments, principal: &PrincipalAxes, mass: f64) -> Self {
        let axes = principal.axes;
        let inertia = principal.moments * mass;
        let root_inertia = DVec3::new(inertia.x.sqrt(), inertia.y.sqrt(), inertia.z.sqrt());
        let inverse = root_inertia.to_array().map(|r| if r > 0.0 { 1.0 / r } else { 0.0 });
        let root_mass = mass.sqrt();
        let s = axes.transpose() * moments.first;
        let g = axes.transpose() * moments.second * axes;
        let cross = DMat3::from_cols(
            DVec3::new(0.0, s.z, -s.y),
            DVec3::new(-s.z, 0.0, s.x),
            DVec3::new(s.y, -s.x, 0.0),
        );
        let mut matrix = [[0.0; 6]; 6];
        for i in 0..3 {
            matrix[i][i] = moments.count / mass;
            for j in 0..3 {
                matrix[3 + i][3 + j] = g.col(j)[i] * inverse[i] * inverse[j];
                matrix[3 + i][j] = cross.col(j)[i] * inverse[i] / root_mass;
                matrix[j][3 + i] = matrix[3 + i][j];
            }
        }
        let inverse_root_inertia = DVec3::from_array(inverse);
        Self { root_mass, root_inertia, inverse_root_inertia, matrix }
    }
}
