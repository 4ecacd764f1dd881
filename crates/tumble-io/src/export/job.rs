//! The input and the result of every format, and progress reports.

use std::io;
use std::path::Path;

use super::error::ExportError;
use super::frame_selection::FrameSelection;
use super::options::{ExportOptions, Format};
use super::partial_file::PartialFile;
use crate::replay::Replay;

/// Callback for progress: receives the number of finished steps and the total, and returns whether to
/// continue.
pub type Progress<'a> = dyn FnMut(usize, usize) -> bool + 'a;

/// The result of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Number of exported frames; 1 for a `.png` file.
    pub frames: usize,
    /// Total size of all files in bytes.
    pub bytes: u64,
}

/// The input of a format module.
pub(super) struct Job<'a> {
    /// The output file.
    pub path: &'a Path,
    pub format: Format,
    pub options: &'a ExportOptions,
    pub replay: &'a Replay,
    /// The frames to export.
    pub selection: &'a FrameSelection<'a>,
}

impl Job<'_> {
    /// Creates the output file under a temporary name.
    pub fn create_file(&self) -> Result<PartialFile, ExportError> {
        PartialFile::create(self.path, self.options.force)
    }

    /// The export error for a failed write to the output file.
    pub fn write_error(&self, error: io::Error) -> ExportError {
        ExportError::Write(self.path.to_owned(), error)
    }
}

/// Reports progress.
///
/// # Errors
/// [`ExportError::Stopped`] if the caller does not want to continue.
pub(super) fn report(
    progress: &mut Progress,
    done: usize,
    total: usize,
) -> Result<(), ExportError> {
    if progress(done, total) { Ok(()) } else { Err(ExportError::Stopped) }
}
