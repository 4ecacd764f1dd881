//! Why a mesh has no signed distance.

use crate::Watertightness;

/// Why the signed distance to a mesh is not defined.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceError {
    /// The mesh has no triangles, or only degenerate ones.
    NoTriangles,
    /// The triangles at some edges are wound inconsistently.
    WronglyWound(Watertightness),
    /// The holes are too large to distinguish inside and outside; see [`SignedDistance`](crate::SignedDistance).
    Open {
        /// The faulty edges.
        watertightness: Watertightness,
        /// The number of holes; holes that share a vertex count as one.
        holes: usize,
        /// Length of the longest boundary of a hole (m).
        largest: f64,
        /// The longest allowed boundary of a hole (m).
        largest_allowed: f64,
        /// Length of all boundaries together (m).
        total: f64,
        /// The longest allowed length of all boundaries together (m).
        total_allowed: f64,
    },
    /// The mesh is flat: the enclosed volume is zero up to rounding.
    NoVolume,
    /// The mesh is smaller than 1e-60 m or larger than 1e60 m.
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
                "the mesh has no triangles, so other bodies cannot collide with it; give it triangles, or use `surface = \"spheres\"`"
            ),
            Self::WronglyWound(watertightness) => write!(
                f,
                "{watertightness}; wind all triangles counter-clockwise seen from outside, or use `surface = \"spheres\"`"
            ),
            Self::Open {
                watertightness,
                holes,
                largest,
                largest_allowed,
                total,
                total_allowed,
            } => {
                write!(
                    f,
                    "{watertightness}; the boundary of the largest of {holes} hole(s) is {largest:.4} m long and all together {total:.4} m, \
                     where {largest_allowed:.4} m and {total_allowed:.4} m are allowed; close the mesh, or use `surface = \"spheres\"`"
                )
            }
            Self::NoVolume => write!(
                f,
                "the mesh encloses no volume, so it has no inside; give it thickness, or use `surface = \"spheres\"`"
            ),
            Self::OutOfRange { size } => write!(
                f,
                "the mesh is {size:e} m large, and only sizes from 1e-60 m to 1e60 m are supported; check its units"
            ),
        }
    }
}

impl std::error::Error for SurfaceError {}
