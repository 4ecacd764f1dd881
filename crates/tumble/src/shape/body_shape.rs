//! A shape: everything about a body that does not depend on its mass or its motion.

use glam::{DMat3, DVec3};

use super::areas::{Cover, Shares};
use super::mass::{MassProperties, PrincipalAxes, inertia_from_second_moment, outer};
use super::{Mesh, OpenMesh, Particles, SampleError, Sampling, ShellError};

/// Particles and mass distribution of a body, shared by all bodies that look alike.
///
/// The body frame has its origin at the centre of mass and the axes of the input coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub(super) particles: Particles,
    surface: Mesh,
    centre: DVec3,
    gyration: DMat3,
    principal: PrincipalAxes,
    moments: ParticleMoments,
    radius: f64,
    pub(super) cover: Cover,
    pub(super) shares: Option<Shares>,
}

/// Sums over the particles that the closed forms of drag need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleMoments {
    /// How many particles, N.
    pub count: f64,
    /// Σ rᵢ (m), zero where equal particles carry the mass.
    pub first: DVec3,
    /// Σ (rᵢ·rᵢ 1 − rᵢ rᵢᵀ) (m²).
    pub second: DMat3,
    /// Whether equal particles carry the mass, so that drag acts on both momenta at one rate.
    pub carry_mass: bool,
}

/// How the mass of a body is spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassModel {
    /// Equally over its particles.
    #[default]
    Particles,
    /// Evenly over its surface.
    Shell,
    /// Evenly over the volume that its closed mesh encloses.
    Solid,
}

/// Why a shape cannot be made.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeError {
    /// There is no particle.
    NoParticles,
    /// A particle has a coordinate that is NaN or infinite.
    NotFinite {
        /// Index of the particle, from 0.
        particle: usize,
    },
    /// The mesh cannot be sampled as asked.
    Sample(SampleError),
    /// A solid needs a closed mesh, and this one is not.
    Open(OpenMesh),
    /// A shell needs triangles with an area, and there are none.
    Shell(ShellError),
    /// The particles are so far apart that their inertia overflows a double.
    TooLarge,
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
            Self::TooLarge => write!(
                f,
                "the particles are so far apart that their inertia is not a finite number; scale the body down"
            ),
        }
    }
}

impl std::error::Error for ShapeError {}

impl Shape {
    /// A shape whose mass sits in equal particles at `places` (m), in any frame.
    ///
    /// # Errors
    /// [`ShapeError`] when there is no particle, or one is not finite.
    pub fn of_particles(places: &[DVec3]) -> Result<Self, ShapeError> {
        Self::with_surface(places, Mesh::default())
    }

    /// As [`Shape::of_particles`], with a surface (same frame as `places`) to draw.
    ///
    /// # Errors
    /// [`ShapeError`] when there is no particle, or one is not finite.
    pub fn with_surface(places: &[DVec3], surface: Mesh) -> Result<Self, ShapeError> {
        let mass = MassProperties::of_particles(places, 1.0 / places.len().max(1) as f64);
        Self::with_mass(places, surface, mass.centre, mass.inertia, true)
    }

    /// A shape from a mesh: which of its points become particles, and how its mass is spread.
    ///
    /// # Errors
    /// [`ShapeError`] when the mesh cannot be sampled so, or cannot carry its mass so.
    pub fn of_mesh(
        mesh: &Mesh,
        sampling: Sampling,
        mass_model: MassModel,
    ) -> Result<Self, ShapeError> {
        let shape = Self::of_sampled_mesh(mesh, sampling, mass_model)?;
        Ok(Self { cover: sampling.into(), ..shape })
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
        Self::of_distribution(&places, mesh.clone(), integrals.centre, gyration)
    }

    /// A shape whose mass is spread otherwise than over its particles: a shell, a solid.
    ///
    /// `centre` is the centre of mass (m), `gyration` the inertia tensor about it for unit mass
    /// (I₀/M, m²), both in the frame of `places`.
    ///
    /// # Errors
    /// [`ShapeError`] when there is no particle, or one is not finite.
    pub fn of_distribution(
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
        carry_mass: bool,
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
        // what the rounding of the coordinates can feign as inertia, seen as a length squared
        let largest = places.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
        let rounding = 16.0 * f64::EPSILON * largest;
        let particles = Particles::new(places.iter().map(|&p| p - centre));
        for vertex in &mut surface.vertices {
            *vertex -= centre;
        }
        Ok(Self {
            principal: PrincipalAxes::of(gyration, rounding * rounding),
            moments: ParticleMoments::of(&particles, carry_mass),
            radius: particles.iter().fold(0.0, |m: f64, r| m.max(r.length())),
            particles,
            surface,
            centre,
            gyration,
            cover: Cover::Bare,
            shares: None,
        })
    }

    /// The particles' places rᵢ in the body frame (m).
    pub fn particles(&self) -> &Particles {
        &self.particles
    }

    /// The surface to draw, in the body frame (m); empty for bare particles.
    pub fn surface(&self) -> &Mesh {
        &self.surface
    }

    /// Where the centre of mass was in the frame of the input (m).
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

    /// Sums over the particles that drag needs.
    pub fn moments(&self) -> &ParticleMoments {
        &self.moments
    }

    /// Distance of the farthest particle from the centre of mass (m).
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl ParticleMoments {
    fn of(particles: &Particles, carry_mass: bool) -> Self {
        let first = if carry_mass { DVec3::ZERO } else { particles.iter().sum() };
        let second = particles.iter().fold(DMat3::ZERO, |sum, r| sum + outer(r, r));
        Self {
            count: particles.len() as f64,
            first,
            second: inertia_from_second_moment(second),
            carry_mass,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coincident_particles_away_from_the_origin_do_not_rotate() {
        let places = [DVec3::new(0.1, 0.2, 0.3); 7];
        let shape = Shape::of_particles(&places).unwrap();
        assert_eq!(shape.principal().rotation_count(), 0);
        assert_eq!(shape.principal().inverse(), DMat3::ZERO);
    }

    #[test]
    fn a_plane_of_particles_rotates_about_all_axes() {
        let places: Vec<_> =
            (0..9).map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3), 1.0)).collect();
        let shape = Shape::of_particles(&places).unwrap();
        assert_eq!(shape.principal().rotation_count(), 3);
        let m = shape.principal().moments;
        assert!((m.x + m.y - m.z).abs() < 1e-15, "perpendicular axis theorem");
    }

    #[test]
    fn tiny_and_huge_bodies_keep_their_axes() {
        for scale in [1e-100, 1e-6, 1.0, 1e6, 1e100] {
            let places = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO].map(|p| p * scale);
            let shape = Shape::of_particles(&places).unwrap();
            assert_eq!(shape.principal().rotation_count(), 3, "scale {scale}");
        }
        let huge = [DVec3::X * 1e200, DVec3::ZERO];
        assert_eq!(Shape::of_particles(&huge), Err(ShapeError::TooLarge));
    }
}
