//! Built-in shapes, meshed so that their vertices are spread evenly and serve as particles.

mod check;
mod geodesic;
mod knot;
mod patches;
mod revolution;

use super::Mesh;
use glam::DVec3;

pub use check::PrimitiveError;

/// A shape that can be meshed without a file.
///
/// Each mesh is closed, wound counter-clockwise seen from outside, has no vertex twice, and its solid has its
/// centre of mass at the origin, to rounding. [`Primitive::named`] gives the defaults, each about 0.3 m large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// A geodesic sphere: an icosahedron, each of its edges halved `subdivisions` times.
    Sphere {
        /// Radius (m).
        radius: f64,
        /// Halvings n of each edge, at most 9: 10·4ⁿ + 2 vertices.
        subdivisions: u32,
    },
    /// A box with edges along the axes.
    Box {
        /// Edge lengths (m).
        size: DVec3,
        /// Parts n of each edge, at least 1: 6n² + 2 vertices.
        divisions: u32,
    },
    /// A cylinder around the y axis, with flat ends.
    Cylinder {
        /// Radius (m).
        radius: f64,
        /// Length along y (m).
        height: f64,
        /// Vertices around it, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// A cylinder around the y axis with a half ball at each end.
    Capsule {
        /// Radius of the cylinder and of the half balls (m).
        radius: f64,
        /// Length of the cylindrical part along y (m); the whole is `height + 2 radius` long.
        height: f64,
        /// Vertices around it, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// A ring around the y axis.
    Torus {
        /// Radius of the circle at the tube's heart (m).
        radius: f64,
        /// Radius of the tube (m), less than `radius`.
        tube_radius: f64,
        /// Vertices around the outermost circle, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// An open tube or funnel around the y axis, with a wall that things can be in.
    Tube {
        /// Inner radius at the upper end (m).
        radius: f64,
        /// Inner radius at the lower end (m).
        bottom_radius: f64,
        /// Length along y (m).
        height: f64,
        /// Thickness of the wall, measured outwards from the axis (m).
        thickness: f64,
        /// Vertices around it, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// Two balls on a bar along the x axis, in one closed surface.
    Dumbbell {
        /// Radius of each ball (m).
        radius: f64,
        /// Distance between the centres of the balls (m), so long that a bar remains between them.
        length: f64,
        /// Radius of the bar (m), less than `radius`.
        bar_radius: f64,
        /// Vertices around a ball, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// A T of square section: the bar along x on top, the handle along y below its middle.
    ///
    /// The origin is the centre of mass of the solid, not of the bar. With the default proportions all three
    /// principal moments differ and the middle one is about x, the bar's own axis.
    THandle {
        /// Length of the bar along x (m), more than `thickness`.
        length: f64,
        /// Extent along y (m): the bar's thickness and the handle below it; more than `thickness`.
        width: f64,
        /// Edge of the square section of bar and handle (m).
        thickness: f64,
        /// Parts of an edge of the section, at least 1; sets the spacing everywhere.
        divisions: u32,
    },
    /// A regular tetrahedron: 4 vertices.
    Tetrahedron {
        /// Edge length (m).
        size: f64,
    },
    /// A tube along a trefoil knot that winds around the y axis.
    ///
    /// Its heart is ((R + a cos 3t) cos 2t, a sin 3t, (R + a cos 3t) sin 2t) with R = `radius`, a = R/2.
    Knot {
        /// Radius R of the circle that the knot winds around (m).
        radius: f64,
        /// Radius of the tube (m), less than 0.41 `radius`, at which it would touch itself.
        tube_radius: f64,
        /// Vertices around the tube, at least 3; sets the spacing along it.
        segments: u32,
    },
}

impl Primitive {
    /// The names of all shapes, as scenes and [`Primitive::named`] know them.
    pub const NAMES: [&str; 10] = [
        "sphere",
        "box",
        "cylinder",
        "capsule",
        "torus",
        "tube",
        "dumbbell",
        "t-handle",
        "tetrahedron",
        "knot",
    ];

    /// The shape of this name with its default size and resolution; `None` for a name not in [`Primitive::NAMES`].
    ///
    /// ```
    /// use tumble::Primitive;
    /// let sphere = Primitive::named("sphere").unwrap();
    /// assert_eq!(sphere, Primitive::Sphere { radius: 0.15, subdivisions: 3 });
    /// assert_eq!(sphere.mesh()?.vertices.len(), 642);
    /// # Ok::<(), tumble::PrimitiveError>(())
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "sphere" => Self::Sphere { radius: 0.15, subdivisions: 3 },
            "box" => Self::Box { size: DVec3::new(0.3, 0.2, 0.1), divisions: 1 },
            "cylinder" => Self::Cylinder { radius: 0.1, height: 0.3, segments: 36 },
            "capsule" => Self::Capsule { radius: 0.075, height: 0.15, segments: 30 },
            "torus" => Self::Torus { radius: 0.1, tube_radius: 0.04, segments: 48 },
            "tube" => Self::Tube {
                radius: 0.1,
                bottom_radius: 0.1,
                height: 0.2,
                thickness: 0.02,
                segments: 48,
            },
            "dumbbell" => {
                Self::Dumbbell { radius: 0.06, length: 0.2, bar_radius: 0.02, segments: 24 }
            }
            "t-handle" => Self::THandle { length: 0.3, width: 0.2, thickness: 0.05, divisions: 2 },
            "tetrahedron" => Self::Tetrahedron { size: 0.3 },
            "knot" => Self::Knot { radius: 0.09, tube_radius: 0.025, segments: 12 },
            _ => return None,
        })
    }

    /// The shape's name, one of [`Primitive::NAMES`].
    pub fn name(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "sphere",
            Self::Box { .. } => "box",
            Self::Cylinder { .. } => "cylinder",
            Self::Capsule { .. } => "capsule",
            Self::Torus { .. } => "torus",
            Self::Tube { .. } => "tube",
            Self::Dumbbell { .. } => "dumbbell",
            Self::THandle { .. } => "t-handle",
            Self::Tetrahedron { .. } => "tetrahedron",
            Self::Knot { .. } => "knot",
        }
    }

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
