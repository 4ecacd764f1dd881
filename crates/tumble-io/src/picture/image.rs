//! Pixel images and PNG output.

/// An RGB image with 8 bits per channel, rows from top to bottom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green and blue of each pixel: 3 · `width` · `height` bytes.
    pub pixels: Vec<u8>,
}

/// Error from encoding a picture as PNG.
#[derive(Debug)]
pub struct PictureError(png::EncodingError);

impl std::fmt::Display for PictureError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cannot encode the picture as PNG: {}", self.0)
    }
}

impl std::error::Error for PictureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.0)
    }
}

/// Encodes an image as a PNG file.
///
/// # Errors
/// [`PictureError`] if the length of `pixels` does not match the width and height.
pub fn encode_png(image: &Image) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width, image.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().map_err(PictureError)?;
    writer.write_image_data(&image.pixels).map_err(PictureError)?;
    writer.finish().map_err(PictureError)?;
    Ok(bytes)
}

impl Image {
    /// The colour of a pixel, or `None` outside the image.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 3 * (y as usize * self.width as usize + x as usize);
        self.pixels.get(at..at + 3).and_then(|rgb| rgb.try_into().ok())
    }

    /// Blends a colour over a pixel. Does nothing outside the image.
    pub(super) fn blend(&mut self, x: i32, y: i32, colour: [u8; 3], alpha: f32) {
        if x < 0 || y < 0 || x >= self.width as i32 || y >= self.height as i32 {
            return;
        }
        let at = 3 * (y as usize * self.width as usize + x as usize);
        for (below, above) in self.pixels[at..at + 3].iter_mut().zip(colour) {
            let mixed = f32::from(*below) + (f32::from(above) - f32::from(*below)) * alpha;
            *below = (mixed + 0.5) as u8;
        }
    }

    /// Fills a rectangle with slightly rounded corners.
    pub(super) fn fill_rectangle(
        &mut self,
        left: i32,
        top: i32,
        size: (i32, i32),
        colour: [u8; 3],
    ) {
        for y in 0..size.1 {
            for x in 0..size.0 {
                let corner = (x == 0 || x == size.0 - 1) && (y == 0 || y == size.1 - 1);
                self.blend(left + x, top + y, colour, if corner { 0.4 } else { 1.0 });
            }
        }
    }

    /// Draws an antialiased line over the image.
    pub(super) fn draw_line(&mut self, a: (f32, f32), b: (f32, f32), width: f32, colour: [u8; 3]) {
        let (x0, x1) = (a.0.min(b.0) - width - 1.0, a.0.max(b.0) + width + 1.0);
        let (y0, y1) = (a.1.min(b.1) - width - 1.0, a.1.max(b.1) + width + 1.0);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length = (dx * dx + dy * dy).max(1e-6);
        for y in y0.max(0.0) as i32..=y1.min(self.height as f32) as i32 {
            for x in x0.max(0.0) as i32..=x1.min(self.width as f32) as i32 {
                let (px, py) = (x as f32 + 0.5 - a.0, y as f32 + 0.5 - a.1);
                let along = ((px * dx + py * dy) / length).clamp(0.0, 1.0);
                let (ex, ey) = (px - along * dx, py - along * dy);
                let cover = 0.5 + 0.5 * width - (ex * ex + ey * ey).sqrt();
                if cover > 0.0 {
                    self.blend(x, y, colour, cover.min(1.0));
                }
            }
        }
    }
}
