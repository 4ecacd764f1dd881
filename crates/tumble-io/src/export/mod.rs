//! Export of a run to other formats, such as glTF for Blender, USD, VTK for ParaView, images and video.
//!
//! # Data flow
//!
//! 1. [`Replay`] reads the folder of a run: the scene, the world at t = 0 and the recorded frames.
//! 2. [`Export::new`] determines the format from the file extension and checks the options. It does
//!    not need the run.
//! 3. [`Export::write`] selects the frames to export from the replay (`frame_selection`) and passes a
//!    `Job` with everything that a format needs to the module of that format.
//! 4. The format module converts the frames and writes them to a `PartialFile`. This is a temporary
//!    file beside the output file; it is renamed when it is complete, and removed after an error. So an
//!    incomplete file never appears under the final name.
//!
//! # Files
//!
//! | file | contents |
//! |---|---|
//! | `glb`, `glb_buffer` | binary glTF 2.0 with an animation |
//! | `usda` | USD as text, with time samples |
//! | `vtk` | a `.pvd` file and a folder with one `.vtp` file per frame |
//! | `csv` | the rows of `trajectory.csv` for the selected frames |
//! | `png`, `gif`, `mp4` | images and video; `mp4` runs the program `ffmpeg` |
//! | `options` | formats and options, and their checks |
//! | `frame_selection` | selects recorded frames by time and frame rate |
//! | `job` | the input and the result of every format, and progress reports |
//! | `partial_file` | the temporary file that becomes the output file |
//! | `geometry` | for glTF and USD: meshes with normals, walls, colours, orientation of the scene |
//! | `images` | for images and video: the renderer with the frames of the run |
//! | `palette` | for GIF: the colour table |
//! | `error` | [`ExportError`] |
//!
//! # How to add a format
//!
//! 1. Add a variant to [`Format`] in `options`, and its file extension to [`Format::ALL`]. If the
//!    format consists of images or is a video, add it to `Format::is_image` or `Format::is_video`.
//! 2. List the extension in the message of [`ExportError::Extension`] in `error`. If the format does
//!    not support an option, refuse it in `ExportOptions::check_support`.
//! 3. Write a module with a function `write(&Job, &mut Progress) -> Result<Exported, ExportError>`.
//!    It creates its file with `Job::create_file`, reads the frames from `job.selection`, calls
//!    `report` for each frame (or body), and ends with `PartialFile::finish`. Report contents that
//!    the format cannot represent as [`ExportError::Unsupported`].
//! 4. Call the function from [`Export::write`].
//! 5. Add a test to `tests` that reads the file back. The tests there that go through
//!    [`Format::ALL`] include the new format without a change.
//! 6. Describe the format in `docs/formats.md` and in the help text of `tumble export`.

mod csv;
mod error;
mod frame_selection;
mod geometry;
mod gif;
mod glb;
mod glb_buffer;
mod images;
mod job;
mod mp4;
mod options;
mod palette;
mod partial_file;
mod png;
#[cfg(test)]
mod tests;
mod usda;
mod vtk;

use std::path::{Path, PathBuf};

pub use error::ExportError;
pub use job::{Exported, Progress};
pub use options::{ExportOptions, Format};

use crate::replay::Replay;
use frame_selection::FrameSelection;
use job::Job;

/// An export with a valid output file and valid options.
#[derive(Clone, Debug)]
pub struct Export {
    path: PathBuf,
    format: Format,
    options: ExportOptions,
}

impl Export {
    /// Prepares an export to the file `path`. The extension of `path` selects the format.
    ///
    /// # Errors
    /// [`ExportError`] if the extension is unknown, an option is invalid, or the file exists and
    /// `options.force` is not set.
    pub fn new(path: &Path, options: ExportOptions) -> Result<Self, ExportError> {
        let format = Format::from_path(path)?;
        options.check(format)?;
        partial_file::check_path(path, options.force)?;
        Ok(Self { path: path.to_owned(), format, options })
    }

    /// The format.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Writes the file. Calls `progress` repeatedly; if it returns `false`, the export stops.
    ///
    /// # Errors
    /// [`ExportError`] if the file cannot be written or the export was stopped. No new file is left
    /// behind.
    pub fn write(&self, replay: &Replay, progress: &mut Progress) -> Result<Exported, ExportError> {
        let selection = FrameSelection::new(replay, self.format, &self.options)?;
        let job = Job {
            path: &self.path,
            format: self.format,
            options: &self.options,
            replay,
            selection: &selection,
        };
        match self.format {
            Format::Glb => glb::write(&job, progress),
            Format::Usda => usda::write(&job, progress),
            Format::Pvd => vtk::write(&job, progress),
            Format::Csv => csv::write(&job, progress),
            Format::Png => png::write(&job, progress),
            Format::Gif => gif::write(&job, progress),
            Format::Mp4 => mp4::write(&job, progress),
        }
    }
}
