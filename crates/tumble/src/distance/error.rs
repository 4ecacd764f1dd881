//! Why a mesh has no inside.

use crate::Closedness;

/// Why no signed distance to a mesh exists.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceError {
    /// It has no triangles, or only collapsed ones.
    NoTriangles,
    /// Some edges are passed more often one way than the other: the triangles there are not wound alike.
    WronglyWound(Closedness),
    /// It has holes too large to tell inside from outside; see [`SignedDistance`](crate::SignedDistance).
    Open {
        /// The edges, with the first few.
        closedness: Closedness,
        /// Holes; those that share a vertex count as one.
        holes: usize,
        /// Length of the boundary of the largest hole (m).
        largest: f64,
        /// How long the boundary of a hole may be (m).
        largest_allowed: f64,
        /// Length of all boundaries together (m).
        total: f64,
        /// How long all boundaries together may be (m).
        total_allowed: f64,
    },
    /// It is flat: the volume inside is zero to rounding.
    NoVolume,
    /// It is smaller than 1e-60 m or larger than 1e60 m.
    OutOfRange {
        /// The longest edge of its bounding box (m).
        size: f64,
    },
}

impl std::fmt::Display for SurfaceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoTriangles => write!(
                f,
                "the mesh has no triangles, so it has no surface that others could meet; give it triangles, or let it be met as spheres"
            ),
            Self::WronglyWound(closedness) => write!(
                f,
                "{closedness}; wind all triangles counter-clockwise seen from outside, or let the body be met as spheres"
            ),
            Self::Open { closedness, holes, largest, largest_allowed, total, total_allowed } => {
                write!(
                    f,
                    "{closedness}; the boundary of the largest of {holes} hole(s) is {largest:.4} m long and all together {total:.4} m, \
                     where {largest_allowed:.4} m and {total_allowed:.4} m are allowed; close the mesh, or let the body be met as spheres"
                )
            }
            Self::NoVolume => write!(
                f,
                "the mesh encloses no volume, so it has no inside; give it thickness, or let it be met as spheres"
            ),
            Self::OutOfRange { size } => write!(
                f,
                "the mesh is {size:e} m large, and distances are only told for sizes from 1e-60 m to 1e60 m; check its units"
            ),
        }
    }
}

impl std::error::Error for SurfaceError {}
