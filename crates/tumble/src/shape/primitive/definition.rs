//! The built-in shapes and their parameters.

use glam::DVec3;

/// A built-in shape.
///
/// Each mesh is closed, wound counter-clockwise seen from outside, and has no duplicate vertices. The centre of
/// mass of its solid is at the origin, up to rounding. [`Primitive::from_name`] gives the defaults, about 0.3 m large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// A geodesic sphere: an icosahedron whose edges are halved `subdivisions` times.
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
    /// A cylinder around the y axis with a hemisphere at each end.
    Capsule {
        /// Radius of the cylinder and of the hemispheres (m).
        radius: f64,
        /// Length of the cylindrical part along y (m); the total length is `height + 2 radius`.
        height: f64,
        /// Vertices around it, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// A torus around the y axis.
    Torus {
        /// Radius of the centre line of the tube (m).
        radius: f64,
        /// Radius of the tube (m), less than `radius`.
        tube_radius: f64,
        /// Vertices around the outermost circle, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// An open tube or funnel around the y axis, with a wall of finite thickness.
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
    /// Two spheres joined by a bar along the x axis, as one closed surface.
    Dumbbell {
        /// Radius of each sphere (m).
        radius: f64,
        /// Distance between the centres of the spheres (m), large enough for the bar to show between them.
        length: f64,
        /// Radius of the bar (m), less than `radius`.
        bar_radius: f64,
        /// Vertices around a sphere, rounded to a multiple of six, at least 3; sets the spacing everywhere.
        segments: u32,
    },
    /// A T of square cross-section: a bar along x on top, and a handle along y below its middle.
    ///
    /// The origin is the centre of mass of the whole solid. With the default proportions all three principal
    /// moments differ.
    THandle {
        /// Length of the bar along x (m), more than `thickness`.
        length: f64,
        /// Extent along y (m): the bar's thickness and the handle below it; more than `thickness`.
        width: f64,
        /// Edge of the square cross-section of bar and handle (m).
        thickness: f64,
        /// Parts of an edge of the cross-section, at least 1; sets the spacing everywhere.
        divisions: u32,
    },
    /// A regular tetrahedron: 4 vertices.
    Tetrahedron {
        /// Edge length (m).
        size: f64,
    },
    /// A tube along a trefoil knot that winds around the y axis.
    ///
    /// Its centre line is ((R + a cos 3t) cos 2t, a sin 3t, (R + a cos 3t) sin 2t) with R = `radius`, a = R/2.
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
    /// The names of all shapes, as used in scene files and by [`Primitive::from_name`].
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

    /// The shape of this name with default size and resolution; `None` if the name is not in [`Primitive::NAMES`].
    ///
    /// ```
    /// use tumble::Primitive;
    /// let sphere = Primitive::from_name("sphere").unwrap();
    /// assert_eq!(sphere, Primitive::Sphere { radius: 0.15, subdivisions: 3 });
    /// assert_eq!(sphere.mesh()?.vertices.len(), 642);
    /// # Ok::<(), tumble::PrimitiveError>(())
    /// ```
    pub fn from_name(name: &str) -> Option<Self> {
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
}
