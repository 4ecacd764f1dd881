//! Words on a picture, in a font that comes with the program.

use super::image::Image;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Dark grey for words.
pub(super) const INK: [u8; 3] = [45, 52, 62];
/// Lighter grey for words that matter less.
pub(super) const FAINT: [u8; 3] = [104, 113, 126];

/// A size and weight of the font.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font {
    size: RasterHeight,
    weight: FontWeight,
}

impl Font {
    /// The largest font of at most this height in pixels; 16 is the smallest there is.
    pub fn fitting(height: f64, bold: bool) -> Self {
        let size = match height {
            h if h >= 32.0 => RasterHeight::Size32,
            h if h >= 24.0 => RasterHeight::Size24,
            h if h >= 20.0 => RasterHeight::Size20,
            _ => RasterHeight::Size16,
        };
        Self { size, weight: if bold { FontWeight::Bold } else { FontWeight::Regular } }
    }

    /// Height of a line in pixels.
    pub fn height(self) -> i32 {
        self.size.val() as i32
    }

    /// Width of a text in pixels.
    pub fn width(self, text: &str) -> i32 {
        (text.chars().count() * get_raster_width(self.weight, self.size)) as i32
    }

    /// The text, cut with an ellipsis where it is wider than this.
    pub fn fit(self, text: &str, width: i32) -> String {
        let most = (width.max(0) as usize) / get_raster_width(self.weight, self.size).max(1);
        if text.chars().count() <= most {
            return text.to_owned();
        }
        if most < 4 {
            return String::new();
        }
        text.chars().take(most - 2).chain("..".chars()).collect()
    }

    /// Writes with the upper left corner of the first letter at a pixel.
    pub fn write(self, image: &mut Image, at: (i32, i32), text: &str, colour: [u8; 3]) {
        let mut x = at.0;
        for letter in text.chars() {
            let letter = replaced(letter);
            let raster = get_raster(letter, self.weight, self.size)
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

    /// Writes with a soft light edge, to be read on any ground.
    pub fn write_with_halo(self, image: &mut Image, at: (i32, i32), text: &str, colour: [u8; 3]) {
        for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, 1), (-1, 1), (1, -1)] {
            self.write(image, (at.0 + dx, at.1 + dy), text, [250, 251, 252]);
        }
        self.write(image, at, text, colour);
    }
}

/// A letter that the font has in place of one that it has not.
fn replaced(letter: char) -> char {
    match letter {
        '\u{2010}'..='\u{2015}' | '\u{2212}' => '-',
        '\u{2018}' | '\u{2019}' => '\'',
        '\u{201c}' | '\u{201d}' => '"',
        '\u{03bc}' => 'µ',
        '\u{2026}' => '.',
        _ if letter.is_control() || letter.is_whitespace() => ' ',
        _ => letter,
    }
}

/// A length in metres with a fitting unit: "0.5 m", "20 µm".
pub(super) fn length(metres: f64) -> String {
    let units = [(1e3, "km"), (1.0, "m"), (1e-2, "cm"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")];
    for (size, name) in units {
        let value = metres / size;
        if (0.999..999.5).contains(&value) || (size == 1.0 && (0.0999..1.0).contains(&value)) {
            return format!("{} {name}", (value * 1e3).round() / 1e3);
        }
    }
    format!("{metres:e} m")
}

/// A time in seconds, written so that steps of `step` seconds can be told apart.
pub(super) fn time(seconds: f64, step: f64) -> String {
    if seconds != 0.0 && !(1e-3..1e6).contains(&seconds.abs()) {
        return format!("{seconds:.2e} s");
    }
    let decimals = if step > 0.0 { (1.0 - step.log10().floor()).clamp(1.0, 6.0) } else { 1.0 };
    format!("{seconds:.*} s", decimals as usize)
}

/// The nearest round number below: 1, 2 or 5 times a power of ten.
pub(super) fn round_number(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(value.log10().floor() as i32);
    let digit = value / power;
    let digit = [5.0, 2.0].into_iter().find(|&d| digit >= d * 0.999_999).unwrap_or(1.0);
    digit * power
}
