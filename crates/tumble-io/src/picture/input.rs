//! Input of a picture: bodies, walls, recorded frames and the view.

use glam::{DQuat, DVec3};

/// Default size of a picture: width and height in pixels.
pub const DEFAULT_SIZE: (u32, u32) = (1600, 1000);

/// Everything needed to draw pictures of a run.
#[derive(Clone, Copy, Debug)]
pub struct PictureInput<'a> {
    /// Title at the top of the picture; empty for none.
    pub title: &'a str,
    /// Direction that points up in the picture, opposite to gravity. It may have any length; zero means +y.
    pub up: DVec3,
    /// Bodies, in the order of [`Frame::poses`].
    pub bodies: &'a [PictureBody<'a>],
    /// Boxes and planes that bound the motion; empty for free space.
    pub boundary: &'a [Boundary],
    /// Recorded frames in order of time.
    pub frames: &'a [Frame],
    /// Width and height in pixels, each clamped to the range from 1 to 16384.
    pub size: (u32, u32),
}

/// Viewing direction and magnification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Rotation of the viewer about the up direction (rad). At 0 the view is along −z
    /// if +y is up, and along +y if +z is up.
    pub yaw: f64,
    /// Angle by which the viewer looks down (rad).
    pub pitch: f64,
    /// Magnification: 1 shows the walls and the whole motion, 2 shows the middle at twice that size.
    pub zoom: f64,
}

/// Geometry and name of a body.
#[derive(Clone, Copy, Debug)]
pub struct PictureBody<'a> {
    /// Name in the legend.
    pub name: &'a str,
    /// Vertices in the body frame (m), with the centre of mass at the origin.
    pub vertices: &'a [DVec3],
    /// Triangles as indices into `vertices`. If empty, each vertex is drawn as a small sphere.
    pub triangles: &'a [[u32; 3]],
    /// Whether the motion of the body is prescribed. Such a body is drawn grey and translucent.
    pub is_kinematic: bool,
}

/// A box or plane that bounds the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Boundary {
    /// A box with the bodies inside.
    Box {
        /// Corner with the smallest coordinates (m), in the frame of the box.
        min: DVec3,
        /// Corner with the largest coordinates (m), in the frame of the box.
        max: DVec3,
        /// Rotation from the frame of the box to the world frame, about the world origin.
        orientation: DQuat,
        /// Which faces are missing, in the order −x, +x, −y, +y, −z, +z.
        open: [bool; 6],
    },
    /// An infinite wall, solid where `normal`·x < `offset`.
    Plane {
        /// Normal that points out of the solid. It may have any length except zero.
        normal: DVec3,
        /// Offset of the plane along `normal` (m if `normal` has unit length).
        offset: f64,
    },
}

/// Poses of all bodies at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Time (s).
    pub time: f64,
    /// One pose per body. Bodies with a pose that is not finite are not drawn.
    pub poses: Vec<Pose>,
}

/// Position and orientation of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Centre of mass (m).
    pub position: DVec3,
    /// Rotation from the body frame to the world frame.
    pub orientation: DQuat,
}

/// Upper bound on coordinates that are drawn (m). It keeps squares and cubes of coordinates finite.
const MAX_COORDINATE: f64 = 1e90;

/// Whether a point is finite and near enough to be drawn.
pub(super) fn is_drawable(point: DVec3) -> bool {
    point.abs().max_element() < MAX_COORDINATE && !point.is_nan()
}

/// The quaternion scaled to unit length, or `None` if it is not finite or too close to zero.
pub(super) fn unit_quaternion(orientation: DQuat) -> Option<DQuat> {
    let length = orientation.length();
    (length.is_finite() && length > 1e-9).then(|| (orientation * (1.0 / length)).normalize())
}

impl Frame {
    /// The pose of a body with a unit quaternion, or `None` if it is missing or cannot be drawn.
    pub(super) fn drawable_pose(&self, body: usize) -> Option<Pose> {
        let pose = self.poses.get(body)?;
        let orientation = unit_quaternion(pose.orientation)?;
        is_drawable(pose.position).then_some(Pose { position: pose.position, orientation })
    }
}
