//! Errors of resuming a run.

use std::path::PathBuf;

use tumble::StateError;

use super::csv_reader::RowError;
use super::error::RunError;
use crate::checkpoint::CheckpointError;
use crate::scene::SceneError;

/// Why a run cannot be resumed from a checkpoint. No file has been changed.
#[derive(Debug)]
pub enum ResumeError {
    /// The checkpoint file cannot be read or is invalid.
    Checkpoint(PathBuf, CheckpointError),
    /// The scene of the checkpoint is no longer valid, or the new duration is not.
    Scene(SceneError),
    /// The state in the checkpoint does not fit its scene.
    State(PathBuf, StateError),
    /// The run has already reached its duration.
    Done {
        /// Time of the checkpoint (s).
        time: f64,
        /// Time at which the run ends (s).
        duration: f64,
    },
    /// The folder holds files of another run.
    OtherRun(PathBuf),
    /// The folder cannot be written to, perhaps because a run is going on in it.
    Folder(RunError),
    /// The rows of a file are not those of the checkpoint's run.
    Rows(RowError),
}

impl std::fmt::Display for ResumeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Checkpoint(path, error) => write!(f, "{} {error}", path.display()),
            Self::Scene(error) => error.fmt(f),
            Self::State(path, error) => {
                write!(f, "{} is not a checkpoint of a run: {error}", path.display())
            }
            Self::Done { time, duration } => write!(
                f,
                "there is nothing left to do: the checkpoint is at t = {time} s and the run ends at \
                 {duration} s; set a later time with --duration"
            ),
            Self::OtherRun(path) => write!(
                f,
                "{} holds files that are not of the checkpoint's run; \
                 choose another folder with --out",
                path.display()
            ),
            Self::Folder(error) => error.fmt(f),
            Self::Rows(error) => write!(
                f,
                "{} {}, so the run cannot continue after its rows; to continue without them, move \
                 the checkpoint to a folder of its own",
                error.path.display(),
                error.problem
            ),
        }
    }
}

impl std::error::Error for ResumeError {}

impl From<RowError> for ResumeError {
    fn from(error: RowError) -> Self {
        Self::Rows(error)
    }
}
