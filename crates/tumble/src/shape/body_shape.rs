//! The shape of a body: everything that does not depend on its mass or its motion.

use glam::{DMat3, DVec3};

use super::area_weights::{AreaWeights, ParticleSource};
use super::integrals::{ShellError, SolidError};
use super::mass::{MassProperties, PrincipalAxes, diagonalise, is_possible_inertia};
use super::mesh::Mesh;
use super::moments::ParticleMoments;
use super::particles::Particles;
use super::sampling::{SampleError, Sampling};

/// Particles and mass distribution of a body; several bodies may share one shape.
///
/// The body frame has its origin at the centre of mass, and its axes are those of the input coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub(super) particles: Particles,
    surface: Mesh,
    centre: DVec3,
    gyration: DMat3,
    principal: PrincipalAxes,
    moments: ParticleMoments,
    radius: f64,
    pub(super) particle_source: ParticleSource,
    pub(super) area_weights: Option<AreaWeights>,
}

/// How the mass of a body is distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassModel {
    /// In equal parts over the particles.
    #[default]
    Particles,
    /// Uniformly over the surface of the mesh.
    Shell,
    /// Uniformly over the volume enclosed by the mesh, which must be closed.
    Solid,
}

/// Why a shape cannot be made.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeError {
    /// There are no particles.
    NoParticles,
    /// A coordinate of a particle is NaN or infinite.
    NotFinite {
        /// Index of the particle, from 0.
        particle: usize,
    },
    /// The mesh cannot be sampled.
    Sample(SampleError),
    /// [`MassModel::Solid`] needs a closed mesh.
    Open(SolidError),
    /// [`MassModel::Shell`] needs triangles with a nonzero area.
    Shell(ShellError),
    /// The inertia overflows a double.
    TooLarge,
    /// No body has this inertia: a moment is negative, or larger than the sum of the others.
    Impossible {
        /// The moments for unit mass (m²), in ascending order.
        moments: DVec3,
    },
    /// A given inertia tensor is not symmetric.
    Asymmetric,
    /// There is no moment of inertia about an axis through the centre of mass from which a particle is away.
    NoInertia {
        /// Direction of the axis, of length 1.
        axis: DVec3,
    },
}

impl std::fmt::Display for ShapeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoParticles => write!(f, "a body needs at least one particle"),
            Self::NotFinite { particle } => {
                write!(
                    f,
                    "particle {particle} (counted from 0) has a coordinate that is not finite"
                )
            }
            Self::Sample(error) => error.fmt(f),
            Self::Open(error) => error.fmt(f),
            Self::Shell(error) => error.fmt(f),
            Self::Impossible { moments: m } => write!(
                f,
                "no body has the moments of inertia {:e}, {:e} and {:e} m² for unit mass; each is at least 0 and at most the sum of the others",
                m.x, m.y, m.z
            ),
            Self::Asymmetric => write!(f, "an inertia tensor is symmetric, but this one is not"),
            Self::NoInertia { axis: a } => write!(
                f,
                "there is no moment of inertia about the axis ({:.3}, {:.3}, {:.3}) through the centre of mass, but particles away from it; \
                 the moment must be above 0",
                a.x, a.y, a.z
            ),
            Self::TooLarge => write!(
                f,
                "the particles are so far apart that their inertia is not a finite number; scale the body down"
            ),
        }
    }
}

impl std::error::Error for ShapeError {}

impl Shape {
    /// A shape with equal masses at `places` (m), given in any frame.
    ///
    /// # Errors
    /// [`ShapeError`] if there are no particles, or a coordinate is not finite.
    pub fn from_particles(places: &[DVec3]) -> Result<Self, ShapeError> {
        Self::with_surface(places, Mesh::default())
    }

    /// As [`Shape::from_particles`], with a surface mesh in the same frame.
    ///
    /// # Errors
    /// [`ShapeError`] if there are no particles, or a coordinate is not finite.
    pub fn with_surface(places: &[DVec3], surface: Mesh) -> Result<Self, ShapeError> {
        let mass = MassProperties::from_particles(places, 1.0 / places.len().max(1) as f64);
        Self::with_mass(places, surface, mass.centre, mass.inertia, true)
    }

    /// A shape from a mesh, with particles from `sampling` and mass distributed by `mass_model`.
    ///
    /// Closed surfaces of the mesh may be wound either way: mass and contact are those of [`Mesh::oriented`].
    ///
    /// # Errors
    /// [`ShapeError`] if the mesh does not suit the sampling or the mass model.
    pub fn from_mesh(
        mesh: &Mesh,
        sampling: Sampling,
        mass_model: MassModel,
    ) -> Result<Self, ShapeError> {
        let mesh = mesh.oriented().mesh;
        let shape = Self::of_sampled_mesh(&mesh, sampling, mass_model)?;
        Ok(Self { particle_source: sampling.into(), ..shape })
    }

    fn of_sampled_mesh(
        mesh: &Mesh,
        sampling: Sampling,
        mass_model: MassModel,
    ) -> Result<Self, ShapeError> {
        let places = mesh.sample(sampling).map_err(ShapeError::Sample)?;
        let integrals = match mass_model {
            MassModel::Particles => return Self::with_surface(&places, mesh.clone()),
            MassModel::Shell => mesh.shell_integrals().map_err(ShapeError::Shell)?,
            MassModel::Solid => mesh.solid_integrals().map_err(ShapeError::Open)?,
        };
        let gyration = integrals.inertia() * (1.0 / integrals.measure);
        Self::from_distribution(&places, mesh.clone(), integrals.centre, gyration)
    }

    /// A shape whose mass distribution is independent of its particles, such as a shell or a solid.
    ///
    /// `centre` is the centre of mass (m), `gyration` the inertia tensor about it for unit mass
    /// (I₀/M, m²), both in the frame of `places`.
    ///
    /// # Errors
    /// [`ShapeError`] if there are no particles, a number is not finite, or no body has this inertia.
    pub fn from_distribution(
        places: &[DVec3],
        surface: Mesh,
        centre: DVec3,
        gyration: DMat3,
    ) -> Result<Self, ShapeError> {
        Self::with_mass(places, surface, centre, gyration, false)
    }

    fn with_mass(
        places: &[DVec3],
        mut surface: Mesh,
        centre: DVec3,
        gyration: DMat3,
        carries_mass: bool,
    ) -> Result<Self, ShapeError> {
        if places.is_empty() {
            return Err(ShapeError::NoParticles);
        }
        if let Some(particle) = places.iter().position(|p| !p.is_finite()) {
            return Err(ShapeError::NotFinite { particle });
        }
        if !centre.is_finite() || !gyration.is_finite() {
            return Err(ShapeError::TooLarge);
        }
        if !carries_mass && !is_possible_inertia(gyration) {
            let mut moments = diagonalise(gyration.to_cols_array_2d()).0;
            moments.sort_by(f64::total_cmp);
            return Err(ShapeError::Impossible { moments: DVec3::from_array(moments) });
        }
        // rounding of the coordinates may appear as inertia of up to this length squared
        let largest = places.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
        let rounding = 16.0 * f64::EPSILON * largest;
        let particles = Particles::new(places.iter().map(|&p| p - centre));
        for vertex in &mut surface.vertices {
            *vertex -= centre;
        }
        Ok(Self {
            principal: PrincipalAxes::new(gyration, rounding * rounding),
            moments: ParticleMoments::new(&particles, carries_mass),
            radius: particles.iter().fold(0.0, |m: f64, r| m.max(r.length())),
            particles,
            surface,
            centre,
            gyration,
            particle_source: ParticleSource::Points,
            area_weights: None,
        })
    }

    /// The shape with its centre at `centre` (m) in the frame of the input of `other`, from which its particles come.
    pub(super) fn described_as(self, other: &Self, centre: DVec3) -> Self {
        let (particle_source, area_weights) = (other.particle_source, other.area_weights);
        Self { centre, particle_source, area_weights, ..self }
    }

    /// The particles, with positions rᵢ in the body frame (m).
    pub fn particles(&self) -> &Particles {
        &self.particles
    }

    /// The surface mesh in the body frame (m); empty for points without a mesh.
    pub fn surface(&self) -> &Mesh {
        &self.surface
    }

    /// The centre of mass in the frame of the input (m).
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Inertia tensor for unit mass, I₀/M (m²), in the body frame.
    pub fn gyration(&self) -> DMat3 {
        self.gyration
    }

    /// The principal axes of [`Shape::gyration`].
    pub fn principal(&self) -> &PrincipalAxes {
        &self.principal
    }

    /// Sums over the particles, for the closed forms of drag.
    pub fn moments(&self) -> &ParticleMoments {
        &self.moments
    }

    /// The distance of the farthest particle from the centre of mass (m).
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether there is one particle, at the centre of mass.
    pub(crate) fn is_single_particle(&self) -> bool {
        self.particles.len() == 1 && self.radius == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coincident_particles_have_no_inertia_anywhere() {
        let places = [DVec3::new(0.1, 0.2, 0.3); 7];
        let shape = Shape::from_particles(&places).unwrap();
        assert_eq!(shape.principal().rotation_count(), 0);
        assert_eq!(shape.principal().inverse(), DMat3::ZERO);
    }

    #[test]
    fn particles_in_a_plane_have_inertia_about_all_axes() {
        let places: Vec<_> =
            (0..9).map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3), 1.0)).collect();
        let shape = Shape::from_particles(&places).unwrap();
        assert_eq!(shape.principal().rotation_count(), 3);
        let m = shape.principal().moments;
        assert!((m.x + m.y - m.z).abs() < 1e-15, "perpendicular axis theorem");
    }

    #[test]
    fn impossible_moments_are_refused() {
        let of = |x: f64, y: f64, z: f64| {
            let inertia = DMat3::from_diagonal(DVec3::new(x, y, z));
            Shape::from_distribution(&[DVec3::X], Mesh::default(), DVec3::ZERO, inertia)
        };
        assert!(of(1.0, 1.0, 2.0).is_ok() && of(0.0, 1.0, 1.0).is_ok());
        for (x, y, z) in [(-1.0, 2.0, 2.0), (1.0, 1.0, 2.1), (-1e-3, 1.0, 1.0), (-1.0, -1.0, -1.0)]
        {
            assert!(matches!(of(x, y, z), Err(ShapeError::Impossible { .. })), "{x} {y} {z}");
        }
    }

    #[test]
    fn bodies_of_any_size_have_inertia_about_all_axes() {
        for scale in [1e-100, 1e-6, 1.0, 1e6, 1e100] {
            let places = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO].map(|p| p * scale);
            let shape = Shape::from_particles(&places).unwrap();
            assert_eq!(shape.principal().rotation_count(), 3, "scale {scale}");
        }
        let huge = [DVec3::X * 1e200, DVec3::ZERO];
        assert_eq!(Shape::from_particles(&huge), Err(ShapeError::TooLarge));
    }
}
