//! The motion of a run in one picture, drawn without a display, a graphics card or system fonts.
//!
//! [`render`] shows the bodies at several times, the earlier the paler, with the paths of their
//! centres of mass, the walls, shadows on the floor and a legend. A [`Studio`] holds what all
//! pictures of one run share, so that single frames (an animation) come out in the same view.
//!
//! | file | does |
//! |---|---|
//! | `camera` | where the viewer stands; points of the world to pixels |
//! | `raster` | triangles, discs and lines into layers with a depth buffer |
//! | `figure` | a body prepared for drawing: welded, thinned out, with normals |
//! | `surface`, `shadow` | walls and floors, and what falls on them |
//! | `moments` | which times to show |
//! | `compose` | the order of it all, and the sum over sub-pixels |
//! | `legend`, `text`, `image` | words and pixels |
//!
//! ```
//! use tumble::{DQuat, DVec3};
//! use tumble_io::picture::{Boundary, Frame, MotionPicture, PictureBody, Pose, encode_png, render};
//!
//! let bodies = [PictureBody {
//!     name: "point", vertices: &[DVec3::ZERO], triangles: &[], is_kinematic: false,
//! }];
//! let boundary = [Boundary::Plane { normal: DVec3::Y, offset: 0.0 }];
//! let frames: Vec<Frame> = (0..=10)
//!     .map(|i| {
//!         let time = 0.1 * f64::from(i);
//!         let position = DVec3::new(time, 5.0 * time * (1.0 - time), 0.0);
//!         Frame { time, poses: vec![Pose { position, orientation: DQuat::IDENTITY }] }
//!     })
//!     .collect();
//! let picture = MotionPicture {
//!     title: "throw",
//!     up: DVec3::Y,
//!     bodies: &bodies,
//!     boundary: &boundary,
//!     frames: &frames,
//!     size: (320, 200),
//! };
//! let png = encode_png(&render(&picture))?;
//! assert_eq!(&png[1..4], b"PNG");
//! # Ok::<(), tumble_io::picture::PictureError>(())
//! ```

mod camera;
mod compose;
mod figure;
mod image;
mod legend;
mod moments;
mod raster;
mod shadow;
mod surface;
#[cfg(test)]
mod tests;
mod text;

pub use compose::Studio;
pub(crate) use compose::colour;
pub(crate) use figure::corner_normals;
use glam::{DQuat, DVec3};
pub use image::{Image, PictureError, encode_png};

/// The usual size of a picture, in pixels: width, height.
pub const DEFAULT_SIZE: (u32, u32) = (1600, 1000);

/// All that a picture of a run needs.
#[derive(Clone, Copy, Debug)]
pub struct MotionPicture<'a> {
    /// Written at the top; empty for none.
    pub title: &'a str,
    /// The direction that points up in the picture: against gravity. Any length; zero means +y.
    pub up: DVec3,
    /// The bodies, in the order of [`Frame::poses`].
    pub bodies: &'a [PictureBody<'a>],
    /// Boxes and planes; empty for free space.
    pub boundary: &'a [Boundary],
    /// The recorded motion, first frame first.
    pub frames: &'a [Frame],
    /// Width and height in pixels; a side is held between 1 and 16384.
    pub size: (u32, u32),
}

/// Where a picture is seen from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Turns the viewer around the direction that points up (rad). At 0 the view goes along −z
    /// where +y is up, and along +y where +z is up.
    pub yaw: f64,
    /// How far the viewer looks down (rad).
    pub pitch: f64,
    /// 1 shows the walls and the whole motion, 2 enlarges the middle to twice that.
    pub zoom: f64,
}

/// What a body looks like.
#[derive(Clone, Copy, Debug)]
pub struct PictureBody<'a> {
    /// The name for the legend.
    pub name: &'a str,
    /// Vertices (m) in the body's frame, with the centre of mass at the origin.
    pub vertices: &'a [DVec3],
    /// Triangles as indices into `vertices`; empty: each vertex is drawn as a small ball.
    pub triangles: &'a [[u32; 3]],
    /// Whether something other than forces moves it: it is grey, and one looks through it.
    pub is_kinematic: bool,
}

/// What bounds the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Boundary {
    /// A box that holds the bodies inside.
    Box {
        /// The corner with the smallest coordinates (m), in the frame of the box.
        min: DVec3,
        /// The corner with the largest coordinates (m), in the frame of the box.
        max: DVec3,
        /// Turns the frame of the box into the world's, about the world's origin.
        orientation: DQuat,
        /// Faces that are missing: −x, +x, −y, +y, −z, +z.
        open: [bool; 6],
    },
    /// An infinite wall, solid where `normal`·x < `offset`.
    Plane {
        /// Points out of the solid. Any length but zero.
        normal: DVec3,
        /// Height of the wall along `normal` (m, when `normal` has length one).
        offset: f64,
    },
}

/// The bodies at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Time (s).
    pub time: f64,
    /// One pose a body; a pose that is not finite is left out of the picture.
    pub poses: Vec<Pose>,
}

/// Where a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The centre of mass (m).
    pub position: DVec3,
    /// Turns the body's frame into the world's.
    pub orientation: DQuat,
}

/// Coordinates beyond this (m) count as not finite: their squares and cubes must stay finite.
const REACH: f64 = 1e90;

/// Whether a point can be drawn at all.
fn drawable(point: DVec3) -> bool {
    point.abs().max_element() < REACH && !point.is_nan()
}

/// The rotation with length one, or none if there is no telling which.
fn rotation(orientation: DQuat) -> Option<DQuat> {
    let length = orientation.length();
    (length.is_finite() && length > 1e-9).then(|| (orientation * (1.0 / length)).normalize())
}

impl Frame {
    /// The pose of a body in this frame, if there is one that can be drawn.
    fn pose(&self, body: usize) -> Option<Pose> {
        let pose = self.poses.get(body)?;
        let orientation = rotation(pose.orientation)?;
        drawable(pose.position).then_some(Pose { position: pose.position, orientation })
    }
}

/// Draws the whole motion in one picture.
#[must_use]
pub fn render(picture: &MotionPicture) -> Image {
    Studio::new(picture).motion()
}
