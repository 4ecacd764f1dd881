//! Pictures of a run, rendered in software: no display, graphics card or system fonts needed.
//!
//! [`render`] shows the bodies at several times, earlier ones paler, with the paths of their
//! centres of mass, the walls, shadows on the floor and a legend. A [`Renderer`] holds what all
//! pictures of one run share, so that every frame of an animation has the same view.
//!
//! | file | contents |
//! |---|---|
//! | `input` | the bodies, walls and frames that a picture shows |
//! | `camera` | perspective projection from world coordinates to pixels |
//! | `framing` | choice of the view |
//! | `layer` | rasterisation of triangles, spheres and lines with a depth buffer |
//! | `normals`, `body_mesh` | meshes of bodies: welding, decimation, normals |
//! | `colour`, `shading` | colours of bodies and lighting |
//! | `rectangle`, `surface`, `shadow` | floors, walls and the shadows on them |
//! | `snapshots` | choice of the times to show |
//! | `text`, `legend` | labels |
//! | `renderer` | drawing order, compositing and antialiasing |
//! | `image` | pixels and PNG output |
//!
//! ```
//! use tumble::{DQuat, DVec3};
//! use tumble_io::picture::{Boundary, Frame, PictureBody, PictureInput, Pose, encode_png, render};
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
//! let input = PictureInput {
//!     title: "throw",
//!     up: DVec3::Y,
//!     bodies: &bodies,
//!     boundary: &boundary,
//!     frames: &frames,
//!     size: (320, 200),
//! };
//! let png = encode_png(&render(&input))?;
//! assert_eq!(&png[1..4], b"PNG");
//! # Ok::<(), tumble_io::picture::PictureError>(())
//! ```

mod body_mesh;
mod camera;
mod colour;
mod framing;
mod image;
mod input;
mod layer;
mod legend;
mod normals;
mod rectangle;
mod renderer;
mod shading;
mod shadow;
mod snapshots;
mod surface;
#[cfg(test)]
mod tests;
mod text;

pub(crate) use colour::body_colour;
pub use image::{Image, PictureError, encode_png};
pub use input::{Boundary, DEFAULT_SIZE, Frame, PictureBody, PictureInput, Pose, View};
pub(crate) use normals::corner_normals;
pub use renderer::{Renderer, render};
