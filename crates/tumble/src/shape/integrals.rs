//! Mass integrals of a triangle mesh: of the solid that it bounds, and of its surface as a shell.
//!
//! A simplex with a corner at the origin and the others at aᵢ integrates linear and quadratic functions
//! exactly from its corners: with s = Σ aᵢ,
//!
//! - tetrahedron (0, a, b, c), d = a·(b × c): ∫ dV = d/6, ∫ r dV = d s/24,
//!   ∫ r rᵀ dV = d (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/120
//! - triangle (a, b, c) of area A, wherever it lies: ∫ r dA = A s/3,
//!   ∫ r rᵀ dA = A (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/12
//!
//! The sum over tetrahedra from one origin to each triangle, signed by d, gives a closed mesh its solid.
//! Source: J. Blow and A. J. Binstock, "How to find the inertia tensor (or other mass properties) of a 3D
//! solid body represented by a triangle mesh" (2004); F. Tonon, "Explicit exact formulas for the 3-D
//! tetrahedron inertia tensor in terms of its vertex coordinates", J. Math. Stat. 1 (2005) 8.

use super::Mesh;
use super::closedness::Closedness;
use glam::{DMat3, DVec3};

/// Triangles whose sums are added before they join the whole: keeps rounding small on large meshes, and
/// the order fixed.
const CHUNK: usize = 1024;

/// A measure below this part of what the mesh's size allows is rounding, not substance.
pub(super) const NOTHING: f64 = 1e-14;

/// Meshes smaller or larger (m) would lose their fifth power to the range of doubles.
pub(super) const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Measure, centre and second moment of a body of uniform density.
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

/// Why a mesh bounds no solid.
#[derive(Clone, Debug, PartialEq)]
pub enum OpenMesh {
    /// It has no triangles, or only collapsed ones.
    NoTriangles,
    /// Some edges are open or wound wrongly; the report names the first.
    Edges(Closedness),
    /// It is closed, but flat: the volume inside is zero to rounding.
    NoVolume,
    /// It is smaller than 1e-60 m or larger than 1e60 m, beyond what doubles can integrate.
    OutOfRange {
        /// The longest edge of its bounding box (m).
        size: f64,
    },
}

impl std::fmt::Display for OpenMesh {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoTriangles => write!(f, "the mesh has no triangles, so it bounds no solid"),
            Self::Edges(closedness) => closedness.fmt(f),
            Self::NoVolume => write!(f, "the mesh is closed but encloses no volume"),
            Self::OutOfRange { size } => out_of_range(f, *size),
        }
    }
}

impl std::error::Error for OpenMesh {}

/// Why a mesh has no surface to integrate over.
#[derive(Clone, Debug, PartialEq)]
pub enum ShellError {
    /// It has no triangles.
    NoTriangles,
    /// Its triangles have no area beyond rounding.
    NoArea,
    /// It is smaller than 1e-60 m or larger than 1e60 m, beyond what doubles can integrate.
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

pub(super) fn out_of_range(f: &mut std::fmt::Formatter<'_>, size: f64) -> std::fmt::Result {
    write!(
        f,
        "the mesh is {size:e} m large, and only sizes from 1e-60 m to 1e60 m can be integrated"
    )
}

/// The box around all triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

impl Bounds {
    /// The middle (m); halved first, so that no finite box overflows.
    pub fn centre(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The longest edge (m).
    pub fn size(&self) -> f64 {
        (self.max - self.min).max_element()
    }
}

/// Zeroth, first and second moment, not yet divided by the simplex's constants.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    measure: f64,
    /// Sum of the unsigned areas, to judge a volume by.
    area: f64,
    first: DVec3,
    second: [DVec3; 3],
}

impl Moments {
    /// Adds the simplex with corners a, b, c (and the origin, for a solid) of weight `measure`.
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
        // symmetric to the last bit, whatever the sums rounded to
        let columns = [DVec3::new(x.x, xy, xz), DVec3::new(xy, y.y, yz), DVec3::new(xz, yz, z.z)];
        DMat3::from_cols(factor * columns[0], factor * columns[1], factor * columns[2])
    }
}

impl Mesh {
    /// The box around the triangles; `None` if there are none with finite corners.
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

    /// Sums the moments of all triangles about `origin`; `weigh` gives a triangle's measure and area.
    fn moments(&self, origin: DVec3, weigh: impl Fn([DVec3; 3]) -> (f64, f64)) -> Moments {
        let mut total = Moments::default();
        for chunk in self.triangles.chunks(CHUNK) {
            let mut part = Moments::default();
            for corners in chunk.iter().filter_map(|&t| self.corners(t)) {
                let corners = corners.map(|v| v - origin);
                let (measure, area) = weigh(corners);
                part.add_simplex(corners, measure, area);
            }
            total.add(&part);
        }
        total
    }

    /// Volume (m³), centre (m) and second moment (m⁵) of the solid that the mesh bounds, exact but for rounding.
    ///
    /// The mesh may be wound inwards; the volume is positive all the same. Cavities count as such where their
    /// surface is wound against the outer one. Parts that overlap count twice. Sums run about the bounding
    /// box's centre and then about the centre of mass, so that a mesh far from the origin loses no more than
    /// its coordinates have lost already: a size a and a distance d cost a relative error of about 2⁻⁵³ d/a.
    ///
    /// # Errors
    /// [`OpenMesh`] where the mesh has no triangles, open or wrongly wound edges, no volume, or a size
    /// beyond the range of doubles.
    pub fn solid_integrals(&self) -> Result<Integrals, OpenMesh> {
        let bounds = self.bounds().ok_or(OpenMesh::NoTriangles)?;
        let closedness = self.closedness();
        if closedness.triangles == 0 {
            return Err(OpenMesh::NoTriangles);
        }
        if !closedness.is_closed() {
            return Err(OpenMesh::Edges(closedness));
        }
        let size = bounds.size();
        if !SIZES.contains(&size) {
            return Err(OpenMesh::OutOfRange { size });
        }

        // volume and centre first: they tell the best origin for the second moment
        let weigh = |[a, b, c]: [DVec3; 3]| (a.dot(b.cross(c)), double_area([a, b, c]));
        let origin = bounds.centre();
        let about_box = self.moments(origin, weigh);
        if about_box.measure.abs() <= NOTHING * size * about_box.area {
            return Err(OpenMesh::NoVolume);
        }
        let centre = origin + about_box.first / (4.0 * about_box.measure);

        // the sign that makes the volume positive turns all moments of an inward mesh
        let about_centre = self.moments(centre, weigh);
        let sign = about_box.measure.signum();
        Ok(Integrals {
            measure: sign * about_centre.measure / 6.0,
            centre,
            second_moment: about_centre.second_moment(sign / 120.0),
        })
    }

    /// Area (m²), centre (m) and second moment (m⁴) of the mesh's surface, exact but for rounding.
    ///
    /// The mesh need not be closed, and its winding does not matter. A triangle that is there twice counts twice.
    ///
    /// # Errors
    /// [`ShellError`] where the mesh has no triangles, no area, or a size beyond the range of doubles.
    pub fn shell_integrals(&self) -> Result<Integrals, ShellError> {
        let bounds = self.bounds().ok_or(ShellError::NoTriangles)?;
        let size = bounds.size();
        // a size of zero is a lack of area, not of range
        if size > 0.0 && !SIZES.contains(&size) {
            return Err(ShellError::OutOfRange { size });
        }

        let weigh = |corners: [DVec3; 3]| (double_area(corners), 0.0);
        let origin = bounds.centre();
        let about_box = self.moments(origin, weigh);
        if about_box.measure <= NOTHING * size * size {
            return Err(ShellError::NoArea);
        }
        let centre = origin + about_box.first / (3.0 * about_box.measure);
        let about_centre = self.moments(centre, weigh);
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
