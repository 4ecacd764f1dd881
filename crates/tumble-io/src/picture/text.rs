//! Text in a built-in bitmap font, and formatting of numbers.

use super::image::Image;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Dark grey for text.
pub(super) const TEXT_COLOUR: [u8; 3] = [45, 52, 62];
/// Lighter grey for secondary text.
pub(super) const SECONDARY_TEXT_COLOUR: [u8; 3] = [104, 113, 126];

/// Size and weight of a font.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font {
    size: RasterHeight,
    weight: FontWeight,
}

impl Font {
    /// The largest font of at most this height in pixels, or the smallest one (16 pixels).
    pub fn from_height(height: f64, bold: bool) -> Self {
        let size = match height {
            h if h >= 32.0 => RasterHeight::Size32,
            h if h >= 24.0 => RasterHeight::Size24,
            h if h >= 20.0 => RasterHeight::Size20,
            _ => RasterHeight::Size16,
        };
        Self { size, weight: if bold { FontWeight::Bold } else { FontWeight::Regular } }
    }

    /// Line height in pixels.
    pub fn height(self) -> i32 {
        self.size.val() as i32
    }

    /// Width of a string in pixels.
    pub fn width(self, text: &str) -> i32 {
        (text.chars().count() * get_raster_width(self.weight, self.size)) as i32
    }

    /// The string, shortened with two dots if it is wider than `width` pixels.
    pub fn truncate(self, text: &str, width: i32) -> String {
        let max_chars = (width.max(0) as usize) / get_raster_width(self.weight, self.size).max(1);
        if text.chars().count() <= max_chars {
            return text.to_owned();
        }
        if max_chars < 4 {
            return String::new();
        }
        text.chars().take(max_chars - 2).chain("..".chars()).collect()
    }

    /// Draws a string with its upper left corner at a pixel.
    pub fn draw(self, image: &mut Image, at: (i32, i32), text: &str, colour: [u8; 3]) {
        let mut x = at.0;
        for character in text.chars() {
            let character = substitute(character);
            let raster = get_raster(character, self.weight, self.size)
                .or_else(|| get_raster('?', self.weight, self.size));
            let Some(raster) = raster else { continue };
            for (dy, row) in (0..).zip(raster.rows()) {
                for (dx, &cover) in (0..).zip(row) {
                    if cover > 0 {
                        image.blend(x + dx, at.1 + dy, colour, f32::from(cover) / 255.0);
                    }
                }
            }
            x += raster.width() as i32;
        }
    }

    /// Draws a string with a light outline, legible on any background.
    pub fn draw_with_outline(self, image: &mut Image, at: (i32, i32), text: &str, colour: [u8; 3]) {
        for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, 1), (-1, 1), (1, -1)] {
            self.draw(image, (at.0 + dx, at.1 + dy), text, [250, 251, 252]);
        }
        self.draw(image, at, text, colour);
    }
}

/// Replaces a character that the font lacks by a similar one.
fn substitute(character: char) -> char {
    match character {
        '\u{2010}'..='\u{2015}' | '\u{2212}' => '-',
        '\u{2018}' | '\u{2019}' => '\'',
        '\u{201c}' | '\u{201d}' => '"',
        '\u{03bc}' => 'µ',
        '\u{2026}' => '.',
        _ if character.is_control() || character.is_whitespace() => ' ',
        _ => character,
    }
}

/// Formats a length with an SI unit of suitable size: "0.5 m", "20 µm".
pub(super) fn format_length(metres: f64) -> String {
    let units = [(1e3, "km"), (1.0, "m"), (1e-2, "cm"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")];
    for (size, name) in units {
        let value = metres / size;
        if (0.999..999.5).contains(&value) || (size == 1.0 && (0.0999..1.0).contains(&value)) {
            return format!("{} {name}", (value * 1e3).round() / 1e3);
        }
    }
    format!("{metres:e} m")
}

/// Formats a time with enough decimals to distinguish times that are `step` seconds apart.
pub(super) fn format_time(seconds: f64, step: f64) -> String {
    if seconds != 0.0 && !(1e-3..1e6).contains(&seconds.abs()) {
        return format!("{seconds:.2e} s");
    }
    let decimals = if step > 0.0 { (1.0 - step.log10().floor()).clamp(1.0, 6.0) } else { 1.0 };
    format!("{seconds:.*} s", decimals as usize)
}

/// The largest of 1, 2 or 5 times a power of ten that is not above `value` (a "nice number",
/// Heckbert 1990). Returns 1 for values that are not positive and finite.
pub(super) fn nice_number(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(value.log10().floor() as i32);
    let digit = value / power;
    let digit = [5.0, 2.0].into_iter().find(|&d| digit >= d * 0.999_999).unwrap_or(1.0);
    digit * power
}
