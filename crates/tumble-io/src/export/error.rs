//! Errors of exports.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// Why an export failed.
#[derive(Debug)]
pub enum ExportError {
    /// The extension of this file names no format.
    Extension(PathBuf),
    /// An option is invalid, or the format does not support it.
    Option(String),
    /// The file or folder exists already.
    Exists(PathBuf),
    /// No recorded frame is selected.
    NoFrames(String),
    /// The format cannot represent the run.
    Unsupported(String),
    /// A file cannot be written.
    Write(PathBuf, io::Error),
    /// The program `ffmpeg` is not installed.
    NoFfmpeg,
    /// `ffmpeg` failed, with this error message.
    Ffmpeg(String),
    /// An image cannot be drawn.
    Draw(String),
    /// The caller stopped the export.
    Stopped,
}

impl ExportError {
    /// Whether the request was invalid, as opposed to a failure while writing.
    pub fn is_invalid_request(&self) -> bool {
        matches!(
            self,
            Self::Extension(_)
                | Self::Option(_)
                | Self::Exists(_)
                | Self::NoFrames(_)
                | Self::Unsupported(_)
        )
    }
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Extension(path) => write!(
                f,
                "{} has no ending that names a format; the formats are .glb (glTF), .usda (USD), \
                 .pvd (VTK), .csv, .png, .gif and .mp4",
                path.display()
            ),
            Self::Option(problem) | Self::NoFrames(problem) | Self::Unsupported(problem) => {
                f.write_str(problem)
            }
            Self::Exists(path) => write!(
                f,
                "{} is there already; choose another file with --to, or overwrite it with --force",
                path.display()
            ),
            Self::Write(path, error) => {
                let advice = match error.kind() {
                    io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                        "free some space, write to another disk, or lower --fps"
                    }
                    io::ErrorKind::NotFound => "make its folder first",
                    _ => "choose a file with write permission with --to",
                };
                write!(f, "cannot write {}: {error}; {advice}", path.display())
            }
            Self::NoFfmpeg => write!(
                f,
                "the program ffmpeg, which writes .mp4 files, is not to be found; install it \
                 (https://ffmpeg.org) or export a .gif"
            ),
            Self::Ffmpeg(message) => write!(f, "ffmpeg could not write the video: {message}"),
            Self::Draw(problem) => write!(f, "the image cannot be drawn: {problem}"),
            Self::Stopped => write!(f, "stopped; nothing was written"),
        }
    }
}

impl std::error::Error for ExportError {}
