//! Converts a scene, its world and its frames into the input of the picture module.

use std::borrow::Cow;

use tumble::{DVec3, Mesh, World};

use crate::appearance::{is_kinematic, surface_of};
use crate::picture::{self, Boundary, PictureBody, PictureInput, Renderer, View, encode_png};
use crate::scene::Scene;

/// Draws `motion.png`; returns the bytes of the PNG file.
pub(super) fn motion_picture(
    scene: &Scene,
    world: &World,
    frames: &[picture::Frame],
) -> Result<Vec<u8>, picture::PictureError> {
    let view = (picture::DEFAULT_SIZE, None);
    draw_run((scene, world), frames, view, |renderer| encode_png(&renderer.render_motion()))
}

/// The walls of a scene, as boundaries of the picture.
pub(crate) fn boundaries(scene: &Scene) -> Vec<Boundary> {
    let boxes = scene.box_walls.iter().map(|wall_box| Boundary::Box {
        min: wall_box.walls.min,
        max: wall_box.walls.max,
        orientation: wall_box.walls.orientation,
        open: wall_box.walls.open,
    });
    let planes = scene
        .walls
        .iter()
        .map(|wall| Boundary::Plane { normal: wall.plane.normal, offset: wall.plane.offset });
    boxes.chain(planes).collect()
}

/// Calls `draw` with a renderer for pictures of this size (pixels) and view.
pub(crate) fn draw_run<T>(
    (scene, world): (&Scene, &World),
    frames: &[picture::Frame],
    (size, view): ((u32, u32), Option<View>),
    draw: impl FnOnce(&Renderer) -> T,
) -> T {
    // a body without a surface is drawn as its particles
    let geometry: Vec<(Cow<Mesh>, Vec<DVec3>)> = world
        .bodies()
        .map(|body| {
            let surface = surface_of(body.model());
            let has_no_surface = surface.triangles.is_empty();
            let particles = body.model().shape.particles();
            let points = if has_no_surface { particles.iter().collect() } else { Vec::new() };
            (surface, points)
        })
        .collect();
    let bodies: Vec<_> = world
        .bodies()
        .zip(&geometry)
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
        boundary: &boundaries(scene),
        frames,
        size,
    };
    draw(&Renderer::with_view(&picture, view))
}
