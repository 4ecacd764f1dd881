//! Why an export is not there.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// Why an export is not there.
#[derive(Debug)]
pub enum ExportError {
    /// The ending of this file is no format.
    Ending(PathBuf),
    /// An option is impossible, alone or with this format.
    Option(String),
    /// The file or folder is there already.
    Taken(PathBuf),
    /// No recorded frame is meant.
    NoFrames(String),
    /// The format cannot hold this.
    Unfit(String),
    /// A file cannot be written.
    Write(PathBuf, io::Error),
    /// The program `ffmpeg` is not there.
    NoFfmpeg,
    /// What `ffmpeg` said when it failed.
    Ffmpeg(String),
    /// A picture cannot be drawn.
    Draw(String),
    /// The caller said no.
    Stopped,
}

impl ExportError {
    /// Whether the caller asked for something that cannot be, so that nothing went wrong.
    pub fn is_wrong_call(&self) -> bool {
        matches!(
            self,
            Self::Ending(_) | Self::Option(_) | Self::Taken(_) | Self::NoFrames(_) | Self::Unfit(_)
        )
    }
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ending(path) => write!(
                f,
                "{} has no ending that names a format; there are .glb (glTF), .usda (USD), .pvd \
                 (VTK), .csv, .png, .gif and .mp4",
                path.display()
            ),
            Self::Option(what) | Self::NoFrames(what) | Self::Unfit(what) => f.write_str(what),
            Self::Taken(path) => write!(
                f,
                "{} is there already; name another file with --to, or write over it with --force",
                path.display()
            ),
            Self::Write(path, error) => {
                let advice = match error.kind() {
                    io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                        "free some space, or write to another disk; a smaller --fps writes less"
                    }
                    io::ErrorKind::NotFound => "make its folder first",
                    _ => "name a file that you may write with --to",
                };
                write!(f, "cannot write {}: {error}; {advice}", path.display())
            }
            Self::NoFfmpeg => write!(
                f,
                "the program ffmpeg, which makes .mp4 files, is not to be found; install it \
                 (https://ffmpeg.org) or export a .gif"
            ),
            Self::Ffmpeg(said) => write!(f, "ffmpeg could not make the film: {said}"),
            Self::Draw(what) => write!(f, "the picture cannot be drawn: {what}"),
            Self::Stopped => write!(f, "stopped; nothing was written"),
        }
    }
}

impl std::error::Error for ExportError {}
