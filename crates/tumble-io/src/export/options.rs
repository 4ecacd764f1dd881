//! Formats and options of exports, and their checks.

use std::path::Path;

use super::error::ExportError;
use crate::picture::{DEFAULT_SIZE, View};

/// An export format, selected by the file extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary glTF 2.0.
    Glb,
    /// USD as text (`.usda`).
    Usda,
    /// A VTK collection (`.pvd`) of PolyData files (`.vtp`).
    Pvd,
    /// The columns of `trajectory.csv`.
    Csv,
    /// One image.
    Png,
    /// An animated image.
    Gif,
    /// A video, encoded by `ffmpeg`.
    Mp4,
}

/// Allowed width and height of images (pixels).
const IMAGE_SIDE: std::ops::RangeInclusive<u32> = 16..=8192;
/// Maximum number of pixels of an image.
const MAX_PIXELS: u64 = 1 << 24;
/// Maximum frame rate (1/s).
const MAX_FPS: f64 = 1e6;

impl Format {
    /// All formats with their file extensions.
    pub const ALL: [(&'static str, Self); 7] = [
        ("glb", Self::Glb),
        ("usda", Self::Usda),
        ("pvd", Self::Pvd),
        ("csv", Self::Csv),
        ("png", Self::Png),
        ("gif", Self::Gif),
        ("mp4", Self::Mp4),
    ];

    /// The format of the file extension of `path`, in lower or upper case.
    ///
    /// # Errors
    /// [`ExportError::Extension`] if the extension names no format.
    pub fn from_path(path: &Path) -> Result<Self, ExportError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let entry = Self::ALL.iter().find(|(name, _)| extension.as_deref() == Some(*name));
        entry.map(|entry| entry.1).ok_or_else(|| ExportError::Extension(path.to_owned()))
    }

    /// Whether the format consists of images.
    pub fn is_image(self) -> bool {
        matches!(self, Self::Png | Self::Gif | Self::Mp4)
    }

    /// Whether the format is a video, with a constant frame rate.
    pub(super) fn is_video(self) -> bool {
        matches!(self, Self::Gif | Self::Mp4)
    }
}

/// Options of an export.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExportOptions {
    /// Frames per simulated second (1/s). `None`: all recorded frames; about 30 for `.gif` and `.mp4`.
    pub fps: Option<f64>,
    /// Width and height of images (pixels). `None`: the default of the format.
    pub size: Option<(u32, u32)>,
    /// Start time (s). `None`: the start of the run.
    pub from: Option<f64>,
    /// End time (s). `None`: the end of the run.
    pub to_time: Option<f64>,
    /// Camera of images. `None`: the direction in which the motion appears largest.
    pub view: Option<View>,
    /// Draw only the state at this time (s), instead of the whole motion; `.png` only.
    pub at: Option<f64>,
    /// Overwrite existing files.
    pub force: bool,
}

impl ExportOptions {
    /// Width and height of images (pixels): as requested, or the default of the format.
    pub(super) fn image_size(&self, format: Format) -> (u32, u32) {
        let default = match format {
            Format::Gif => (800, 500),
            Format::Mp4 => (1280, 800),
            _ => DEFAULT_SIZE,
        };
        self.size.unwrap_or(default)
    }

    /// Checks all values, and that `format` supports the options that are set.
    ///
    /// # Errors
    /// [`ExportError::Option`] for the first invalid option.
    pub(super) fn check(&self, format: Format) -> Result<(), ExportError> {
        let invalid = |problem: String| Err(ExportError::Option(problem));
        if let Some(fps) = self.fps
            && !(fps > 0.0 && fps <= MAX_FPS)
        {
            return invalid(format!("--fps must be above 0 and at most {MAX_FPS}, not {fps}"));
        }
        if let Some((width, height)) = self.size {
            let pixels = u64::from(width) * u64::from(height);
            if !IMAGE_SIDE.contains(&width) || !IMAGE_SIDE.contains(&height) || pixels > MAX_PIXELS
            {
                return invalid(format!(
                    "--size must have sides from {} to {} pixels and at most {MAX_PIXELS} pixels \
                     in all, not {width}x{height}",
                    IMAGE_SIDE.start(),
                    IMAGE_SIDE.end(),
                ));
            }
        }
        let times = [("--from", self.from), ("--to-time", self.to_time), ("--at", self.at)];
        for (name, time) in times {
            if time.is_some_and(|time| !time.is_finite()) {
                return invalid(format!("{name} must be a time in seconds"));
            }
        }
        if let (Some(from), Some(to)) = (self.from, self.to_time)
            && from > to
        {
            return invalid(format!("--from {from} is after --to-time {to}"));
        }
        if let Some(View { yaw, pitch, zoom }) = self.view {
            let right_angle = std::f64::consts::FRAC_PI_2;
            let is_valid =
                yaw.is_finite() && pitch.abs() <= right_angle && (0.01..=100.0).contains(&zoom);
            if !is_valid {
                return invalid(
                    "--camera must be yaw,pitch or yaw,pitch,zoom: degrees, pitch from -90 to 90, \
                     zoom from 0.01 to 100"
                        .to_owned(),
                );
            }
        }
        self.check_support(format)
    }

    /// Refuses an option that the format would ignore.
    fn check_support(&self, format: Format) -> Result<(), ExportError> {
        let is_image = format.is_image();
        let support = [
            ("--size", self.size.is_some(), is_image, ".png, .gif and .mp4"),
            ("--camera", self.view.is_some(), is_image, ".png, .gif and .mp4"),
            ("--at", self.at.is_some(), format == Format::Png, ".png"),
            ("--fps", self.fps.is_some(), format != Format::Png, "all formats but .png"),
        ];
        match support.iter().find(|(_, is_set, is_supported, _)| *is_set && !is_supported) {
            Some((name, _, _, formats)) => {
                Err(ExportError::Option(format!("{name} is for {formats}")))
            }
            None => Ok(()),
        }
    }
}
