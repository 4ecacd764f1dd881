//! The folder of a run: made once, never written over by accident.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tumble::StepError;

use crate::scene::{HEADER, Scene};

/// The files that a run writes. Nothing else in the folder is ever touched.
pub(super) const FILES: [&str; 9] = [
    SCENE,
    TRAJECTORY,
    LEDGER,
    CONTACTS,
    "summary.json",
    "energy.svg",
    "motion.png",
    "motion.html",
    CHECKPOINT,
];

/// The file that shows a folder to be taken.
pub(crate) const SCENE: &str = "scene.toml";
/// One row a body a frame.
pub(crate) const TRAJECTORY: &str = "trajectory.csv";
/// One row a frame.
pub(crate) const LEDGER: &str = "energy.csv";
/// One row a frame for each body in contact.
pub(super) const CONTACTS: &str = "contacts.csv";
/// What a run goes on from.
pub const CHECKPOINT: &str = "checkpoint.tumble";

/// Why a run cannot start or go on.
#[derive(Debug)]
pub enum RunError {
    /// The folder already holds a run.
    Taken(PathBuf),
    /// The folder cannot be made.
    Folder(PathBuf, io::Error),
    /// A file cannot be written.
    Write(PathBuf, io::Error),
    /// The folder holds a scene that no run wrote.
    NotARun(PathBuf),
    /// The energy is not a finite number at this time (s).
    Energy(f64),
    /// A picture cannot be drawn.
    Draw(PathBuf, String),
    /// The simulation failed.
    Step(StepError),
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Taken(path) => write!(
                f,
                "{} already holds a run; name another folder with --out, or write over it with --force",
                path.display()
            ),
            Self::Folder(path, error) => write!(
                f,
                "cannot make the folder {}: {error}; name a folder that you may write to with --out",
                path.display()
            ),
            Self::Write(path, error) => {
                let advice = match error.kind() {
                    io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                        "free some space, or name a folder on another disk with --out; \
                         a larger output.interval writes less"
                    }
                    _ => "name a folder that you may write to with --out",
                };
                write!(f, "cannot write {}: {error}; {advice}", path.display())
            }
            Self::Draw(path, error) => write!(f, "cannot draw {}: {error}", path.display()),
            Self::NotARun(path) => write!(
                f,
                "{} was not written by a run, so --force keeps it; name another folder with --out",
                path.display()
            ),
            Self::Energy(time) => write!(
                f,
                "the energy is not a finite number at t = {time} s: the motion has diverged; \
                 a smaller dt or softer contacts may help"
            ),
            Self::Step(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for RunError {}

/// A folder that holds nothing of a run yet.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// Makes the folder at `path`, or takes it over when it holds no run. With `force` an old
    /// run's files are removed first. The folder is then taken for whoever asks next, even at the
    /// same moment from another process: an empty `scene.toml` says so until the run writes its own.
    ///
    /// # Errors
    /// [`RunError::Taken`], [`RunError::NotARun`], [`RunError::Folder`] or [`RunError::Write`].
    pub fn create(path: &Path, force: bool) -> Result<Self, RunError> {
        let folder = Self { path: path.to_owned() };
        fs::create_dir_all(path).map_err(|error| RunError::Folder(path.to_owned(), error))?;
        for name in FILES {
            // a link that leads nowhere is there, too
            if folder.file(name).symlink_metadata().is_ok() {
                if !force {
                    return Err(RunError::Taken(path.to_owned()));
                }
                folder.remove(name)?;
            }
        }
        let scene = folder.file(SCENE);
        match File::create_new(&scene) {
            Ok(_) => Ok(folder),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                Err(RunError::Taken(path.to_owned()))
            }
            Err(error) => Err(RunError::Write(scene, error)),
        }
    }

    /// The folder at `path`, whose run is to go on.
    pub fn existing(path: &Path) -> Self {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        Self { path: path.to_owned() }
    }

    /// Whether both are one folder.
    pub fn is(&self, path: &Path) -> bool {
        match (self.path.canonicalize(), path.canonicalize()) {
            (Ok(own), Ok(other)) => own == other,
            _ => false,
        }
    }

    /// Removes a file of an old run; but a `scene.toml` only if a run wrote it.
    fn remove(&self, name: &str) -> Result<(), RunError> {
        let path = self.file(name);
        if name == SCENE {
            let text = fs::read(&path).unwrap_or_default();
            if !(text.is_empty() || text.starts_with(HEADER.as_bytes())) {
                return Err(RunError::NotARun(path));
            }
        }
        fs::remove_file(&path).map_err(|error| RunError::Write(path, error))
    }

    /// Writes the scene; where that fails, the folder is free again.
    pub(super) fn claim(&self, scene: &Scene) -> Result<(), RunError> {
        self.write(SCENE, scene.to_toml().as_bytes()).inspect_err(|_| {
            // best effort: the first error is the one to tell
            let _ = fs::remove_file(self.file(SCENE));
        })
    }

    /// Takes back that the run in it is whole.
    pub(super) fn unfinish(&self) -> Result<(), RunError> {
        let path = self.file("summary.json");
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(RunError::Write(path, error))
            }
            _ => Ok(()),
        }
    }

    /// Makes the first of `parent/name`, `parent/name-2`, `parent/name-3`, … that holds no run.
    ///
    /// # Errors
    /// [`RunError::Folder`] or [`RunError::Write`].
    pub fn create_next(parent: &Path, name: &str) -> Result<Self, RunError> {
        let mut number = 1u32;
        loop {
            let name = if number == 1 { name.to_owned() } else { format!("{name}-{number}") };
            let path = parent.join(name);
            // a file in the way takes the name as a run does
            if path.exists() && !path.is_dir() {
                number += 1;
                continue;
            }
            match Self::create(&path, false) {
                Err(RunError::Taken(_)) => number += 1,
                result => return result,
            }
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The full path of one of its files.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Opens one of its files for writing, line by line.
    pub(super) fn open(&self, name: &str) -> Result<BufWriter<File>, RunError> {
        let path = self.file(name);
        let file = File::create(&path).map_err(|error| RunError::Write(path, error))?;
        Ok(BufWriter::with_capacity(1 << 16, file))
    }

    /// Opens one of its files to go on writing after its first `length` bytes; the rest is cut off.
    pub(super) fn reopen(&self, name: &str, length: u64) -> Result<BufWriter<File>, RunError> {
        let path = self.file(name);
        let open = || {
            let mut file = OpenOptions::new().write(true).open(&path)?;
            file.set_len(length)?;
            file.seek(SeekFrom::Start(length))?;
            Ok(file)
        };
        let file = open().map_err(|error| RunError::Write(path.clone(), error))?;
        Ok(BufWriter::with_capacity(1 << 16, file))
    }

    /// Writes one of its files whole: first under another name, then renamed, so that a file of
    /// that name is never half of itself.
    pub(super) fn write(&self, name: &str, bytes: &[u8]) -> Result<(), RunError> {
        let path = self.file(name);
        let temporary = self.file(&format!(".{name}.partial"));
        let written = File::create(&temporary)
            .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
            .and_then(|()| fs::rename(&temporary, &path));
        written.map_err(|error| {
            // best effort: the first error is the one to tell
            let _ = fs::remove_file(&temporary);
            RunError::Write(path, error)
        })
    }
}
