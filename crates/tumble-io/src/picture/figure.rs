//! A body prepared for drawing: welded, thinned out to what can be seen, with smooth normals.

use super::camera::{Camera, Projected};
use super::raster::Layer;
use super::{PictureBody, Pose, drawable};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// More vertices than this are thinned out.
const MOST_VERTICES: usize = 120_000;
/// Faces that meet at less than this angle (its cosine) are shaded as one smooth surface.
const CREASE: f32 = 0.75;
/// A body is drawn at least this many pixels in radius, so that none gets lost.
pub(super) const LEAST_RADIUS: f32 = 6.0;

/// How the light falls, in the frame of the picture: right, up, to the viewer.
pub(super) struct Light {
    key: Vec3,
    half: Vec3,
    sky: Vec3,
}

impl Light {
    /// A lamp above the viewer's left shoulder, and a bright sky.
    pub fn new(camera: &Camera, up: DVec3) -> Self {
        let key = Vec3::new(-0.5, 0.75, 0.62).normalize();
        let sky = camera.turn(up).as_vec3().normalize_or(Vec3::Y);
        Self { key, half: (key + Vec3::Z).normalize(), sky }
    }

    /// The colour of a surface with this normal, before any paling.
    fn shade(&self, colour: [f32; 3], normal: Vec3) -> [f32; 3] {
        let lambert = normal.dot(self.key).max(0.0);
        let level = 0.60 + 0.13 * normal.dot(self.sky) + 0.40 * lambert;
        let gleam = normal.dot(self.half).max(0.0).powi(28) * 34.0;
        // a darker rim sets a body off against a light background and against its own kind
        let edge = 1.0 - normal.z.clamp(0.0, 1.0);
        let rim = 1.0 - 0.42 * edge * edge * edge;
        colour.map(|c| (c * level * rim + gleam).min(255.0))
    }
}

/// The look of a body at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paint {
    pub colour: [f32; 3],
    /// 0: the full colour; 1: lost in the background.
    pub paleness: f32,
    pub alpha: u8,
}

/// What pale things fade into.
pub(super) const PAPER: [f32; 3] = [247.0, 248.0, 250.0];

impl Paint {
    fn lit(&self, light: &Light, normal: Vec3) -> [u8; 4] {
        let normal = normal.normalize_or(Vec3::Z);
        let shaded = light.shade(self.colour, normal);
        let mix = |c: usize| shaded[c] + (PAPER[c] - shaded[c]) * self.paleness;
        [mix(0) as u8, mix(1) as u8, mix(2) as u8, self.alpha]
    }
}

/// The vertices and triangles of a body as they are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Figure {
    pub points: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// The normals at the three corners of each triangle.
    normals: Vec<[Vec3; 3]>,
    /// The distance of the farthest vertex from the centre of mass (m).
    pub radius: f64,
    /// The root mean square distance of the vertices from the centre of mass (m).
    pub spread: f64,
    /// The radius of the ball that stands for a vertex (m).
    pub ball: f64,
}

/// The distance of the farthest drawable vertex from the origin of the body's frame (m).
pub(super) fn radius(body: &PictureBody) -> f64 {
    let farthest = |r: f64, v: &DVec3| r.max(v.length_squared());
    body.vertices.iter().filter(|v| drawable(**v)).fold(0.0, farthest).sqrt()
}

impl Figure {
    /// Prepares a body of a known radius (m) for pictures in which a pixel spans this length (m).
    pub fn new(body: &PictureBody, radius: f64, pixel: f64) -> Self {
        let (points, triangles) = thin_out(body, radius, pixel);
        let normals = corner_normals(&points, &triangles, radius);
        // balls that nearly touch if the vertices are spread over a surface
        let ball = radius * (1.1 / (points.len().max(1) as f64).sqrt()).clamp(0.012, 0.16);
        let squares: f64 = points.iter().map(|p| p.length_squared()).sum();
        let spread = (squares / points.len().max(1) as f64).sqrt();
        Self { points, triangles, normals, radius, spread, ball }
    }

    /// The rectangle of pixels that the body fills at a pose, near enough to put words beside it.
    pub fn outline(&self, pose: &Pose, camera: &Camera) -> Option<[i32; 4]> {
        let centre = camera.project(pose.position)?;
        let stride = (self.points.len() / 400).max(1);
        let places = self.points.iter().step_by(stride);
        let places = places.filter_map(|p| camera.project(pose.position + pose.orientation * *p));
        let mut low = (centre.x - LEAST_RADIUS, centre.y - LEAST_RADIUS);
        let mut high = (centre.x + LEAST_RADIUS, centre.y + LEAST_RADIUS);
        for place in places {
            low = (low.0.min(place.x), low.1.min(place.y));
            high = (high.0.max(place.x), high.1.max(place.y));
        }
        Some([low.0 as i32, low.1 as i32, high.0 as i32, high.1 as i32])
    }

    /// A square of pixels that holds the body wherever it points.
    pub fn reach(&self, pose: &Pose, camera: &Camera) -> Option<[i32; 4]> {
        let centre = camera.project(pose.position)?;
        let size = camera.pixels(self.radius + self.ball, centre);
        // a sphere looks a little larger than its radius at its centre's distance
        let bulge = camera.relative(self.radius + self.ball) * centre.nearness;
        let size = size / (1.0 - bulge).max(0.05) * 1.2 + LEAST_RADIUS + 3.0;
        let (x, y) = (centre.x, centre.y);
        Some([(x - size) as i32, (y - size) as i32, (x + size) as i32, (y + size) as i32])
    }

    /// Draws the body.
    pub fn draw(
        &self,
        pose: &Pose,
        camera: &Camera,
        light: &Light,
        paint: Paint,
        layer: &mut Layer,
    ) {
        let Some(centre) = camera.project(pose.position) else { return };
        if camera.pixels(self.radius, centre) < LEAST_RADIUS {
            let size = LEAST_RADIUS.max(camera.pixels(self.radius + self.ball, centre));
            layer.ball(centre, size, 0.0, |n| paint.lit(light, Vec3::from(n)));
            return;
        }
        let place = |v: &DVec3| camera.project(pose.position + pose.orientation * *v);
        if self.triangles.is_empty() {
            let bulge = camera.relative(self.ball);
            for at in self.points.iter().filter_map(place) {
                let size = camera.pixels(self.ball, at).max(1.2);
                layer.ball(at, size, bulge, |n| paint.lit(light, Vec3::from(n)));
            }
            return;
        }
        let placed: Vec<Option<Projected>> = self.points.iter().map(place).collect();
        let turn = |axis: DVec3| camera.turn(pose.orientation * axis).as_vec3();
        let (x, y, z) = (turn(DVec3::X), turn(DVec3::Y), turn(DVec3::Z));
        for (triangle, normals) in self.triangles.iter().zip(&self.normals) {
            let corners = triangle.map(|i| placed[i as usize]);
            let [Some(a), Some(b), Some(c)] = corners else { continue };
            layer.triangle([a, b, c], |[u, v, w]| {
                let n = normals[0] * u + normals[1] * v + normals[2] * w;
                let seen = x * n.x + y * n.y + z * n.z;
                // a sheet is lit on both of its sides
                paint.lit(light, if seen.z < 0.0 { -seen } else { seen })
            });
        }
    }
}

/// Merges vertices that share a cell of space, so that a mesh is as fine as can be seen, and a
/// soup of triangles becomes a surface.
fn thin_out(body: &PictureBody, radius: f64, pixel: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut cell = 1e-6 * radius;
    if body.vertices.len() > MOST_VERTICES {
        cell = cell.max(1.5 * pixel).max(radius / 500.0);
    }
    let (mut points, mut cell_of) = merge(body.vertices, cell);
    // a filled cloud has more cells than a surface has
    while points.len() > MOST_VERTICES {
        cell *= 1.5;
        (points, cell_of) = merge(body.vertices, cell);
    }
    let find = |i: u32| cell_of.get(i as usize).copied().filter(|&p| p != NONE);
    let mut triangles = Vec::with_capacity(body.triangles.len());
    for &[a, b, c] in body.triangles {
        let (Some(a), Some(b), Some(c)) = (find(a), find(b), find(c)) else { continue };
        if a != b && b != c && c != a {
            triangles.push([a, b, c]);
        }
    }
    (points, triangles)
}

const NONE: u32 = u32::MAX;

/// The first vertex in each cell, and for each vertex the one that stands for it.
fn merge(vertices: &[DVec3], cell: f64) -> (Vec<DVec3>, Vec<u32>) {
    let scale = if cell > 0.0 { 1.0 / cell } else { 0.0 };
    let mut first = HashMap::new();
    let mut points = Vec::new();
    let keep = |vertex: &DVec3| {
        if !drawable(*vertex) {
            return NONE;
        }
        let key = (*vertex * scale).round().to_array().map(|c| c as i64);
        *first.entry(key).or_insert_with(|| {
            points.push(*vertex);
            (points.len() - 1) as u32
        })
    };
    let cell_of = vertices.iter().map(keep).collect();
    (points, cell_of)
}

/// The normal at each corner of each triangle: smooth across flat edges, sharp across creases.
pub(crate) fn corner_normals(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    radius: f64,
) -> Vec<[Vec3; 3]> {
    let scale = if radius > 0.0 { 1.0 / radius } else { 1.0 };
    // area-weighted normal of each face
    let face = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| points[i as usize] * scale);
        (b - a).cross(c - a)
    };
    let areas: Vec<DVec3> = triangles.iter().map(face).collect();
    let flat: Vec<Vec3> = areas.iter().map(|n| n.normalize_or_zero().as_vec3()).collect();
    // the faces around each vertex, one after the other
    let mut start = vec![0usize; points.len() + 1];
    for &i in triangles.iter().flatten() {
        start[i as usize + 1] += 1;
    }
    for i in 0..points.len() {
        start[i + 1] += start[i];
    }
    let mut faces = vec![0u32; 3 * triangles.len()];
    let mut next = start.clone();
    for (f, &i) in triangles.iter().enumerate().flat_map(|(f, t)| t.iter().map(move |i| (f, i))) {
        faces[next[i as usize]] = f as u32;
        next[i as usize] += 1;
    }
    let corner = |f: usize, i: u32| {
        let around = &faces[start[i as usize]..start[i as usize + 1]];
        let mut sum = DVec3::ZERO;
        // a hub of very many faces costs their square; the first ones tell enough
        for &other in around.iter().take(64) {
            if flat[other as usize].dot(flat[f]) > CREASE {
                sum += areas[other as usize];
            }
        }
        sum.try_normalize().map_or(flat[f], |n| n.as_vec3())
    };
    let corners = |(f, t): (usize, &[u32; 3])| t.map(|i| corner(f, i));
    triangles.iter().enumerate().map(corners).collect()
}
