//! Soft shadows on flat surfaces: dark and sharp below a touching body, faint and wide below a high one.

use super::body_mesh::BodyMesh;
use super::camera::Camera;
use super::input::Pose;
use super::rectangle::Rectangle;
use glam::DVec3;

/// Texels along the longer side of a rectangle.
const TEXELS: f64 = 640.0;
/// Largest blur radius in texels.
const MAX_BLUR: f64 = 36.0;
/// Largest radius of the shadow of a single vertex, in texels.
const MAX_VERTEX_RADIUS: f32 = 60.0;

/// The fraction of light blocked at each point of a rectangle.
#[derive(Clone, Debug)]
pub(super) struct ShadowMap {
    width: usize,
    height: usize,
    /// Size of a texel (m).
    texel: f64,
    dark: Vec<f32>,
}

/// The shadow of one body on a part of the map.
struct Patch {
    left: i64,
    top: i64,
    width: usize,
    height: usize,
    dark: Vec<f32>,
}

/// A vertex projected onto the surface: position in texels from the corner of the map, and darkness.
#[derive(Clone, Copy)]
struct ShadowPoint {
    x: f32,
    y: f32,
    dark: f32,
}

impl ShadowMap {
    /// An empty map for a rectangle with these half side lengths (m).
    pub fn new(half: [f64; 2]) -> Self {
        let texel = (2.0 * half[0].max(half[1]) / TEXELS).max(1e-90);
        let count = |side: f64| ((2.0 * side / texel).ceil() as usize).clamp(1, 2048);
        let (width, height) = (count(half[0]), count(half[1]));
        Self { width, height, texel, dark: vec![0.0; width * height] }
    }

    /// The darkness at a point given in metres from the corner of the map, by bilinear interpolation.
    pub fn darkness(&self, u: f64, v: f64) -> f32 {
        let (x, y) = ((u / self.texel - 0.5).max(0.0), (v / self.texel - 0.5).max(0.0));
        let (left, top) = ((x as usize).min(self.width - 1), (y as usize).min(self.height - 1));
        let (fx, fy) = ((x - left as f64).min(1.0) as f32, (y - top as f64).min(1.0) as f32);
        let (right, bottom) = ((left + 1).min(self.width - 1), (top + 1).min(self.height - 1));
        let texel = |x: usize, y: usize| self.dark[y * self.width + x];
        let upper = texel(left, top) * (1.0 - fx) + texel(right, top) * fx;
        let lower = texel(left, bottom) * (1.0 - fx) + texel(right, bottom) * fx;
        upper * (1.0 - fy) + lower * fy
    }

    /// Adds the shadow that a body casts on the rectangle in light from straight above.
    pub fn cast(
        &mut self,
        rectangle: &Rectangle,
        up: DVec3,
        camera: &Camera,
        body: &BodyMesh,
        pose: &Pose,
        weight: f32,
    ) {
        let slope = rectangle.normal.dot(up);
        let size = body.bounding_radius.max(4.0 * camera.pixel_size());
        let lowest = std::cell::Cell::new(f64::MAX);
        let project = |point: &DVec3| {
            let point = pose.position + pose.orientation * *point;
            let height = (point - rectangle.centre).dot(rectangle.normal);
            lowest.set(lowest.get().min(height));
            let local = point - up * (height / slope) - rectangle.centre;
            let relative_height = (height / (2.2 * size)).max(0.0);
            ShadowPoint {
                x: ((local.dot(rectangle.u) + rectangle.half[0]) / self.texel) as f32,
                y: ((local.dot(rectangle.v) + rectangle.half[1]) / self.texel) as f32,
                dark: weight / (1.0 + relative_height * relative_height) as f32,
            }
        };
        let points: Vec<ShadowPoint> = body.vertices.iter().map(project).collect();
        let lowest = lowest.get();
        // bodies below the surface or very high above it cast no shadow
        if !(-size..40.0 * size).contains(&lowest) {
            return;
        }
        let blur = ((0.05 * size + 0.22 * lowest.max(0.0)) / self.texel).clamp(1.0, MAX_BLUR);
        let vertex_radius =
            (body.vertex_radius.max(4.0 * camera.pixel_size() - body.bounding_radius) / self.texel)
                as f32;
        let vertex_radius =
            if body.triangles.is_empty() { vertex_radius.min(MAX_VERTEX_RADIUS) } else { 0.0 };
        if let Some(mut patch) = self.patch(&points, blur + f64::from(vertex_radius)) {
            patch.fill(&points, &body.triangles, vertex_radius);
            patch.blur(blur as usize);
            self.add(&patch);
        }
    }

    /// An empty patch that covers the points with a margin in texels, clipped to the map and its surroundings.
    fn patch(&self, points: &[ShadowPoint], margin: f64) -> Option<Patch> {
        let (mut low, mut high) = ((f32::MAX, f32::MAX), (f32::MIN, f32::MIN));
        for point in points {
            low = (low.0.min(point.x), low.1.min(point.y));
            high = (high.0.max(point.x), high.1.max(point.y));
        }
        let margin = (3.0 * margin + 2.0) as i64;
        let (wide, tall) = (self.width as i64 + margin, self.height as i64 + margin);
        let left = (low.0 as i64).saturating_sub(margin).max(-margin);
        let top = (low.1 as i64).saturating_sub(margin).max(-margin);
        let right = (high.0 as i64).saturating_add(margin).min(wide);
        let bottom = (high.1 as i64).saturating_add(margin).min(tall);
        (left < right && top < bottom).then(|| {
            let (width, height) = ((right - left) as usize, (bottom - top) as usize);
            Patch { left, top, width, height, dark: vec![0.0; width * height] }
        })
    }

    fn add(&mut self, patch: &Patch) {
        for y in 0..patch.height {
            for x in 0..patch.width {
                let (mx, my) = (patch.left + x as i64, patch.top + y as i64);
                if (0..self.width as i64).contains(&mx) && (0..self.height as i64).contains(&my) {
                    let darkness = &mut self.dark[my as usize * self.width + mx as usize];
                    *darkness = 1.0 - (1.0 - *darkness) * (1.0 - patch.dark[y * patch.width + x]);
                }
            }
        }
    }
}

impl Patch {
    fn darken(&mut self, x: i64, y: i64, dark: f32) {
        if (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y) {
            let at = &mut self.dark[y as usize * self.width + x as usize];
            *at = at.max(dark);
        }
    }

    fn fill(&mut self, points: &[ShadowPoint], triangles: &[[u32; 3]], vertex_radius: f32) {
        let to_patch = |point: &ShadowPoint| ShadowPoint {
            x: point.x - self.left as f32,
            y: point.y - self.top as f32,
            dark: point.dark,
        };
        let points: Vec<ShadowPoint> = points.iter().map(to_patch).collect();
        // vertices are filled as well, because a small triangle may cover no texel centre
        for point in &points {
            for y in (point.y - vertex_radius) as i64..=(point.y + vertex_radius) as i64 {
                for x in (point.x - vertex_radius) as i64..=(point.x + vertex_radius) as i64 {
                    let (dx, dy) = (x as f32 + 0.5 - point.x, y as f32 + 0.5 - point.y);
                    if dx * dx + dy * dy <= (vertex_radius * vertex_radius).max(0.5) {
                        self.darken(x, y, point.dark);
                    }
                }
            }
        }
        for triangle in triangles {
            self.fill_triangle(triangle.map(|i| points[i as usize]));
        }
    }

    fn fill_triangle(&mut self, [a, b, c]: [ShadowPoint; 3]) {
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let clip = |value: f32, max: usize| value.clamp(0.0, max as f32) as i64;
        let (x0, x1) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (y0, y1) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        for y in clip(y0, self.height)..=clip(y1, self.height) {
            for x in clip(x0, self.width)..=clip(x1, self.width) {
                let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
                let u = ((c.x - b.x) * (py - b.y) - (c.y - b.y) * (px - b.x)) / area;
                let v = ((a.x - c.x) * (py - c.y) - (a.y - c.y) * (px - c.x)) / area;
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    self.darken(x, y, u * a.dark + v * b.dark + w * c.dark);
                }
            }
        }
    }

    /// Approximates a Gaussian blur by three box filters along each axis.
    fn blur(&mut self, radius: usize) {
        let (width, height) = (self.width, self.height);
        let mut line = Vec::new();
        for _ in 0..3 {
            for y in 0..height {
                running_mean(&mut self.dark, y * width, 1, width, radius, &mut line);
            }
            for x in 0..width {
                running_mean(&mut self.dark, x, width, height, radius, &mut line);
            }
        }
    }
}

/// Replaces `count` values by their running mean over `2 * radius + 1` values. `line` is a scratch buffer.
fn running_mean(
    values: &mut [f32],
    start: usize,
    stride: usize,
    count: usize,
    radius: usize,
    line: &mut Vec<f32>,
) {
    line.clear();
    line.extend((0..count).map(|i| values[start + i * stride]));
    let mut sum: f32 = line.iter().take(radius).sum();
    for i in 0..count {
        sum += line.get(i + radius).copied().unwrap_or(0.0);
        if i > radius {
            sum -= line[i - radius - 1];
        }
        values[start + i * stride] = (sum / (2 * radius + 1) as f32).max(0.0);
    }
}
