//! Soft shadows on a flat surface: dark where a body touches, faint and wide below a high one.

use super::camera::Camera;
use super::figure::Figure;
use super::{Pose, surface::Surface};
use glam::DVec3;

/// Texels along the longer side of a surface.
const TEXELS: f64 = 640.0;
/// A shadow is blurred over at most this many texels.
const MOST_BLUR: f64 = 36.0;
/// The shadow of a lone vertex is at most so many texels in radius.
const MOST_BALL: f32 = 60.0;

/// How much of the light is taken away, over a rectangle of a surface.
#[derive(Clone, Debug)]
pub(super) struct ShadowMap {
    width: usize,
    height: usize,
    /// Metres a texel.
    texel: f64,
    dark: Vec<f32>,
}

/// The shadow of one body on its own part of the map.
struct Patch {
    left: i64,
    top: i64,
    width: usize,
    height: usize,
    dark: Vec<f32>,
}

/// A vertex on the surface: texels from the map's corner, and how dark its shadow is.
#[derive(Clone, Copy)]
struct Foot {
    x: f32,
    y: f32,
    dark: f32,
}

impl ShadowMap {
    /// An empty map over a rectangle with these half sides (m).
    pub fn new(half: [f64; 2]) -> Self {
        let texel = (2.0 * half[0].max(half[1]) / TEXELS).max(1e-90);
        let count = |side: f64| ((2.0 * side / texel).ceil() as usize).clamp(1, 2048);
        let (width, height) = (count(half[0]), count(half[1]));
        Self { width, height, texel, dark: vec![0.0; width * height] }
    }

    /// The darkness at a place, in metres from the map's corner.
    pub fn at(&self, u: f64, v: f64) -> f32 {
        let (x, y) = ((u / self.texel - 0.5).max(0.0), (v / self.texel - 0.5).max(0.0));
        let (left, top) = ((x as usize).min(self.width - 1), (y as usize).min(self.height - 1));
        let (fx, fy) = ((x - left as f64).min(1.0) as f32, (y - top as f64).min(1.0) as f32);
        let (right, low) = ((left + 1).min(self.width - 1), (top + 1).min(self.height - 1));
        let get = |x: usize, y: usize| self.dark[y * self.width + x];
        let upper = get(left, top) * (1.0 - fx) + get(right, top) * fx;
        let lower = get(left, low) * (1.0 - fx) + get(right, low) * fx;
        upper * (1.0 - fy) + lower * fy
    }

    /// Adds the shadow of a body that light from straight above throws on the surface.
    pub fn cast(
        &mut self,
        surface: &Surface,
        up: DVec3,
        camera: &Camera,
        figure: &Figure,
        pose: &Pose,
        weight: f32,
    ) {
        let slope = surface.normal.dot(up);
        let size = figure.radius.max(4.0 * camera.pixel_length());
        let lowest = std::cell::Cell::new(f64::MAX);
        let fall = |point: &DVec3| {
            let point = pose.position + pose.orientation * *point;
            let height = (point - surface.origin).dot(surface.normal);
            lowest.set(lowest.get().min(height));
            let foot = point - up * (height / slope) - surface.origin;
            let far = (height / (2.2 * size)).max(0.0);
            Foot {
                x: ((foot.dot(surface.u) + surface.half[0]) / self.texel) as f32,
                y: ((foot.dot(surface.v) + surface.half[1]) / self.texel) as f32,
                dark: weight / (1.0 + far * far) as f32,
            }
        };
        let feet: Vec<Foot> = figure.points.iter().map(fall).collect();
        let lowest = lowest.get();
        // nothing is thrown by what lies under the surface or is too high to matter
        if !(-size..40.0 * size).contains(&lowest) {
            return;
        }
        let blur = ((0.05 * size + 0.22 * lowest.max(0.0)) / self.texel).clamp(1.0, MOST_BLUR);
        let ball =
            (figure.ball.max(4.0 * camera.pixel_length() - figure.radius) / self.texel) as f32;
        let ball = if figure.triangles.is_empty() { ball.min(MOST_BALL) } else { 0.0 };
        if let Some(mut patch) = self.patch(&feet, blur + f64::from(ball)) {
            patch.fill(&feet, &figure.triangles, ball);
            patch.blur(blur as usize);
            self.lay(&patch);
        }
    }

    /// The part of the map that a shadow can reach.
    fn patch(&self, feet: &[Foot], margin: f64) -> Option<Patch> {
        let (mut low, mut high) = ((f32::MAX, f32::MAX), (f32::MIN, f32::MIN));
        for foot in feet {
            low = (low.0.min(foot.x), low.1.min(foot.y));
            high = (high.0.max(foot.x), high.1.max(foot.y));
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

    fn lay(&mut self, patch: &Patch) {
        for y in 0..patch.height {
            for x in 0..patch.width {
                let (mx, my) = (patch.left + x as i64, patch.top + y as i64);
                if (0..self.width as i64).contains(&mx) && (0..self.height as i64).contains(&my) {
                    let light = &mut self.dark[my as usize * self.width + mx as usize];
                    *light = 1.0 - (1.0 - *light) * (1.0 - patch.dark[y * patch.width + x]);
                }
            }
        }
    }
}

impl Patch {
    fn deepen(&mut self, x: i64, y: i64, dark: f32) {
        if (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y) {
            let at = &mut self.dark[y as usize * self.width + x as usize];
            *at = at.max(dark);
        }
    }

    fn fill(&mut self, feet: &[Foot], triangles: &[[u32; 3]], ball: f32) {
        let moved = |foot: &Foot| Foot {
            x: foot.x - self.left as f32,
            y: foot.y - self.top as f32,
            dark: foot.dark,
        };
        let feet: Vec<Foot> = feet.iter().map(moved).collect();
        // the vertices themselves, for triangles that fall between texels
        for foot in &feet {
            for y in (foot.y - ball) as i64..=(foot.y + ball) as i64 {
                for x in (foot.x - ball) as i64..=(foot.x + ball) as i64 {
                    let (dx, dy) = (x as f32 + 0.5 - foot.x, y as f32 + 0.5 - foot.y);
                    if dx * dx + dy * dy <= (ball * ball).max(0.5) {
                        self.deepen(x, y, foot.dark);
                    }
                }
            }
        }
        for triangle in triangles {
            self.triangle(triangle.map(|i| feet[i as usize]));
        }
    }

    fn triangle(&mut self, [a, b, c]: [Foot; 3]) {
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let clip = |value: f32, most: usize| value.clamp(0.0, most as f32) as i64;
        let (x0, x1) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (y0, y1) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        for y in clip(y0, self.height)..=clip(y1, self.height) {
            for x in clip(x0, self.width)..=clip(x1, self.width) {
                let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
                let u = ((c.x - b.x) * (py - b.y) - (c.y - b.y) * (px - b.x)) / area;
                let v = ((a.x - c.x) * (py - c.y) - (a.y - c.y) * (px - c.x)) / area;
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    self.deepen(x, y, u * a.dark + v * b.dark + w * c.dark);
                }
            }
        }
    }

    /// Three running means each way come close to a bell curve.
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
