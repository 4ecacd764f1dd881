//! What can be asked for, and whether it makes sense.

use std::path::Path;

use super::ExportError;
use crate::picture::{DEFAULT_SIZE, View};

/// A format, named by the ending of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary glTF 2.0.
    Glb,
    /// USD as text.
    Usda,
    /// A VTK collection.
    Pvd,
    /// Rows as in `trajectory.csv`.
    Csv,
    /// One picture.
    Png,
    /// An animated picture.
    Gif,
    /// A film.
    Mp4,
}

/// Sides of pictures, in pixels, and how many pixels there may be.
const SIDES: std::ops::RangeInclusive<u32> = 16..=8192;
const MOST_PIXELS: u64 = 1 << 24;
/// No more frames than this a second.
const MOST_FPS: f64 = 1e6;

impl Format {
    /// All formats with their endings.
    pub const ALL: [(&'static str, Self); 7] = [
        ("glb", Self::Glb),
        ("usda", Self::Usda),
        ("pvd", Self::Pvd),
        ("csv", Self::Csv),
        ("png", Self::Png),
        ("gif", Self::Gif),
        ("mp4", Self::Mp4),
    ];

    /// The format that the ending of `path` names, in small or capital letters.
    ///
    /// # Errors
    /// [`ExportError::Ending`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, ExportError> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let found = Self::ALL.iter().find(|(own, _)| ending.as_deref() == Some(*own));
        found.map(|found| found.1).ok_or_else(|| ExportError::Ending(path.to_owned()))
    }

    /// Whether it is made of pictures.
    pub fn is_drawn(self) -> bool {
        matches!(self, Self::Png | Self::Gif | Self::Mp4)
    }

    /// Whether it runs by itself, so that its frames come at an even rate.
    pub(super) fn is_film(self) -> bool {
        matches!(self, Self::Gif | Self::Mp4)
    }
}

/// What a caller may ask for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExportOptions {
    /// Frames for each simulated second; `None`: every recorded one, but 30 in films.
    pub fps: Option<f64>,
    /// Width and height of pictures in pixels.
    pub size: Option<(u32, u32)>,
    /// Leave out frames before this time (s).
    pub from: Option<f64>,
    /// Leave out frames after this time (s).
    pub to_time: Option<f64>,
    /// Where pictures are seen from; `None`: where the motion spreads out the most.
    pub view: Option<View>,
    /// A picture of this moment (s) instead of the whole motion.
    pub at: Option<f64>,
    /// Write over a file that is there.
    pub force: bool,
}

impl ExportOptions {
    /// The size of pictures: that asked for, or the usual one of the format.
    pub(super) fn picture_size(&self, format: Format) -> (u32, u32) {
        let usual = match format {
            Format::Gif => (800, 500),
            Format::Mp4 => (1280, 800),
            _ => DEFAULT_SIZE,
        };
        self.size.unwrap_or(usual)
    }

    pub(super) fn check(&self, format: Format) -> Result<(), ExportError> {
        let wrong = |what: String| Err(ExportError::Option(what));
        if let Some(fps) = self.fps
            && !(fps > 0.0 && fps <= MOST_FPS)
        {
            return wrong(format!("--fps must be above 0 and at most {MOST_FPS}, not {fps}"));
        }
        if let Some((width, height)) = self.size {
            let pixels = u64::from(width) * u64::from(height);
            if !SIDES.contains(&width) || !SIDES.contains(&height) || pixels > MOST_PIXELS {
                return wrong(format!(
                    "--size must have sides from {} to {} pixels and at most {MOST_PIXELS} pixels \
                     in all, not {width}x{height}",
                    SIDES.start(),
                    SIDES.end(),
                ));
            }
        }
        let times = [("--from", self.from), ("--to-time", self.to_time), ("--at", self.at)];
        for (name, time) in times {
            if time.is_some_and(|time| !time.is_finite()) {
                return wrong(format!("{name} must be a time in seconds"));
            }
        }
        if let (Some(from), Some(to)) = (self.from, self.to_time)
            && from > to
        {
            return wrong(format!("--from {from} is after --to-time {to}"));
        }
        if let Some(View { yaw, pitch, zoom }) = self.view {
            let quarter = std::f64::consts::FRAC_PI_2;
            let is_view =
                yaw.is_finite() && pitch.abs() <= quarter && (0.01..=100.0).contains(&zoom);
            if !is_view {
                return wrong(
                    "--camera must be yaw,pitch or yaw,pitch,zoom: degrees, pitch from -90 to 90, \
                     zoom from 0.01 to 100"
                        .to_owned(),
                );
            }
        }
        self.check_use(format)
    }

    /// An option that a format does not heed is a mistake.
    fn check_use(&self, format: Format) -> Result<(), ExportError> {
        let drawn = format.is_drawn();
        let uses = [
            ("--size", self.size.is_some(), drawn, ".png, .gif and .mp4"),
            ("--camera", self.view.is_some(), drawn, ".png, .gif and .mp4"),
            ("--at", self.at.is_some(), format == Format::Png, ".png"),
            ("--fps", self.fps.is_some(), format != Format::Png, "all formats but .png"),
        ];
        match uses.iter().find(|(_, asked, heeded, _)| *asked && !heeded) {
            Some((name, _, _, formats)) => {
                Err(ExportError::Option(format!("{name} is for {formats}")))
            }
            None => Ok(()),
        }
    }
}
