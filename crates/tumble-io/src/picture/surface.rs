//! Floors and walls, drawn as translucent rectangles with grid lines and shadows, and the edges of boxes.

use super::camera::Camera;
use super::input::{Boundary, is_drawable, unit_quaternion};
use super::layer::Layer;
use super::rectangle::Rectangle;
use super::shadow::ShadowMap;
use super::text::nice_number;
use glam::{DQuat, DVec3};

/// A floor or wall, drawn only from the side of the bodies.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub rectangle: Rectangle,
    /// Spacing of the grid lines (m); 0 for no grid.
    pub grid: f64,
    /// Whether the surface fades out towards its rim, because it stands for an infinite plane.
    has_soft_rim: bool,
    /// Whether only the grid lines are drawn.
    is_grid_only: bool,
    fill: [f32; 3],
    line: [f32; 3],
    alpha: f32,
    pub shadow: Option<ShadowMap>,
}

/// An edge of a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// End points (m).
    pub ends: [DVec3; 2],
    /// Whether the edge lies between the viewer and the bodies.
    pub is_front: bool,
}

const FLOOR: [f32; 3] = [229.0, 233.0, 239.0];
const FLOOR_LINE: [f32; 3] = [204.0, 210.0, 219.0];
const WALL: [f32; 3] = [238.0, 240.0, 244.0];
/// A surface is a floor, and receives shadows, if the cosine of its tilt is above this.
const MIN_FLOOR_COSINE: f64 = 0.35;

impl Surface {
    fn new(rectangle: Rectangle, is_floor: bool) -> Self {
        Self {
            rectangle,
            grid: 0.0,
            has_soft_rim: false,
            is_grid_only: false,
            fill: if is_floor { FLOOR } else { WALL },
            line: FLOOR_LINE,
            alpha: if is_floor { 0.92 } else { 0.75 },
            shadow: is_floor.then(|| ShadowMap::new(rectangle.half)),
        }
    }

    /// The colour at a point of the surface. `(x, y)` are its coordinates along
    /// `u` and `v` (m), `point` its world position (m), and `pixel` the size of a pixel there (m).
    fn colour(&self, (x, y): (f64, f64), pixel: f64, point: DVec3) -> [u8; 4] {
        let Rectangle { u, v, half, .. } = self.rectangle;
        let (px, py) = (x / half[0], y / half[1]);
        if px.abs() > 1.0 || py.abs() > 1.0 {
            return [0; 4];
        }
        let mut alpha = self.alpha;
        if self.has_soft_rim {
            let rim = (1.0 - (px * px + py * py).sqrt()).clamp(0.0, 0.6) as f32 / 0.6;
            alpha *= rim * rim * (3.0 - 2.0 * rim);
        }
        let mut colour = self.fill;
        let near_line = |along: f64| {
            // the cast truncates; `floor` is slow on processors without SSE4.1
            let cells = (along / self.grid).abs();
            let part = cells - cells as i64 as f64;
            part.min(1.0 - part) * self.grid < 0.7 * pixel
        };
        if self.grid > 0.0 && (near_line(point.dot(u)) || near_line(point.dot(v))) {
            colour = self.line;
        } else if self.is_grid_only {
            return [0; 4];
        }
        let dark = self.shadow.as_ref().map_or(0.0, |s| s.darkness(x + half[0], y + half[1]));
        let brightness = 1.0 - dark.min(0.75);
        let [r, g, b] = colour.map(|c| c * brightness);
        // shadows are slightly blue, as outdoors
        [r as u8, g as u8, (b + 14.0 * dark).min(255.0) as u8, (255.0 * alpha) as u8]
    }

    /// Draws the surface by casting a ray through each pixel.
    pub fn draw(&self, camera: &Camera, layer: &mut Layer) {
        let Rectangle { centre, u, v, normal, half } = self.rectangle;
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(a, b)| camera.project(centre + u * (a * half[0]) + v * (b * half[1])));
        let (mut low, mut high) = ((layer.left, layer.top), (layer.left, layer.top));
        high = (high.0 + layer.width, high.1 + layer.height);
        if let [Some(a), Some(b), Some(c), Some(d)] = corners {
            let x = [a.x, b.x, c.x, d.x].map(|x| x as i32);
            let y = [a.y, b.y, c.y, d.y].map(|y| y as i32);
            let min = |v: [i32; 4]| v.into_iter().min().unwrap_or(0) - 1;
            let max = |v: [i32; 4]| v.into_iter().max().unwrap_or(0) + 2;
            low = (low.0.max(min(x)), low.1.max(min(y)));
            high = (high.0.min(max(x)), high.1.min(max(y)));
        }
        let pixel = camera.pixel_size() / (camera.eye() - camera.centre()).dot(camera.back);
        for row in low.1..high.1 {
            for column in low.0..high.0 {
                let (eye, ray) = camera.ray(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let depth = (centre - eye).dot(normal) / ray.dot(normal);
                if depth > 1e-3 && depth < 1e6 {
                    let point = eye + ray * depth;
                    let local = point - centre;
                    let at = (local.dot(u), local.dot(v));
                    // pixels cover more length at greater depth
                    let pixel = pixel * depth * camera.scale();
                    layer
                        .write(column, row, (1.0 / depth) as f32, || self.colour(at, pixel, point));
                }
            }
        }
    }
}

/// Surfaces behind the bodies, in groups whose members do not occlude each other, and the edges of boxes.
pub(super) fn from_boundary(
    boundary: &[Boundary],
    camera: &Camera,
    up: DVec3,
) -> (Vec<Vec<Surface>>, Vec<Edge>) {
    let (mut groups, mut edges) = (Vec::new(), Vec::new());
    for part in boundary {
        match *part {
            Boundary::Box { min, max, orientation, open } => {
                let Some(cuboid) = Cuboid::new(min, max, orientation) else { continue };
                groups.push(cuboid.faces(open, camera, up));
                edges.extend(cuboid.edges(open, camera));
            }
            Boundary::Plane { normal, offset } => {
                groups.extend(plane(normal, offset, camera, up).map(|surface| vec![surface]));
            }
        }
    }
    if boundary.is_empty() {
        groups.push(vec![reference_grid(camera, up)]);
    }
    (groups, edges)
}

/// The corners of a box in world coordinates (m). Empty for a plane.
pub(super) fn corners(part: &Boundary) -> Vec<DVec3> {
    let Boundary::Box { min, max, orientation, .. } = *part else { return Vec::new() };
    let Some(cuboid) = Cuboid::new(min, max, orientation) else { return Vec::new() };
    let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    (0..8).map(|i| cuboid.point([sign(i & 1), sign(i & 2), sign(i & 4)])).collect()
}

/// An oriented box.
struct Cuboid {
    centre: DVec3,
    half: DVec3,
    axes: [DVec3; 3],
}

impl Cuboid {
    fn new(min: DVec3, max: DVec3, orientation: DQuat) -> Option<Self> {
        let rotation = unit_quaternion(orientation)?;
        (is_drawable(min) && is_drawable(max)).then(|| Self {
            centre: rotation * (0.5 * (min + max)),
            half: (0.5 * (max - min)).abs(),
            axes: [rotation * DVec3::X, rotation * DVec3::Y, rotation * DVec3::Z],
        })
    }

    /// The world position (m) of a point given by coordinates from −1 to 1.
    fn point(&self, coordinates: [f64; 3]) -> DVec3 {
        (0..3).fold(self.centre, |sum, a| sum + self.axes[a] * (coordinates[a] * self.half[a]))
    }

    /// Whether the inner side of a face is visible.
    fn is_inside_visible(&self, axis: usize, sign: f64, camera: &Camera) -> bool {
        let centre = self.centre + self.axes[axis] * (sign * self.half[axis]);
        (camera.eye() - centre).dot(self.axes[axis]) * sign < 0.0
    }

    fn faces(&self, open: [bool; 6], camera: &Camera, up: DVec3) -> Vec<Surface> {
        let mut faces = Vec::new();
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let sign = if side == 0 { -1.0 } else { 1.0 };
            if open[2 * axis + side] || !self.is_inside_visible(axis, sign, camera) {
                continue;
            }
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let normal = self.axes[axis] * -sign;
            let centre = self.centre - normal * self.half[axis];
            let half = [self.half[u], self.half[v]];
            let is_floor = normal.dot(up) > MIN_FLOOR_COSINE;
            let (u, v) = (self.axes[u], self.axes[v]);
            let mut face = Surface::new(Rectangle { centre, u, v, normal, half }, is_floor);
            if is_floor {
                face.grid = nice_number(half[0].max(half[1]) / 4.0);
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
            let start = self.point(part);
            part[axis] = 1.0;
            let is_front = !self.is_inside_visible(u, sign(i), camera)
                && !self.is_inside_visible(v, sign(j), camera);
            edges.push(Edge { ends: [start, self.point(part)], is_front });
        }
        edges
    }
}

/// Unit vectors that span a plane, aligned with the world axes where possible.
fn plane_axes(normal: DVec3) -> (DVec3, DVec3) {
    let axis = if normal.x.abs() < 0.7 { DVec3::X } else { DVec3::Z };
    let u = (axis - normal * normal.dot(axis)).normalize();
    (u, normal.cross(u))
}

/// The part of an infinite plane around the motion.
fn plane(normal: DVec3, offset: f64, camera: &Camera, up: DVec3) -> Option<Surface> {
    let length = normal.length();
    if !(is_drawable(normal) && length > 1e-90 && offset.is_finite()) {
        return None;
    }
    let (normal, offset) = (normal / length, offset / length);
    let height = camera.centre().dot(normal) - offset;
    let is_floor = normal.dot(up) > MIN_FLOOR_COSINE;
    // project the centre of the scene along the vertical onto a floor, and along the normal onto a wall
    let direction = if is_floor { up / normal.dot(up) } else { normal };
    let centre = camera.centre() - direction * height;
    if !is_drawable(centre) {
        return None;
    }
    let (u, v) = plane_axes(normal);
    let size = 2.6 * camera.scale();
    let mut surface =
        Surface::new(Rectangle { centre, u, v, normal, half: [size, size] }, is_floor);
    surface.has_soft_rim = true;
    surface.grid = nice_number(camera.scale() / 3.0);
    // a wall between the viewer and the motion must not hide the motion
    if (camera.eye() - centre).dot(normal) < 0.0 {
        surface.alpha = 0.25;
    }
    Some(surface)
}

/// A faint grid below the motion that shows scale and orientation in free space.
fn reference_grid(camera: &Camera, up: DVec3) -> Surface {
    let centre = camera.centre() - up * (0.9 * camera.scale());
    let (u, v) = plane_axes(up);
    let size = 2.0 * camera.scale();
    let mut surface =
        Surface::new(Rectangle { centre, u, v, normal: up, half: [size, size] }, false);
    surface.has_soft_rim = true;
    surface.grid = nice_number(camera.scale() / 3.0);
    surface.is_grid_only = true;
    surface
}
