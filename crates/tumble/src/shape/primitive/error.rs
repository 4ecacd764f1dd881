//! Why a built-in shape cannot be meshed.

/// The maximum number of vertices of a mesh.
pub(super) const MAX_VERTICES: f64 = 1e7;

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
        /// The upper limit (m).
        limit: f64,
        /// The limit in terms of other dimensions.
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
        /// The estimated number of vertices.
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

/// Refuses a number of vertices above the maximum. Call it before allocating.
pub(super) fn check_vertex_count(shape: &'static str, vertices: f64) -> Result<(), PrimitiveError> {
    if vertices <= MAX_VERTICES {
        Ok(())
    } else {
        Err(PrimitiveError::TooManyVertices { shape, vertices })
    }
}
