//! Which dimensions and resolutions a built-in shape accepts.

use super::Primitive;

/// The most vertices that a shape may have.
pub(super) const MAX_VERTICES: f64 = 1e7;

/// Dimensions (m) whose squares and products stay within the range of doubles.
const DIMENSIONS: std::ops::RangeInclusive<f64> = 1e-100..=1e100;

/// Dimensions further apart than this would make neighbouring vertices round to one.
const MAX_PROPORTION: f64 = 1e9;

/// By how much, relatively, a dimension must keep from its limit, so that no two vertices round to one.
const MARGIN: f64 = 1e-6;

/// Why a built-in shape cannot be meshed.
#[derive(Clone, Debug, PartialEq)]
pub enum PrimitiveError {
    /// A dimension is not a number from 1e-100 m to 1e100 m.
    Dimension {
        /// Name of the shape.
        shape: &'static str,
        /// Name of the dimension.
        key: &'static str,
        /// Its value (m).
        value: f64,
    },
    /// A dimension is too large for another.
    TooLarge {
        /// Name of the shape.
        shape: &'static str,
        /// Name of the dimension.
        key: &'static str,
        /// Its value (m).
        value: f64,
        /// What it must be less than (m).
        limit: f64,
        /// What this limit is, in terms of other dimensions.
        limit_is: &'static str,
    },
    /// The largest dimension is more than 1e9 times the smallest.
    Proportion {
        /// Name of the shape.
        shape: &'static str,
        /// The smallest dimension (m).
        smallest: f64,
        /// The largest dimension (m).
        largest: f64,
    },
    /// The resolution is too low for a closed surface.
    TooCoarse {
        /// Name of the shape.
        shape: &'static str,
        /// Name of the resolution.
        key: &'static str,
        /// Its value.
        value: u32,
        /// The least value allowed.
        least: u32,
    },
    /// The mesh would have more than ten million vertices.
    TooManyVertices {
        /// Name of the shape.
        shape: &'static str,
        /// About how many it would have.
        vertices: f64,
    },
}

impl std::fmt::Display for PrimitiveError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Dimension { shape, key, value } => write!(
                f,
                "{key} of the {shape} is {value} m, but must be positive and finite (1e-100 m to 1e100 m)"
            ),
            Self::TooLarge { shape, key, value, limit, limit_is } => {
                write!(
                    f,
                    "{key} of the {shape} is {value} m, but must be less than {limit_is} ({limit} m)"
                )
            }
            Self::Proportion { shape, smallest, largest } => write!(
                f,
                "the {shape} has dimensions from {smallest} m to {largest} m; one may be at most 1e9 times another"
            ),
            Self::TooCoarse { shape, key, value, least } => {
                write!(f, "{key} of the {shape} is {value}, but must be at least {least}")
            }
            Self::TooManyVertices { shape, vertices } => write!(
                f,
                "the {shape} would have about {vertices:.2e} vertices, more than {MAX_VERTICES:.0e}; lower its resolution"
            ),
        }
    }
}

impl std::error::Error for PrimitiveError {}

/// Passes if a mesh of so many vertices may be built; ask before allocating.
pub(super) fn affordable(shape: &'static str, vertices: f64) -> Result<(), PrimitiveError> {
    if vertices <= MAX_VERTICES {
        Ok(())
    } else {
        Err(PrimitiveError::TooManyVertices { shape, vertices })
    }
}

impl Primitive {
    /// Checks dimensions and resolution, as far as that needs no mesh.
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
            affordable(shape, 10.0 * libm::pow(4.0, f64::from(subdivisions)) + 2.0)?;
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

    /// What must be less than what: name and value, limit and what it is.
    fn limits(&self) -> Vec<(&'static str, f64, f64, &'static str)> {
        match *self {
            Self::Torus { radius, tube_radius, .. } => {
                vec![("tube_radius", tube_radius, radius, "radius")]
            }
            Self::Knot { radius, tube_radius, .. } => {
                let limit = super::knot::MAX_TUBE * radius;
                vec![("tube_radius", tube_radius, limit, "0.41 radius, where it touches itself")]
            }
            Self::Dumbbell { radius, length, bar_radius, .. } => vec![
                ("bar_radius", bar_radius, radius, "radius"),
                (
                    "radius",
                    radius,
                    0.5 * libm::hypot(length, 2.0 * bar_radius),
                    "what lets the bar show between the balls",
                ),
            ],
            Self::THandle { length, width, thickness, .. } => vec![
                ("thickness", thickness, length, "length"),
                ("thickness", thickness, width, "width"),
            ],
            _ => Vec::new(),
        }
    }

    /// Name, value and least value of the resolution.
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
