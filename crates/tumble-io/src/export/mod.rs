//! A run in another format: for Blender, USD, ParaView, a web page, a slide.
//!
//! [`Export::new`] looks at what is asked for, [`Export::write`] carries it out. Nothing is ever
//! half there: files grow under another name beside their own and are renamed when they are whole.
//!
//! | file | does |
//! |---|---|
//! | `glb` | binary glTF 2.0 with an animation |
//! | `usda` | USD as text, with time samples |
//! | `vtk` | `.pvd` and a folder of `.vtp`, one a frame |
//! | `csv` | the trajectory, some of its frames |
//! | `png`, `gif`, `mp4` | pictures; the last by way of `ffmpeg` |
//! | `options` | what can be asked for, and whether it makes sense |
//! | `frames` | which of the recorded frames are meant |
//! | `stage` | what glTF and USD share: meshes with normals, walls, colours |
//! | `draft` | files that appear when they are whole |

mod csv;
mod draft;
mod error;
mod frames;
mod gif;
mod glb;
mod glb_buffer;
mod mp4;
mod options;
mod palette;
mod png;
mod stage;
#[cfg(test)]
mod tests;
mod usda;
mod vtk;

use std::path::{Path, PathBuf};

pub use error::ExportError;
pub use options::{ExportOptions, Format};

use crate::replay::Replay;
use frames::Chosen;

/// Hears how many frames of how many are done; says whether to go on.
pub type Watch<'a> = dyn FnMut(usize, usize) -> bool + 'a;

/// An export that makes sense, but for what only the run can tell.
#[derive(Clone, Debug)]
pub struct Export {
    path: PathBuf,
    format: Format,
    options: ExportOptions,
}

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    /// How many frames are in it; a picture of the whole motion counts as one.
    pub frames: usize,
    /// Bytes in all files.
    pub bytes: u64,
}

impl Export {
    /// An export to the file `path`, whose ending tells the format.
    ///
    /// # Errors
    /// [`ExportError`] when the ending or an option is impossible, or the file is there already.
    pub fn new(path: &Path, options: ExportOptions) -> Result<Self, ExportError> {
        let format = Format::of(path)?;
        options.check(format)?;
        draft::check(path, options.force)?;
        Ok(Self { path: path.to_owned(), format, options })
    }

    /// The format.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Writes the file. `watch` hears of every frame; when it says no, nothing is left behind.
    ///
    /// # Errors
    /// [`ExportError`]; there is no new file then.
    pub fn write(&self, replay: &Replay, watch: &mut Watch) -> Result<Exported, ExportError> {
        let chosen = Chosen::new(replay, self.format, &self.options)?;
        let job = Job { export: self, replay, chosen: &chosen };
        match self.format {
            Format::Glb => glb::write(&job, watch),
            Format::Usda => usda::write(&job, watch),
            Format::Pvd => vtk::write(&job, watch),
            Format::Csv => csv::write(&job, watch),
            Format::Png => png::write(&job, watch),
            Format::Gif => gif::write(&job, watch),
            Format::Mp4 => mp4::write(&job, watch),
        }
    }
}

/// What every format starts from.
struct Job<'a> {
    export: &'a Export,
    replay: &'a Replay,
    chosen: &'a Chosen<'a>,
}

impl Job<'_> {
    /// A file under another name.
    fn draft(&self) -> Result<draft::Draft, ExportError> {
        draft::Draft::create(&self.export.path, self.export.options.force)
    }

    /// What becomes of an error in writing.
    fn failed(&self, error: std::io::Error) -> ExportError {
        ExportError::Write(self.export.path.clone(), error)
    }
}

/// Tells of one more frame.
fn tell(watch: &mut Watch, done: usize, all: usize) -> Result<(), ExportError> {
    if watch(done, all) { Ok(()) } else { Err(ExportError::Stopped) }
}
