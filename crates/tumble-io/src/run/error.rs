//! Errors of a run.

use std::io;
use std::path::PathBuf;

use tumble::StepError;

/// Why a run cannot start or continue.
#[derive(Debug)]
pub enum RunError {
    /// The folder already holds a run.
    FolderInUse(PathBuf),
    /// A run is going on in the folder.
    Running(PathBuf),
    /// The folder cannot be created.
    CreateFolder(PathBuf, io::Error),
    /// A file cannot be written.
    Write(PathBuf, io::Error),
    /// A mesh cannot be copied into the folder.
    KeepMesh(PathBuf, io::Error),
    /// The `scene.toml` in the folder was not written by a run, so it is not overwritten.
    NotARun(PathBuf),
    /// The energy is not finite at this time (s).
    NonFiniteEnergy(f64),
    /// A picture cannot be drawn.
    Draw(PathBuf, String),
    /// A time step failed.
    Step(StepError),
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::FolderInUse(path) => write!(
                f,
                "{} already holds a run; choose another folder with --out, or overwrite the run with --force",
                path.display()
            ),
            Self::Running(path) => write!(
                f,
                "a run is still going in {}; wait for its end, stop it with Ctrl-C, or choose another folder with --out",
                path.display()
            ),
            Self::CreateFolder(path, error) => write!(
                f,
                "cannot make the folder {}: {error}; choose a folder that you can write to with --out",
                path.display()
            ),
            Self::Write(path, error) => {
                let advice = match error.kind() {
                    io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                        "free some space, or choose a folder on another disk with --out; \
                         a larger output.interval writes less"
                    }
                    _ => "choose a folder that you can write to with --out",
                };
                write!(f, "cannot write {}: {error}; {advice}", path.display())
            }
            Self::KeepMesh(path, error) => write!(
                f,
                "cannot copy the mesh {} into the folder of the run: {error}",
                path.display()
            ),
            Self::Draw(path, error) => write!(f, "cannot draw {}: {error}", path.display()),
            Self::NotARun(path) => write!(
                f,
                "{} was not written by a run, so --force does not overwrite it; choose another folder with --out",
                path.display()
            ),
            Self::NonFiniteEnergy(time) => write!(
                f,
                "the energy is not a finite number at t = {time} s: the motion has diverged; \
                 a smaller dt or softer contacts may help"
            ),
            Self::Step(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for RunError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_told_with_what_helps() {
        let error = io::Error::from(io::ErrorKind::StorageFull);
        let message = RunError::Write(PathBuf::from("o/scene.toml"), error).to_string();
        assert!(message.starts_with("cannot write o/scene.toml: "), "{message}");
        assert!(message.contains("free some space") && message.contains("--out"), "{message}");
    }
}
