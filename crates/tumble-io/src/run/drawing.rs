//! `motion.png`: from a scene and its frames to the picture.

use tumble::{DVec3, World};

use crate::picture::{self, Boundary, MotionPicture, PictureBody, encode_png, render};
use crate::scene::Scene;

/// The motion in one picture, as PNG.
pub(super) fn motion_picture(
    scene: &Scene,
    world: &World,
    frames: &[picture::Frame],
) -> Result<Vec<u8>, picture::PictureError> {
    // bodies without a surface are drawn by their particles
    let points: Vec<Vec<DVec3>> = world
        .bodies()
        .map(|body| {
            let shape = &body.model().shape;
            let bare = shape.surface().triangles.is_empty();
            if bare { shape.particles().iter().collect() } else { Vec::new() }
        })
        .collect();
    let bodies: Vec<_> = world
        .bodies()
        .zip(&points)
        .map(|(body, points)| {
            let surface = body.model().shape.surface();
            let vertices = if points.is_empty() { &surface.vertices } else { points };
            PictureBody { name: body.name(), vertices, triangles: &surface.triangles }
        })
        .collect();
    let of_box = scene.walls_of_box.iter().map(|own| Boundary::Box {
        min: own.walls.min,
        max: own.walls.max,
        orientation: own.walls.orientation,
        open: own.walls.open,
    });
    let single = scene
        .walls
        .iter()
        .map(|wall| Boundary::Plane { normal: wall.plane.normal, offset: wall.plane.offset });
    encode_png(&render(&MotionPicture {
        title: &scene.name,
        up: -scene.gravity,
        bodies: &bodies,
        boundary: &of_box.chain(single).collect::<Vec<_>>(),
        frames,
        size: picture::DEFAULT_SIZE,
    }))
}
