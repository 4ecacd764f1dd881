//! From a scene and its frames to what draws them.

use std::borrow::Cow;

use tumble::{DVec3, Mesh, World};

use crate::appearance::{is_kinematic, surface_of};
use crate::picture::{self, Boundary, PictureBody, PictureInput, Renderer, View, encode_png};
use crate::scene::Scene;

/// The motion in one picture, as PNG.
pub(super) fn motion_picture(
    scene: &Scene,
    world: &World,
    frames: &[picture::Frame],
) -> Result<Vec<u8>, picture::PictureError> {
    let view = (picture::DEFAULT_SIZE, None);
    in_studio((scene, world), frames, view, |studio| encode_png(&studio.render_motion()))
}

/// The walls of a scene.
pub(crate) fn boundary(scene: &Scene) -> Vec<Boundary> {
    let of_box = scene.box_walls.iter().map(|own| Boundary::Box {
        min: own.walls.min,
        max: own.walls.max,
        orientation: own.walls.orientation,
        open: own.walls.open,
    });
    let single = scene
        .walls
        .iter()
        .map(|wall| Boundary::Plane { normal: wall.plane.normal, offset: wall.plane.offset });
    of_box.chain(single).collect()
}

/// Draws with a studio for pictures of this size (pixels) and view.
pub(crate) fn in_studio<T>(
    (scene, world): (&Scene, &World),
    frames: &[picture::Frame],
    (size, view): ((u32, u32), Option<View>),
    draw: impl FnOnce(&Renderer) -> T,
) -> T {
    // bodies without a surface are drawn by their particles
    let looks: Vec<(Cow<Mesh>, Vec<DVec3>)> = world
        .bodies()
        .map(|body| {
            let surface = surface_of(body.model());
            let bare = surface.triangles.is_empty();
            let particles = body.model().shape.particles();
            let points = if bare { particles.iter().collect() } else { Vec::new() };
            (surface, points)
        })
        .collect();
    let bodies: Vec<_> = world
        .bodies()
        .zip(&looks)
        .map(|(body, (surface, points))| {
            let is_kinematic = is_kinematic(body.model());
            let vertices = if points.is_empty() { &surface.vertices } else { points };
            PictureBody { name: body.name(), vertices, triangles: &surface.triangles, is_kinematic }
        })
        .collect();
    let picture = PictureInput {
        title: &scene.name,
        up: -scene.gravity,
        bodies: &bodies,
        boundary: &boundary(scene),
        frames,
        size,
    };
    draw(&Renderer::with_view(&picture, view))
}
