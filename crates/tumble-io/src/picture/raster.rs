//! Triangles, balls and lines into layers of pixels that know how near they are.

use super::camera::Projected;

/// A rectangle of the picture with the nearest thing seen at each pixel.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub left: i32,
    pub top: i32,
    pub width: i32,
    pub height: i32,
    /// One over the depth; 0 where nothing was drawn.
    nearness: Vec<f32>,
    rgba: Vec<[u8; 4]>,
}

impl Layer {
    /// An empty layer over the pixels from `low` up to but without `high`.
    pub fn new(low: (i32, i32), high: (i32, i32)) -> Self {
        let (width, height) = ((high.0 - low.0).max(0), (high.1 - low.1).max(0));
        let count = width as usize * height as usize;
        Self {
            left: low.0,
            top: low.1,
            width,
            height,
            nearness: vec![0.0; count],
            rgba: vec![[0; 4]; count],
        }
    }

    /// Takes everything away.
    pub fn clear(&mut self) {
        self.nearness.fill(0.0);
        self.rgba.fill([0; 4]);
    }

    pub fn has_row(&self, y: i32) -> bool {
        y >= self.top && y < self.top + self.height
    }

    pub fn has_column(&self, x: i32) -> bool {
        x >= self.left && x < self.left + self.width
    }

    fn index(&self, x: i32, y: i32) -> usize {
        (y - self.top) as usize * self.width as usize + (x - self.left) as usize
    }

    /// What was drawn at a pixel: nearness and colour. The pixel must lie within the layer.
    pub fn at(&self, x: i32, y: i32) -> (f32, [u8; 4]) {
        let index = self.index(x, y);
        (self.nearness[index], self.rgba[index])
    }

    /// Draws a pixel unless something nearer is there; the colour is asked for only if needed.
    pub fn put(&mut self, x: i32, y: i32, nearness: f32, colour: impl FnOnce() -> [u8; 4]) {
        let index = self.index(x, y);
        if nearness > self.nearness[index] {
            let colour = colour();
            if colour[3] > 0 {
                self.nearness[index] = nearness;
                self.rgba[index] = colour;
            }
        }
    }

    /// The part of a span of pixels that lies within the layer, per axis.
    fn span(&self, low: (f32, f32), high: (f32, f32)) -> Option<[i32; 4]> {
        // a pixel is hit at its middle
        let x0 = ((low.0 - 0.5).ceil() as i32).max(self.left);
        let y0 = ((low.1 - 0.5).ceil() as i32).max(self.top);
        let x1 = ((high.0 - 0.5).floor() as i32).min(self.left + self.width - 1);
        let y1 = ((high.1 - 0.5).floor() as i32).min(self.top + self.height - 1);
        (x0 <= x1 && y0 <= y1).then_some([x0, y0, x1, y1])
    }

    /// Draws a triangle; `colour` gets the weights of the three corners.
    pub fn triangle(&mut self, corners: [Projected; 3], colour: impl Fn([f32; 3]) -> [u8; 4]) {
        let [a, b, c] = corners;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        let low = (a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y));
        let high = (a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y));
        let Some([x0, y0, x1, y1]) = self.span(low, high) else { return };
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
                    // one over the depth is linear in the picture, the depth is not
                    let near = u * a.nearness + v * b.nearness + w * c.nearness;
                    self.put(x, y, near, || colour([u, v, w]));
                }
            }
        }
    }

    /// Draws a ball of a radius in pixels; `bulge` is its radius over the scene's size, and
    /// `colour` gets the normal: right, up, to the viewer.
    pub fn ball(
        &mut self,
        centre: Projected,
        radius: f32,
        bulge: f32,
        colour: impl Fn([f32; 3]) -> [u8; 4],
    ) {
        let low = (centre.x - radius, centre.y - radius);
        let high = (centre.x + radius, centre.y + radius);
        let Some([x0, y0, x1, y1]) = self.span(low, high) else { return };
        for y in y0..=y1 {
            for x in x0..=x1 {
                let nx = (x as f32 + 0.5 - centre.x) / radius;
                let ny = (centre.y - y as f32 - 0.5) / radius;
                let rest = 1.0 - nx * nx - ny * ny;
                if rest >= 0.0 {
                    let nz = rest.sqrt();
                    let near = centre.nearness / (1.0 - bulge * nz * centre.nearness).max(0.1);
                    self.put(x, y, near, || colour([nx, ny, nz]));
                }
            }
        }
    }

    /// Draws a line with round ends, of a width in pixels.
    pub fn line(&mut self, a: Projected, b: Projected, width: f32, colour: [u8; 4]) {
        // in short pieces, so that the pixels looked at are those near the line
        let length = (b.x - a.x).abs().max((b.y - a.y).abs());
        let pieces = ((length / 24.0).ceil() as i32).clamp(1, 8192);
        let mix = |t: f32| Projected {
            x: a.x + (b.x - a.x) * t,
            y: a.y + (b.y - a.y) * t,
            nearness: a.nearness + (b.nearness - a.nearness) * t,
        };
        for piece in 0..pieces {
            let start = mix(piece as f32 / pieces as f32);
            let end = mix((piece + 1) as f32 / pieces as f32);
            self.short_line(start, end, 0.5 * width, colour);
        }
    }

    fn short_line(&mut self, a: Projected, b: Projected, radius: f32, colour: [u8; 4]) {
        let low = (a.x.min(b.x) - radius, a.y.min(b.y) - radius);
        let high = (a.x.max(b.x) + radius, a.y.max(b.y) + radius);
        let Some([x0, y0, x1, y1]) = self.span(low, high) else { return };
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let scale = 1.0 / (dx * dx + dy * dy).max(1e-12);
        for y in y0..=y1 {
            for x in x0..=x1 {
                let (px, py) = (x as f32 + 0.5 - a.x, y as f32 + 0.5 - a.y);
                let t = ((px * dx + py * dy) * scale).clamp(0.0, 1.0);
                let (ex, ey) = (px - t * dx, py - t * dy);
                if ex * ex + ey * ey <= radius * radius {
                    let near = a.nearness + (b.nearness - a.nearness) * t;
                    self.put(x, y, near, || colour);
                }
            }
        }
    }
}
