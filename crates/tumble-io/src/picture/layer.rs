//! Rasterisation of triangles, spheres and lines with a depth buffer.

use super::camera::ProjectedPoint;

/// A rectangle of the picture with colour and depth at each pixel.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub left: i32,
    pub top: i32,
    pub width: i32,
    pub height: i32,
    /// Inverse depth; 0 where nothing is drawn.
    inverse_depth: Vec<f32>,
    rgba: Vec<[u8; 4]>,
}

impl Layer {
    /// An empty layer that covers the pixels from `low` (inclusive) to `high` (exclusive).
    pub fn new(low: (i32, i32), high: (i32, i32)) -> Self {
        let (width, height) = ((high.0 - low.0).max(0), (high.1 - low.1).max(0));
        let count = width as usize * height as usize;
        Self {
            left: low.0,
            top: low.1,
            width,
            height,
            inverse_depth: vec![0.0; count],
            rgba: vec![[0; 4]; count],
        }
    }

    /// Erases everything drawn.
    pub fn clear(&mut self) {
        self.inverse_depth.fill(0.0);
        self.rgba.fill([0; 4]);
    }

    pub fn contains_row(&self, y: i32) -> bool {
        y >= self.top && y < self.top + self.height
    }

    pub fn contains_column(&self, x: i32) -> bool {
        x >= self.left && x < self.left + self.width
    }

    fn index(&self, x: i32, y: i32) -> usize {
        (y - self.top) as usize * self.width as usize + (x - self.left) as usize
    }

    /// Inverse depth and colour of a pixel, which must lie within the layer.
    pub fn pixel(&self, x: i32, y: i32) -> (f32, [u8; 4]) {
        let index = self.index(x, y);
        (self.inverse_depth[index], self.rgba[index])
    }

    /// Writes a pixel if it passes the depth test. The colour is computed only then, and discarded if it is fully transparent.
    pub fn write(&mut self, x: i32, y: i32, inverse_depth: f32, colour: impl FnOnce() -> [u8; 4]) {
        let index = self.index(x, y);
        if inverse_depth > self.inverse_depth[index] {
            let colour = colour();
            if colour[3] > 0 {
                self.inverse_depth[index] = inverse_depth;
                self.rgba[index] = colour;
            }
        }
    }

    /// The pixels of a rectangle that lie within the layer: left, top, right and bottom, all inclusive.
    fn clip(&self, low: (f32, f32), high: (f32, f32)) -> Option<[i32; 4]> {
        // samples lie at pixel centres
        let x0 = ((low.0 - 0.5).ceil() as i32).max(self.left);
        let y0 = ((low.1 - 0.5).ceil() as i32).max(self.top);
        let x1 = ((high.0 - 0.5).floor() as i32).min(self.left + self.width - 1);
        let y1 = ((high.1 - 0.5).floor() as i32).min(self.top + self.height - 1);
        (x0 <= x1 && y0 <= y1).then_some([x0, y0, x1, y1])
    }

    /// Draws a triangle. `colour` takes the barycentric weights of the corners.
    pub fn draw_triangle(
        &mut self,
        corners: [ProjectedPoint; 3],
        colour: impl Fn([f32; 3]) -> [u8; 4],
    ) {
        let [a, b, c] = corners;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        let low = (a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y));
        let high = (a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y));
        let Some([x0, y0, x1, y1]) = self.clip(low, high) else { return };
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let scale = 1.0 / area;
        for y in y0..=y1 {
            for x in x0..=x1 {
                let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
                let u = ((c.x - b.x) * (py - b.y) - (c.y - b.y) * (px - b.x)) * scale;
                let v = ((a.x - c.x) * (py - c.y) - (a.y - c.y) * (px - c.x)) * scale;
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    // inverse depth is linear in screen space, depth is not
                    let inverse_depth =
                        u * a.inverse_depth + v * b.inverse_depth + w * c.inverse_depth;
                    self.write(x, y, inverse_depth, || colour([u, v, w]));
                }
            }
        }
    }

    /// Draws a sphere with a radius in pixels. `relative_radius` is its radius in units of the
    /// scene size. `colour` takes the normal in the view frame: right, up, towards the viewer.
    pub fn draw_sphere(
        &mut self,
        centre: ProjectedPoint,
        radius: f32,
        relative_radius: f32,
        colour: impl Fn([f32; 3]) -> [u8; 4],
    ) {
        let low = (centre.x - radius, centre.y - radius);
        let high = (centre.x + radius, centre.y + radius);
        let Some([x0, y0, x1, y1]) = self.clip(low, high) else { return };
        for y in y0..=y1 {
            for x in x0..=x1 {
                let nx = (x as f32 + 0.5 - centre.x) / radius;
                let ny = (centre.y - y as f32 - 0.5) / radius;
                let nz_squared = 1.0 - nx * nx - ny * ny;
                if nz_squared >= 0.0 {
                    let nz = nz_squared.sqrt();
                    let inverse_depth = centre.inverse_depth
                        / (1.0 - relative_radius * nz * centre.inverse_depth).max(0.1);
                    self.write(x, y, inverse_depth, || colour([nx, ny, nz]));
                }
            }
        }
    }

    /// Draws a line with round ends and a width in pixels.
    pub fn draw_line(&mut self, a: ProjectedPoint, b: ProjectedPoint, width: f32, colour: [u8; 4]) {
        // short segments have small bounding boxes, so few pixels far from the line are tested
        let length = (b.x - a.x).abs().max((b.y - a.y).abs());
        let segments = ((length / 24.0).ceil() as i32).clamp(1, 8192);
        let interpolate = |t: f32| ProjectedPoint {
            x: a.x + (b.x - a.x) * t,
            y: a.y + (b.y - a.y) * t,
            inverse_depth: a.inverse_depth + (b.inverse_depth - a.inverse_depth) * t,
        };
        for segment in 0..segments {
            let start = interpolate(segment as f32 / segments as f32);
            let end = interpolate((segment + 1) as f32 / segments as f32);
            self.draw_segment(start, end, 0.5 * width, colour);
        }
    }

    fn draw_segment(&mut self, a: ProjectedPoint, b: ProjectedPoint, radius: f32, colour: [u8; 4]) {
        let low = (a.x.min(b.x) - radius, a.y.min(b.y) - radius);
        let high = (a.x.max(b.x) + radius, a.y.max(b.y) + radius);
        let Some([x0, y0, x1, y1]) = self.clip(low, high) else { return };
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let scale = 1.0 / (dx * dx + dy * dy).max(1e-12);
        for y in y0..=y1 {
            for x in x0..=x1 {
                let (px, py) = (x as f32 + 0.5 - a.x, y as f32 + 0.5 - a.y);
                let t = ((px * dx + py * dy) * scale).clamp(0.0, 1.0);
                let (ex, ey) = (px - t * dx, py - t * dy);
                if ex * ex + ey * ey <= radius * radius {
                    let inverse_depth = a.inverse_depth + (b.inverse_depth - a.inverse_depth) * t;
                    self.write(x, y, inverse_depth, || colour);
                }
            }
        }
    }
}
