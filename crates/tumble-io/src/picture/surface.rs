//! Floors and walls: flat, see-through rectangles with a grid and shadows, and the edges of boxes.

use super::camera::Camera;
use super::raster::Layer;
use super::shadow::ShadowMap;
use super::text::round_number;
use super::{Boundary, drawable, rotation};
use glam::{DQuat, DVec3};

/// A flat rectangle, seen from the side on which the bodies are.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    /// The middle (m).
    pub origin: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    /// Points to where the bodies are.
    pub normal: DVec3,
    /// Half of the sides along `u` and `v` (m).
    pub half: [f64; 2],
    /// Distance of the lines (m); 0 for none.
    pub grid: f64,
    /// Ends in a soft edge, because the wall goes on for ever.
    fading: bool,
    only_lines: bool,
    fill: [f32; 3],
    line: [f32; 3],
    alpha: f32,
    pub shadow: Option<ShadowMap>,
}

/// An edge of a box, and whether it lies between the viewer and the bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub ends: [DVec3; 2],
    pub front: bool,
}

const FLOOR: [f32; 3] = [229.0, 233.0, 239.0];
const FLOOR_LINE: [f32; 3] = [204.0, 210.0, 219.0];
const WALL: [f32; 3] = [238.0, 240.0, 244.0];
/// A surface at least this level catches shadows.
const LEVEL: f64 = 0.35;

impl Surface {
    fn new(origin: DVec3, axes: [DVec3; 3], half: [f64; 2], is_floor: bool) -> Self {
        let [u, v, normal] = axes;
        Self {
            origin,
            u,
            v,
            normal,
            half,
            grid: 0.0,
            fading: false,
            only_lines: false,
            fill: if is_floor { FLOOR } else { WALL },
            line: FLOOR_LINE,
            alpha: if is_floor { 0.92 } else { 0.75 },
            shadow: is_floor.then(|| ShadowMap::new(half)),
        }
    }

    /// The colour at a place on the surface; `pixel` is the length of a pixel there (m).
    fn colour(&self, x: f64, y: f64, pixel: f64, foot: DVec3) -> [u8; 4] {
        let (px, py) = (x / self.half[0], y / self.half[1]);
        if px.abs() > 1.0 || py.abs() > 1.0 {
            return [0; 4];
        }
        let mut alpha = self.alpha;
        if self.fading {
            let rim = (1.0 - (px * px + py * py).sqrt()).clamp(0.0, 0.6) as f32 / 0.6;
            alpha *= rim * rim * (3.0 - 2.0 * rim);
        }
        let mut colour = self.fill;
        let near_line = |along: f64| {
            // the part of a cell, by a cast: rounding is slow on the plainest processors
            let cells = (along / self.grid).abs();
            let part = cells - cells as i64 as f64;
            part.min(1.0 - part) * self.grid < 0.7 * pixel
        };
        if self.grid > 0.0 && (near_line(foot.dot(self.u)) || near_line(foot.dot(self.v))) {
            colour = self.line;
        } else if self.only_lines {
            return [0; 4];
        }
        let dark = self.shadow.as_ref().map_or(0.0, |s| s.at(x + self.half[0], y + self.half[1]));
        let keep = 1.0 - dark.min(0.75);
        let [r, g, b] = colour.map(|c| c * keep);
        // a shadow is a little blue, as under an open sky
        [r as u8, g as u8, (b + 14.0 * dark).min(255.0) as u8, (255.0 * alpha) as u8]
    }

    /// Draws the surface as far as it is seen.
    pub fn draw(&self, camera: &Camera, layer: &mut Layer) {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| {
            camera.project(self.origin + self.u * (a * self.half[0]) + self.v * (b * self.half[1]))
        });
        let (mut low, mut high) = ((layer.left, layer.top), (layer.left, layer.top));
        high = (high.0 + layer.width, high.1 + layer.height);
        if let [Some(a), Some(b), Some(c), Some(d)] = corners {
            let x = [a.x, b.x, c.x, d.x].map(|x| x as i32);
            let y = [a.y, b.y, c.y, d.y].map(|y| y as i32);
            let least = |v: [i32; 4]| v.into_iter().min().unwrap_or(0) - 1;
            let most = |v: [i32; 4]| v.into_iter().max().unwrap_or(0) + 2;
            low = (low.0.max(least(x)), low.1.max(least(y)));
            high = (high.0.min(most(x)), high.1.min(most(y)));
        }
        let pixel = camera.pixel_length() / (camera.eye() - camera.centre()).dot(camera.back);
        for row in low.1..high.1 {
            for column in low.0..high.0 {
                let (eye, sight) = camera.sight(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let depth = (self.origin - eye).dot(self.normal) / sight.dot(self.normal);
                if depth > 1e-3 && depth < 1e6 {
                    let foot = eye + sight * depth;
                    let local = foot - self.origin;
                    let (x, y) = (local.dot(self.u), local.dot(self.v));
                    // the length of a pixel grows with the distance
                    let pixel = pixel * depth * camera.scale();
                    layer.put(column, row, (1.0 / depth) as f32, || self.colour(x, y, pixel, foot));
                }
            }
        }
    }
}

/// What the boundaries look like: faces behind the bodies, in groups that cannot hide one another,
/// and edges of boxes.
pub(super) fn build(
    boundary: &[Boundary],
    camera: &Camera,
    up: DVec3,
) -> (Vec<Vec<Surface>>, Vec<Edge>) {
    let (mut groups, mut edges) = (Vec::new(), Vec::new());
    for part in boundary {
        match *part {
            Boundary::Box { min, max, orientation, open } => {
                let Some(frame) = Cuboid::new(min, max, orientation) else { continue };
                groups.push(frame.faces(open, camera, up));
                edges.extend(frame.edges(open, camera));
            }
            Boundary::Plane { normal, offset } => {
                groups.extend(plane(normal, offset, camera, up).map(|surface| vec![surface]));
            }
        }
    }
    if boundary.is_empty() {
        groups.push(vec![free_space(camera, up)]);
    }
    (groups, edges)
}

/// The corners of a box (m) in the world, for framing it.
pub(super) fn corners(part: &Boundary) -> Vec<DVec3> {
    let Boundary::Box { min, max, orientation, .. } = *part else { return Vec::new() };
    let Some(frame) = Cuboid::new(min, max, orientation) else { return Vec::new() };
    let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    (0..8).map(|i| frame.at([sign(i & 1), sign(i & 2), sign(i & 4)])).collect()
}

/// A box by its middle, half sides and axes.
struct Cuboid {
    centre: DVec3,
    half: DVec3,
    axes: [DVec3; 3],
}

impl Cuboid {
    fn new(min: DVec3, max: DVec3, orientation: DQuat) -> Option<Self> {
        let turn = rotation(orientation)?;
        (drawable(min) && drawable(max)).then(|| Self {
            centre: turn * (0.5 * (min + max)),
            half: (0.5 * (max - min)).abs(),
            axes: [turn * DVec3::X, turn * DVec3::Y, turn * DVec3::Z],
        })
    }

    /// A point by its coordinates from −1 to 1.
    fn at(&self, part: [f64; 3]) -> DVec3 {
        (0..3).fold(self.centre, |sum, a| sum + self.axes[a] * (part[a] * self.half[a]))
    }

    /// Whether the viewer sees the inner side of a face.
    fn seen_from_inside(&self, axis: usize, sign: f64, camera: &Camera) -> bool {
        let centre = self.centre + self.axes[axis] * (sign * self.half[axis]);
        (camera.eye() - centre).dot(self.axes[axis]) * sign < 0.0
    }

    fn faces(&self, open: [bool; 6], camera: &Camera, up: DVec3) -> Vec<Surface> {
        let mut faces = Vec::new();
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let sign = if side == 0 { -1.0 } else { 1.0 };
            if open[2 * axis + side] || !self.seen_from_inside(axis, sign, camera) {
                continue;
            }
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let normal = self.axes[axis] * -sign;
            let centre = self.centre - normal * self.half[axis];
            let half = [self.half[u], self.half[v]];
            let is_floor = normal.dot(up) > LEVEL;
            let axes = [self.axes[u], self.axes[v], normal];
            let mut face = Surface::new(centre, axes, half, is_floor);
            if is_floor {
                face.grid = round_number(half[0].max(half[1]) / 4.0);
            }
            faces.push(face);
        }
        faces
    }

    fn edges(&self, open: [bool; 6], camera: &Camera) -> Vec<Edge> {
        let mut edges = Vec::new();
        for (axis, i, j) in (0..12).map(|edge| (edge / 4, edge & 1, (edge >> 1) & 1)) {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            if open[2 * u + i] && open[2 * v + j] {
                continue;
            }
            let sign = |side: usize| if side == 0 { -1.0 } else { 1.0 };
            let mut part = [0.0; 3];
            (part[axis], part[u], part[v]) = (-1.0, sign(i), sign(j));
            let start = self.at(part);
            part[axis] = 1.0;
            let front = !self.seen_from_inside(u, sign(i), camera)
                && !self.seen_from_inside(v, sign(j), camera);
            edges.push(Edge { ends: [start, self.at(part)], front });
        }
        edges
    }
}

/// Level directions on a plane, along the axes of the world where that can be.
fn plane_axes(normal: DVec3) -> (DVec3, DVec3) {
    let axis = if normal.x.abs() < 0.7 { DVec3::X } else { DVec3::Z };
    let u = (axis - normal * normal.dot(axis)).normalize();
    (u, normal.cross(u))
}

/// The part of an infinite wall that lies around the motion.
fn plane(normal: DVec3, offset: f64, camera: &Camera, up: DVec3) -> Option<Surface> {
    let length = normal.length();
    if !(drawable(normal) && length > 1e-90 && offset.is_finite()) {
        return None;
    }
    let (normal, offset) = (normal / length, offset / length);
    let height = camera.centre().dot(normal) - offset;
    let is_floor = normal.dot(up) > LEVEL;
    // below the motion, or beside it
    let way = if is_floor { up / normal.dot(up) } else { normal };
    let origin = camera.centre() - way * height;
    if !drawable(origin) {
        return None;
    }
    let (u, v) = plane_axes(normal);
    let size = 2.6 * camera.scale();
    let mut surface = Surface::new(origin, [u, v, normal], [size, size], is_floor);
    surface.fading = true;
    surface.grid = round_number(camera.scale() / 3.0);
    // seen from within the solid, a wall must not hide the motion
    if (camera.eye() - origin).dot(normal) < 0.0 {
        surface.alpha = 0.25;
    }
    Some(surface)
}

/// Without walls, a faint grid below the motion tells directions and sizes.
fn free_space(camera: &Camera, up: DVec3) -> Surface {
    let origin = camera.centre() - up * (0.9 * camera.scale());
    let (u, v) = plane_axes(up);
    let size = 2.0 * camera.scale();
    let mut surface = Surface::new(origin, [u, v, up], [size, size], false);
    surface.fading = true;
    surface.grid = round_number(camera.scale() / 3.0);
    surface.only_lines = true;
    surface
}
