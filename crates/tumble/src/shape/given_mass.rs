//! Mass properties that are given in place of those of particles, surface or volume.

use glam::{DMat3, DVec3};

use super::body_shape::{Shape, ShapeError};

/// Entries across the diagonal may differ by this fraction of the largest entry.
const ASYMMETRY: f64 = 1e-6;

/// A particle is on an axis up to this fraction of the size of the shape.
const ON_AXIS: f64 = 1e-9;

impl Shape {
    /// The same particles and surface with another centre of mass and another inertia, for example measured ones.
    ///
    /// `centre` is the centre of mass (m) in the frame of the input, as [`Shape::centre`]. `gyration` is the inertia tensor about it for
    /// unit mass (I₀/M, m²), as [`Shape::gyration`]. The body frame moves to the new centre.
    ///
    /// ```
    /// use tumble::{DVec3, MassModel, Primitive, Sampling, Shape};
    ///
    /// // a loaded die: its inertia is about its own centre of mass, wherever that is
    /// let cube = Primitive::Box { size: DVec3::splat(0.02), divisions: 1 }.mesh()?;
    /// let die = Shape::from_mesh(&cube, Sampling::Vertices, MassModel::Solid)?;
    /// let loaded = die.with_distribution(DVec3::new(0.0, -0.003, 0.0), die.gyration())?;
    /// assert_eq!(loaded.particles().get(0) - die.particles().get(0), DVec3::new(0.0, 0.003, 0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ShapeError`] if a number is not finite, the tensor is not symmetric, no body has this inertia, or there is none about an axis
    /// from which a particle is away.
    pub fn with_distribution(&self, centre: DVec3, gyration: DMat3) -> Result<Self, ShapeError> {
        let gyration = symmetric(gyration)?;
        let places: Vec<DVec3> = self.particles().iter().collect();
        let moved = centre - self.centre();
        let shape = Self::from_distribution(&places, self.surface().clone(), moved, gyration)?;
        if !shape.moments().second.is_finite() {
            return Err(ShapeError::TooLarge);
        }
        let rounding = 16.0 * f64::EPSILON * centre.abs().max(self.centre().abs()).max_element();
        shape.check_inertia_of_particles(rounding)?;
        let shape = shape.described_as(self, centre);
        let Some(mean_area) = self.mean_area().filter(|_| self.particles().is_weighted()) else {
            return Ok(shape);
        };
        let weights: Vec<f64> =
            (0..places.len()).map(|index| self.particles().weight(index)).collect();
        Ok(shape.weighted(&weights, mean_area))
    }

    /// Refuses a shape without inertia about an axis from which a particle is away by more than `rounding` (m): a force on the particle
    /// would turn it without end.
    fn check_inertia_of_particles(&self, rounding: f64) -> Result<(), ShapeError> {
        let principal = self.principal();
        let tolerance = rounding + ON_AXIS * self.radius();
        let axes = [principal.axes.x_axis, principal.axes.y_axis, principal.axes.z_axis];
        for (axis, moment) in axes.into_iter().zip(principal.moments.to_array()) {
            let is_away = |r: DVec3| r.cross(axis).length() > tolerance;
            if moment == 0.0 && self.particles().iter().any(is_away) {
                return Err(ShapeError::NoInertia { axis });
            }
        }
        Ok(())
    }
}

/// A tensor that is symmetric up to rounding, made so.
fn symmetric(tensor: DMat3) -> Result<DMat3, ShapeError> {
    let transposed = tensor.transpose();
    let largest =
        |m: DMat3| m.to_cols_array().into_iter().fold(0.0f64, |most, x| most.max(x.abs()));
    if !tensor.is_finite() {
        return Err(ShapeError::TooLarge);
    }
    if largest(tensor - transposed) > ASYMMETRY * largest(tensor) {
        return Err(ShapeError::Asymmetric);
    }
    // halves are exact, and their sum cannot overflow
    Ok(tensor * 0.5 + transposed * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MassModel, Mesh, Primitive, Sampling};

    fn cube(model: MassModel) -> Shape {
        let mesh = Primitive::Box { size: DVec3::ONE, divisions: 1 }.mesh().unwrap();
        let vertices = mesh.vertices.iter().map(|v| *v + DVec3::X).collect();
        let mesh = Mesh { vertices, ..mesh };
        Shape::from_mesh(&mesh, Sampling::Vertices, model).unwrap()
    }

    #[test]
    fn particles_and_surface_are_about_the_given_centre() {
        let centre = DVec3::new(1.1, 0.2, 0.3);
        let given = cube(MassModel::Particles).with_distribution(centre, DMat3::IDENTITY).unwrap();
        assert_eq!(given.centre(), centre);
        assert_eq!(given.gyration(), DMat3::IDENTITY);
        let places = given.particles().iter().zip(&given.surface().vertices);
        for ((particle, vertex), before) in
            places.zip(cube(MassModel::Particles).particles().iter())
        {
            assert_eq!(particle, *vertex);
            assert!((particle + centre - before - DVec3::X).length() < 1e-15);
        }
        assert!((given.radius() - DVec3::new(0.6, 0.7, 0.8).length()).abs() < 1e-15);
        assert!((given.moments().first - 8.0 * (DVec3::X - centre)).length() < 1e-14);
    }

    /// Equal to the bits where what is given is what the shape has: nothing else changes.
    #[test]
    fn the_properties_of_the_solid_give_the_solid() {
        let solid = cube(MassModel::Solid).with_area_weights().unwrap();
        let given = solid.with_distribution(solid.centre(), solid.gyration()).unwrap();
        assert_eq!(given, solid);
        // and in place of those of the particles
        let particles = cube(MassModel::Particles);
        assert_eq!(
            particles.with_distribution(solid.centre(), solid.gyration()).unwrap(),
            cube(MassModel::Solid)
        );
    }

    #[test]
    fn what_no_body_has_is_refused() {
        let cube = cube(MassModel::Particles);
        let of = |x: f64, y: f64, z: f64| {
            cube.with_distribution(DVec3::ZERO, DMat3::from_diagonal(DVec3::new(x, y, z)))
        };
        assert!(of(1.0, 1.0, 2.0).is_ok());
        assert!(matches!(of(1.0, 1.0, 2.1), Err(ShapeError::Impossible { .. })));
        assert!(matches!(of(-1.0, 1.0, 1.0), Err(ShapeError::Impossible { .. })));
        assert_eq!(of(0.0, 1.0, 1.0), Err(ShapeError::NoInertia { axis: DVec3::X }));
        assert!(matches!(of(0.0, 0.0, 0.0), Err(ShapeError::NoInertia { .. })));
        assert_eq!(of(f64::NAN, 1.0, 1.0), Err(ShapeError::TooLarge));
        let skew = DMat3::from_cols_array_2d(&[[2.0, 0.1, 0.0], [0.2, 2.0, 0.0], [0.0, 0.0, 2.0]]);
        assert_eq!(cube.with_distribution(DVec3::ZERO, skew), Err(ShapeError::Asymmetric));
        let far = cube.with_distribution(DVec3::X * 1e200, DMat3::IDENTITY);
        assert_eq!(far, Err(ShapeError::TooLarge));
    }

    #[test]
    fn particles_on_a_line_need_no_inertia_about_it() {
        let rod = Shape::from_particles(&[DVec3::ZERO, DVec3::X, DVec3::X * 0.3]).unwrap();
        let gyration = DMat3::from_diagonal(DVec3::new(0.0, 0.1, 0.1));
        assert!(rod.with_distribution(DVec3::X * 0.2, gyration).is_ok());
        let beside = rod.with_distribution(DVec3::Y * 0.1, gyration);
        assert!(matches!(beside, Err(ShapeError::NoInertia { .. })), "{beside:?}");
    }
}
