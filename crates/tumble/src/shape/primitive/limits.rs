//! The dimensions and resolutions that built-in shapes accept.

use super::definition::Primitive;
use super::error::{PrimitiveError, check_vertex_count};
use super::knot::MAX_TUBE;

/// Dimensions (m) whose squares and products stay within the range of doubles.
const DIMENSIONS: std::ops::RangeInclusive<f64> = 1e-100..=1e100;

/// The largest ratio of two dimensions at which neighbouring vertices stay distinct.
const MAX_PROPORTION: f64 = 1e9;

/// The relative margin between a dimension and its limit at which vertices stay distinct.
const MARGIN: f64 = 1e-6;

impl Primitive {
    /// Checks dimensions and resolution, as far as possible without a mesh.
    pub(super) fn check(&self) -> Result<(), PrimitiveError> {
        let shape = self.name();
        self.check_dimensions()?;
        for (key, value, limit, limit_is) in self.limits() {
            if value >= limit * (1.0 - MARGIN) {
                return Err(PrimitiveError::TooLarge { shape, key, value, limit, limit_is });
            }
        }
        let (key, value, least) = self.resolution();
        if value < least {
            return Err(PrimitiveError::TooCoarse { shape, key, value, least });
        }
        if let Self::Sphere { subdivisions, .. } = *self {
            check_vertex_count(shape, 10.0 * libm::pow(4.0, f64::from(subdivisions)) + 2.0)?;
        }
        Ok(())
    }

    fn check_dimensions(&self) -> Result<(), PrimitiveError> {
        let shape = self.name();
        let dimensions = self.dimensions();
        let (mut smallest, mut largest) = (f64::INFINITY, 0.0f64);
        for (key, value) in dimensions {
            if !DIMENSIONS.contains(&value) {
                return Err(PrimitiveError::Dimension { shape, key, value });
            }
            (smallest, largest) = (smallest.min(value), largest.max(value));
        }
        if largest > MAX_PROPORTION * smallest {
            return Err(PrimitiveError::Proportion { shape, smallest, largest });
        }
        Ok(())
    }

    fn dimensions(&self) -> Vec<(&'static str, f64)> {
        match *self {
            Self::Sphere { radius, .. } => vec![("radius", radius)],
            Self::Box { size, .. } => {
                vec![("size[0]", size.x), ("size[1]", size.y), ("size[2]", size.z)]
            }
            Self::Cylinder { radius, height, .. } | Self::Capsule { radius, height, .. } => {
                vec![("radius", radius), ("height", height)]
            }
            Self::Torus { radius, tube_radius, .. } | Self::Knot { radius, tube_radius, .. } => {
                vec![("radius", radius), ("tube_radius", tube_radius)]
            }
            Self::Tube { radius, bottom_radius, height, thickness, .. } => vec![
                ("radius", radius),
                ("bottom_radius", bottom_radius),
                ("height", height),
                ("thickness", thickness),
            ],
            Self::Dumbbell { radius, length, bar_radius, .. } => {
                vec![("radius", radius), ("length", length), ("bar_radius", bar_radius)]
            }
            Self::THandle { length, width, thickness, .. } => {
                vec![("length", length), ("width", width), ("thickness", thickness)]
            }
            Self::Tetrahedron { size } => vec![("size", size)],
        }
    }

    /// Upper limits of dimensions: name, value, limit, and the limit in words.
    fn limits(&self) -> Vec<(&'static str, f64, f64, &'static str)> {
        match *self {
            Self::Torus { radius, tube_radius, .. } => {
                vec![("tube_radius", tube_radius, radius, "radius")]
            }
            Self::Knot { radius, tube_radius, .. } => {
                let limit = MAX_TUBE * radius;
                vec![("tube_radius", tube_radius, limit, "0.41 radius, where it touches itself")]
            }
            Self::Dumbbell { radius, length, bar_radius, .. } => vec![
                ("bar_radius", bar_radius, radius, "radius"),
                (
                    "radius",
                    radius,
                    0.5 * libm::hypot(length, 2.0 * bar_radius),
                    "what lets the bar show between the spheres",
                ),
            ],
            Self::THandle { length, width, thickness, .. } => vec![
                ("thickness", thickness, length, "length"),
                ("thickness", thickness, width, "width"),
            ],
            _ => Vec::new(),
        }
    }

    /// Name, value and minimum of the resolution.
    fn resolution(&self) -> (&'static str, u32, u32) {
        match *self {
            Self::Sphere { subdivisions, .. } => ("subdivisions", subdivisions, 0),
            Self::Box { divisions, .. } | Self::THandle { divisions, .. } => {
                ("divisions", divisions, 1)
            }
            Self::Cylinder { segments, .. }
            | Self::Capsule { segments, .. }
            | Self::Torus { segments, .. }
            | Self::Tube { segments, .. }
            | Self::Dumbbell { segments, .. }
            | Self::Knot { segments, .. } => ("segments", segments, 3),
            Self::Tetrahedron { .. } => ("size", 1, 1),
        }
    }
}
