//! Mass integrals of a triangle mesh, as a solid or as a shell.
//!
//! Linear and quadratic functions over a simplex with corners aᵢ and possibly the origin have exact
//! integrals in terms of the corners: with s = Σ aᵢ,
//!
//! - tetrahedron (0, a, b, c), d = a·(b × c): ∫ dV = d/6, ∫ r dV = d s/24,
//!   ∫ r rᵀ dV = d (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/120
//! - triangle (a, b, c) of area A, wherever it lies: ∫ r dA = A s/3,
//!   ∫ r rᵀ dA = A (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/12
//!
//! For a closed mesh, the integrals over the solid are sums over the tetrahedra from one origin to each
//! triangle, signed by d.
//! Source: J. Blow and A. J. Binstock, "How to find the inertia tensor (or other mass properties) of a 3D
//! solid body represented by a triangle mesh" (2004); F. Tonon, "Explicit exact formulas for the 3-D
//! tetrahedron inertia tensor in terms of its vertex coordinates", J. Math. Stat. 1 (2005) 8.

use glam::{DMat3, DVec3};

use super::mass::is_possible_second_moment;
use super::mesh::Mesh;
use super::watertight::Watertightness;

/// Triangles per partial sum; partial sums reduce rounding on large meshes.
const CHUNK: usize = 1024;

/// An area or volume below this fraction of the bound from the mesh's size is zero up to rounding.
pub(super) const NEGLIGIBLE: f64 = 1e-14;

/// Mesh sizes (m) whose fifth power is in the range of doubles.
pub(super) const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Measure, centre and second moment of a solid or shell of uniform density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrals {
    /// Volume of a solid (m³) or area of a shell (m²).
    pub measure: f64,
    /// Centre of mass (m), in mesh coordinates.
    pub centre: DVec3,
    /// ∫ r rᵀ about the centre, per unit density: m⁵ for a solid, m⁴ for a shell.
    pub second_moment: DMat3,
}

impl Integrals {
    /// The inertia tensor about the centre per unit density, tr(C) 1 − C with C the second moment:
    /// m⁵ for a solid, m⁴ for a shell.
    pub fn inertia(&self) -> DMat3 {
        let c = self.second_moment;
        DMat3::from_diagonal(DVec3::splat(c.x_axis.x + c.y_axis.y + c.z_axis.z)) - c
    }
}

/// Why a mesh does not bound a solid.
#[derive(Clone, Debug, PartialEq)]
pub enum SolidError {
    /// The mesh has no triangles, or only degenerate ones.
    NoTriangles,
    /// Some edges are open or wrongly wound.
    Edges(Watertightness),
    /// The mesh is closed but flat: the enclosed volume is zero up to rounding.
    NoVolume,
    /// The mass properties are those of no body, because parts of the mesh enclose a negative volume.
    Impossible {
        /// The signed volume (m³).
        volume: f64,
        /// The centre of mass that follows from it (m).
        centre: DVec3,
    },
    /// The mesh is smaller than 1e-60 m or larger than 1e60 m, beyond the range of doubles.
    OutOfRange {
        /// The longest edge of its bounding box (m).
        size: f64,
    },
}

impl std::fmt::Display for SolidError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoTriangles => write!(f, "the mesh has no triangles, so it bounds no solid"),
            Self::Edges(watertightness) => watertightness.fmt(f),
            Self::NoVolume => write!(f, "the mesh is closed but encloses no volume"),
            Self::Impossible { volume, centre } => write!(
                f,
                "the mesh bounds no possible solid: a volume of {volume:.4e} m³ with its centre at ({:.4}, {:.4}, {:.4}); \
                 parts of its surface are wound inwards or cross themselves",
                centre.x, centre.y, centre.z
            ),
            Self::OutOfRange { size } => out_of_range(f, *size),
        }
    }
}

impl std::error::Error for SolidError {}

/// Why a mesh has no surface to integrate over.
#[derive(Clone, Debug, PartialEq)]
pub enum ShellError {
    /// The mesh has no triangles.
    NoTriangles,
    /// The area of the triangles is zero up to rounding.
    NoArea,
    /// The mesh is smaller than 1e-60 m or larger than 1e60 m, beyond the range of doubles.
    OutOfRange {
        /// The longest edge of its bounding box (m).
        size: f64,
    },
}

impl std::fmt::Display for ShellError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoTriangles => write!(f, "the mesh has no triangles, so it has no surface"),
            Self::NoArea => write!(f, "the triangles of the mesh have no area"),
            Self::OutOfRange { size } => out_of_range(f, *size),
        }
    }
}

impl std::error::Error for ShellError {}

/// Writes the message of the `OutOfRange` errors.
pub(super) fn out_of_range(f: &mut std::fmt::Formatter<'_>, size: f64) -> std::fmt::Result {
    write!(
        f,
        "the mesh is {size:e} m large, and only sizes from 1e-60 m to 1e60 m can be integrated"
    )
}

/// The bounding box of the triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

impl Bounds {
    /// The centre (m), computed without overflow.
    pub fn centre(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The longest edge (m).
    pub fn size(&self) -> f64 {
        (self.max - self.min).max_element()
    }
}

/// Zeroth, first and second moment, without the constant factors of the simplex.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    measure: f64,
    /// Sum of the unsigned areas, to compare a volume with.
    area: f64,
    first: DVec3,
    second: [DVec3; 3],
}

impl Moments {
    /// Adds the simplex with corners a, b, c (and the origin, for a solid) and this measure.
    fn add_simplex(&mut self, [a, b, c]: [DVec3; 3], measure: f64, area: f64) {
        let sum = a + b + c;
        self.measure += measure;
        self.area += area;
        self.first += measure * sum;
        for axis in 0..3 {
            self.second[axis] +=
                measure * (a[axis] * a + b[axis] * b + c[axis] * c + sum[axis] * sum);
        }
    }

    fn add(&mut self, other: &Self) {
        self.measure += other.measure;
        self.area += other.area;
        self.first += other.first;
        for axis in 0..3 {
            self.second[axis] += other.second[axis];
        }
    }

    fn second_moment(&self, factor: f64) -> DMat3 {
        let [x, y, z] = self.second;
        let (xy, xz, yz) = (0.5 * (x.y + y.x), 0.5 * (x.z + z.x), 0.5 * (y.z + z.y));
        // exactly symmetric
        let columns = [DVec3::new(x.x, xy, xz), DVec3::new(xy, y.y, yz), DVec3::new(xz, yz, z.z)];
        DMat3::from_cols(factor * columns[0], factor * columns[1], factor * columns[2])
    }
}

impl Mesh {
    /// The bounding box of the triangles; `None` if there are none with finite corners.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        let mut corners = self.triangles.iter().filter_map(|&t| self.corners(t)).flatten();
        let first = corners.next()?;
        let mut bounds = Bounds { min: first, max: first };
        for corner in corners {
            bounds.min = bounds.min.min(corner);
            bounds.max = bounds.max.max(corner);
        }
        Some(bounds)
    }

    /// Sums the moments of all triangles about `origin`; `measures` returns a triangle's measure and area.
    fn moments(&self, origin: DVec3, measures: impl Fn([DVec3; 3]) -> (f64, f64)) -> Moments {
        let mut total = Moments::default();
        for chunk in self.triangles.chunks(CHUNK) {
            let mut part = Moments::default();
            for corners in chunk.iter().filter_map(|&t| self.corners(t)) {
                let corners = corners.map(|v| v - origin);
                let (measure, area) = measures(corners);
                part.add_simplex(corners, measure, area);
            }
            total.add(&part);
        }
        total
    }

    /// Volume (m³), centre (m) and second moment (m⁵) of the solid bounded by the mesh, exact up to rounding.
    ///
    /// The mesh may be wound inwards; the volume is positive in any case. Cavities are subtracted if their
    /// surface is wound opposite to the outer one. Overlapping parts count twice. The sums are taken about
    /// the centre of the bounding box and then about the centre of mass, so the relative error for a mesh of
    /// size a at a distance d from the origin is that of its coordinates, about 2⁻⁵³ d/a.
    ///
    /// # Errors
    /// [`SolidError`] if the mesh has no triangles, open or wrongly wound edges, no volume, parts with a negative
    /// volume that make the result impossible, or a size beyond the range of doubles.
    pub fn solid_integrals(&self) -> Result<Integrals, SolidError> {
        let bounds = self.bounds().ok_or(SolidError::NoTriangles)?;
        let watertightness = self.watertightness();
        if watertightness.triangles == 0 {
            return Err(SolidError::NoTriangles);
        }
        if !watertightness.is_closed() {
            return Err(SolidError::Edges(watertightness));
        }
        let size = bounds.size();
        if !SIZES.contains(&size) {
            return Err(SolidError::OutOfRange { size });
        }

        // volume and centre first, since the second moment is taken about the centre
        let measures = |[a, b, c]: [DVec3; 3]| (a.dot(b.cross(c)), double_area([a, b, c]));
        let origin = bounds.centre();
        let about_box = self.moments(origin, measures);
        if about_box.measure.abs() <= NEGLIGIBLE * size * about_box.area {
            return Err(SolidError::NoVolume);
        }
        let centre = origin + about_box.first / (4.0 * about_box.measure);

        // all moments of a mesh wound inwards change sign
        let about_centre = self.moments(centre, measures);
        let sign = about_box.measure.signum();
        let measure = sign * about_centre.measure / 6.0;
        let second_moment = about_centre.second_moment(sign / 120.0);
        let is_outside = (centre - origin).abs().cmpgt(0.5 * (bounds.max - bounds.min)).any();
        if is_outside || !is_possible_second_moment(second_moment) {
            return Err(SolidError::Impossible { volume: measure, centre });
        }
        Ok(Integrals { measure, centre, second_moment })
    }

    /// Area (m²), centre (m) and second moment (m⁴) of the mesh's surface, exact up to rounding.
    ///
    /// The mesh need not be closed, and its winding does not matter. Duplicate triangles count twice.
    ///
    /// # Errors
    /// [`ShellError`] if the mesh has no triangles, no area, or a size beyond the range of doubles.
    pub fn shell_integrals(&self) -> Result<Integrals, ShellError> {
        let bounds = self.bounds().ok_or(ShellError::NoTriangles)?;
        let size = bounds.size();
        // a size of zero is reported as no area
        if size > 0.0 && !SIZES.contains(&size) {
            return Err(ShellError::OutOfRange { size });
        }

        let measures = |corners: [DVec3; 3]| (double_area(corners), 0.0);
        let origin = bounds.centre();
        let about_box = self.moments(origin, measures);
        if about_box.measure <= NEGLIGIBLE * size * size {
            return Err(ShellError::NoArea);
        }
        let centre = origin + about_box.first / (3.0 * about_box.measure);
        let about_centre = self.moments(centre, measures);
        Ok(Integrals {
            measure: 0.5 * about_centre.measure,
            centre,
            second_moment: about_centre.second_moment(1.0 / 24.0),
        })
    }
}

/// Twice the area of a triangle.
fn double_area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length()
}

#[cfg(test)]
mod tests;
