//! The folder of a run: its file names, its creation, and writing its files.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::error::RunError;
use super::lock::RunLock;
use crate::new_file::create_anew;
use crate::scene::HEADER;

/// The scene as run. A folder with this file is in use.
pub(crate) const SCENE_FILE: &str = "scene.toml";
/// One row per body and frame.
pub(crate) const TRAJECTORY_FILE: &str = "trajectory.csv";
/// One row per frame.
pub(crate) const ENERGY_FILE: &str = "energy.csv";
/// One row per frame and body in contact.
pub(super) const CONTACTS_FILE: &str = "contacts.csv";
/// One row per frame and contact, where the scene asks for it.
pub(super) const CONTACT_POINTS_FILE: &str = "contact_points.csv";
/// Name of the file with the forces and coordinates of joints.
pub(super) const JOINTS_FILE: &str = "joints.csv";
/// The run in a few numbers; written last, so that its presence marks a complete run.
pub(super) const SUMMARY_FILE: &str = "summary.json";
/// Plot of the energy ledger.
pub(super) const ENERGY_PLOT_FILE: &str = "energy.svg";
/// Picture of the motion.
pub(super) const MOTION_PICTURE_FILE: &str = "motion.png";
/// Page with the animation.
pub(super) const MOTION_PAGE_FILE: &str = "motion.html";
/// The latest checkpoint, from which the run can be resumed.
pub const CHECKPOINT_FILE: &str = "checkpoint.tumble";

/// All files that a run writes. Other files in the folder are never touched.
pub(super) const FILES: [&str; 11] = [
    SCENE_FILE,
    TRAJECTORY_FILE,
    ENERGY_FILE,
    CONTACTS_FILE,
    CONTACT_POINTS_FILE,
    JOINTS_FILE,
    SUMMARY_FILE,
    ENERGY_PLOT_FILE,
    MOTION_PICTURE_FILE,
    MOTION_PAGE_FILE,
    CHECKPOINT_FILE,
];

/// A folder into which a run writes its files.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
    /// Held by all copies together, if the folder is to be written to.
    lock: Option<Arc<RunLock>>,
}

impl RunFolder {
    /// Creates the folder at `path`, or reserves an existing folder that holds no run.
    ///
    /// With `force`, the files of an old run are removed first. An empty `scene.toml` reserves the
    /// folder until the run writes its scene, so that two processes never share a folder. The folder is locked until the
    /// returned value and its copies are dropped.
    ///
    /// # Errors
    /// [`RunError::FolderInUse`], [`RunError::Running`], [`RunError::NotARun`], [`RunError::CreateFolder`] or
    /// [`RunError::Write`].
    pub fn create(path: &Path, force: bool) -> Result<Self, RunError> {
        let folder = Self::from_path(path);
        fs::create_dir_all(path).map_err(|error| RunError::CreateFolder(path.to_owned(), error))?;
        // `symlink_metadata` also detects a dangling link
        let exists = |name: &str| folder.file_path(name).symlink_metadata().is_ok();
        if !force && FILES.into_iter().any(exists) {
            // --force would not help against a run that is still going
            let is_running = RunLock::is_taken(path);
            let error = if is_running { RunError::Running } else { RunError::FolderInUse };
            return Err(error(path.to_owned()));
        }
        let folder = folder.locked()?;
        for name in FILES {
            if folder.file_path(name).symlink_metadata().is_ok() {
                if !force {
                    return Err(RunError::FolderInUse(path.to_owned()));
                }
                folder.remove(name)?;
            }
        }
        let scene = folder.file_path(SCENE_FILE);
        match File::create_new(&scene) {
            Ok(_) => Ok(folder),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                Err(RunError::FolderInUse(path.to_owned()))
            }
            Err(error) => Err(RunError::Write(scene, error)),
        }
    }

    /// The folder at `path` of an existing run.
    ///
    /// An empty path is the current folder. Nothing is created or checked.
    pub fn from_path(path: &Path) -> Self {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        Self { path: path.to_owned(), lock: None }
    }

    /// Locks the folder, which exists, until the returned value and its copies are dropped.
    ///
    /// # Errors
    /// [`RunError::Running`] if another run has locked it, or [`RunError::Write`].
    pub(super) fn locked(mut self) -> Result<Self, RunError> {
        let lock = RunLock::take(&self.path)
            .map_err(|error| RunError::Write(RunLock::path(&self.path), error))?;
        let lock = lock.ok_or_else(|| RunError::Running(self.path.clone()))?;
        self.lock = Some(Arc::new(lock));
        Ok(self)
    }

    /// Whether `path` is this folder, also by another path to it.
    pub fn is_same_as(&self, path: &Path) -> bool {
        match (self.path.canonicalize(), path.canonicalize()) {
            (Ok(own), Ok(other)) => own == other,
            _ => false,
        }
    }

    /// Removes a file of an old run; a `scene.toml` only if a run wrote it.
    fn remove(&self, name: &str) -> Result<(), RunError> {
        let path = self.file_path(name);
        if name == SCENE_FILE {
            let text = fs::read(&path).unwrap_or_default();
            if !(text.is_empty() || text.starts_with(HEADER.as_bytes())) {
                return Err(RunError::NotARun(path));
            }
        }
        fs::remove_file(&path).map_err(|error| RunError::Write(path, error))
    }

    /// Writes `scene.toml`, or returns the error that prevents that. The file is removed after an error, which
    /// releases the folder.
    pub(super) fn write_scene(&self, toml: Result<String, RunError>) -> Result<String, RunError> {
        let written =
            toml.and_then(|toml| self.write_file(SCENE_FILE, toml.as_bytes()).map(|()| toml));
        written.inspect_err(|_| {
            // best effort: the first error is the one to report
            let _ = fs::remove_file(self.file_path(SCENE_FILE));
        })
    }

    /// Removes `summary.json`, which marks a complete run.
    pub(super) fn remove_summary(&self) -> Result<(), RunError> {
        let path = self.file_path(SUMMARY_FILE);
        match fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(RunError::Write(path, error))
            }
            _ => Ok(()),
        }
    }

    /// Creates the first of `parent/name`, `parent/name-2`, `parent/name-3`, … that holds no run.
    /// A name that would lead out of `parent` is changed.
    ///
    /// # Errors
    /// [`RunError::CreateFolder`] or [`RunError::Write`].
    pub fn create_next(parent: &Path, name: &str) -> Result<Self, RunError> {
        let name = one_component(name);
        let mut number = 1u32;
        loop {
            let name = if number == 1 { name.clone() } else { format!("{name}-{number}") };
            let path = parent.join(name);
            // skip the name of a file as well
            if path.exists() && !path.is_dir() {
                number += 1;
                continue;
            }
            match Self::create(&path, false) {
                Err(RunError::FolderInUse(_) | RunError::Running(_)) => number += 1,
                result => return result,
            }
        }
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the file `name` in the folder.
    pub fn file_path(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Creates a file for buffered writing; an existing file is replaced.
    pub(super) fn create_file(&self, name: &str) -> Result<BufWriter<File>, RunError> {
        let path = self.file_path(name);
        let file = create_anew(&path).map_err(|error| RunError::Write(path, error))?;
        Ok(BufWriter::with_capacity(1 << 16, file))
    }

    /// Truncates a file to `length` bytes and opens it for buffered writing at its end.
    pub(super) fn append_to_file(
        &self,
        name: &str,
        length: u64,
    ) -> Result<BufWriter<File>, RunError> {
        let path = self.file_path(name);
        let open = || {
            let mut file = OpenOptions::new().write(true).open(&path)?;
            file.set_len(length)?;
            file.seek(SeekFrom::Start(length))?;
            Ok(file)
        };
        let file = open().map_err(|error| RunError::Write(path.clone(), error))?;
        Ok(BufWriter::with_capacity(1 << 16, file))
    }

    /// Replaces a file atomically: writes a temporary file, then renames it.
    pub(super) fn write_file(&self, name: &str, bytes: &[u8]) -> Result<(), RunError> {
        self.replace(Path::new(name), |file| file.write_all(bytes))
    }

    /// Copies a file to the path `name` in the folder, whose parents are created.
    pub(super) fn copy_file(&self, mut from: File, name: &Path) -> Result<(), RunError> {
        let parent = self.path.join(name.parent().unwrap_or(Path::new("")));
        fs::create_dir_all(&parent).map_err(|error| RunError::CreateFolder(parent, error))?;
        self.replace(name, |file| io::copy(&mut from, file).map(drop))
    }

    fn replace(
        &self,
        name: &Path,
        write: impl FnOnce(&mut File) -> io::Result<()>,
    ) -> Result<(), RunError> {
        let path = self.path.join(name);
        let last = name.file_name().unwrap_or_default().display();
        let temporary = path.with_file_name(format!(".{last}.partial"));
        let written = create_anew(&temporary)
            .and_then(|mut file| write(&mut file).and_then(|()| file.sync_all()))
            .and_then(|()| fs::rename(&temporary, &path));
        written.map_err(|error| {
            // best effort: the first error is the one to report
            let _ = fs::remove_file(&temporary);
            RunError::Write(path, error)
        })
    }
}

/// The name as that of one folder in another: `..toml` is a file whose name without extension is a dot.
fn one_component(name: &str) -> String {
    let name = name.replace(['/', '\\', '\0'], "_");
    if name.trim_matches('.').is_empty() { format!("scene{name}") } else { name }
}
