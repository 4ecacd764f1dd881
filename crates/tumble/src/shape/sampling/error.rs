//! Why a mesh cannot be sampled.

use crate::shape::integrals::{SolidError, out_of_range};

/// The maximum number of points.
const MAX_POINTS: f64 = 2e7;

/// Why a mesh cannot be sampled.
#[derive(Clone, Debug, PartialEq)]
pub enum SampleError {
    /// The spacing is not positive and finite.
    Spacing {
        /// The spacing (m).
        spacing: f64,
    },
    /// The mesh has no triangles with an area.
    NoSurface,
    /// The mesh is not closed, so it has no inside.
    Open(SolidError),
    /// The mesh is smaller than 1e-60 m or larger than 1e60 m, beyond the range of doubles.
    OutOfRange {
        /// The longest edge of its bounding box (m).
        size: f64,
    },
    /// More than 20 million points would result.
    TooMany {
        /// The spacing (m).
        spacing: f64,
        /// The estimated number of points.
        points: f64,
        /// A spacing (m) that gives fewer than 20 million points.
        would_do: f64,
    },
    /// No lattice point falls inside the mesh.
    NoPoints {
        /// The spacing (m).
        spacing: f64,
        /// A spacing (m) that gives at least one point, if repeated halving finds one.
        would_do: Option<f64>,
    },
}

impl std::fmt::Display for SampleError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Spacing { spacing } => {
                write!(f, "the spacing is {spacing} m, but must be positive and finite")
            }
            Self::NoSurface => write!(f, "the mesh has no triangles with an area to put points on"),
            Self::OutOfRange { size } => out_of_range(f, *size),
            Self::Open(why) => write!(f, "only a closed mesh has an inside to fill: {why}"),
            Self::TooMany { spacing, points, would_do } => write!(
                f,
                "a spacing of {spacing} m would make about {points:.1e} points, more than {MAX_POINTS:.0e}; {would_do:.3e} m would do"
            ),
            Self::NoPoints { spacing, would_do } => {
                write!(f, "at a spacing of {spacing} m no point falls inside the mesh")?;
                match would_do {
                    Some(would_do) => write!(f, "; {would_do} m would do"),
                    None => Ok(()),
                }
            }
        }
    }
}

impl std::error::Error for SampleError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Open(why) => Some(why),
            _ => None,
        }
    }
}

/// Refuses a number of points, estimated or actual, above the maximum.
///
/// The number is proportional to `spacing` to the power of −`dimension`; `size` is the size of the mesh (m).
pub(super) fn check_point_count(
    spacing: f64,
    points: f64,
    dimension: f64,
    size: f64,
) -> Result<(), SampleError> {
    if points <= MAX_POINTS {
        return Ok(());
    }
    if !points.is_finite() {
        // on overflow only the size allows a suggestion
        return Err(SampleError::TooMany { spacing, points: f64::INFINITY, would_do: 0.01 * size });
    }
    // with a margin, since the number is an estimate
    let would_do = spacing * 1.01 * libm::pow(points / MAX_POINTS, 1.0 / dimension);
    Err(SampleError::TooMany { spacing, points, would_do })
}
