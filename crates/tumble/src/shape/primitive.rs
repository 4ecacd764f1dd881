//! Built-in shapes, meshed with evenly spread vertices that can serve as particles.

mod definition;
mod error;
mod geodesic;
mod knot;
mod limits;
mod patches;
mod revolution;

use super::mesh::Mesh;

pub use self::definition::Primitive;
pub use self::error::PrimitiveError;

impl Primitive {
    /// Meshes the shape.
    ///
    /// # Errors
    /// [`PrimitiveError`] where a dimension is not positive and finite, two do not fit together, or the
    /// resolution is too low for a closed surface or asks for more than ten million vertices.
    pub fn mesh(&self) -> Result<Mesh, PrimitiveError> {
        self.check()?;
        match *self {
            Self::Sphere { radius, subdivisions } => Ok(geodesic::sphere(radius, subdivisions)),
            Self::Box { size, divisions } => patches::cuboid(size, divisions),
            Self::Cylinder { radius, height, segments } => {
                revolution::cylinder(radius, height, segments)
            }
            Self::Capsule { radius, height, segments } => {
                revolution::capsule(radius, height, segments)
            }
            Self::Torus { radius, tube_radius, segments } => {
                revolution::torus(radius, tube_radius, segments)
            }
            Self::Tube { radius, bottom_radius, height, thickness, segments } => {
                revolution::tube([bottom_radius, radius], height, thickness, segments)
            }
            Self::Dumbbell { radius, length, bar_radius, segments } => {
                revolution::dumbbell(radius, length, bar_radius, segments)
            }
            Self::THandle { length, width, thickness, divisions } => {
                patches::t_handle(length, width, thickness, divisions)
            }
            Self::Tetrahedron { size } => Ok(geodesic::tetrahedron(size)),
            Self::Knot { radius, tube_radius, segments } => {
                knot::trefoil(radius, tube_radius, segments)
            }
        }
    }
}

#[cfg(test)]
mod tests;
