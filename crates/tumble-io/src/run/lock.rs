//! The lock of a run's folder, so that only one run at a time writes there.
//!
//! It is a lock of the operating system on an empty file. The lock vanishes with the process, also when the process is
//! killed, so that a file that is left behind locks nothing.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// Name of the locked file. It is there only while a run writes, or after a run was killed.
const LOCK_FILE: &str = ".run.lock";
/// How often the file may vanish between opening and locking it, each time because another run has just ended.
const MAX_TRIES: u32 = 100;

/// The lock; released on drop.
#[derive(Debug)]
pub(super) struct RunLock {
    path: PathBuf,
    file: File,
}

impl RunLock {
    /// Locks the folder; `None` if another run has locked it. A file system without locks is not an error: there, the folder
    /// is not protected.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn take(folder: &Path) -> io::Result<Option<Self>> {
        let path = Self::path(folder);
        for _ in 0..MAX_TRIES {
            // a link that lies there is not followed
            if path.symlink_metadata().is_ok_and(|metadata| metadata.is_symlink()) {
                fs::remove_file(&path)?;
            }
            let mut options = OpenOptions::new();
            let file = options.read(true).write(true).create(true).truncate(false).open(&path)?;
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => return Ok(None),
                Err(TryLockError::Error(_)) => return Ok(Some(Self { path, file })),
                Ok(()) => {}
            }
            // the owner before may have removed the file after it was opened here
            if is_at(&file, &path) {
                return Ok(Some(Self { path, file }));
            }
        }
        Ok(None)
    }

    /// Whether a run has locked the folder. Nothing is written.
    pub fn is_taken(folder: &Path) -> bool {
        let file = OpenOptions::new().read(true).write(true).open(Self::path(folder));
        file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
    }

    /// Path of the locked file.
    pub fn path(folder: &Path) -> PathBuf {
        folder.join(LOCK_FILE)
    }
}

impl Drop for RunLock {
    /// Removes the file while it is still locked. Where that cannot be told apart from a new file, it stays.
    fn drop(&mut self) {
        if cfg!(unix) && is_at(&self.file, &self.path) {
            // best effort: the file alone locks nothing
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Whether the open file is the one at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let id = |metadata: fs::Metadata| (metadata.dev(), metadata.ino());
    match (file.metadata(), path.symlink_metadata()) {
        (Ok(open), Ok(there)) => id(open) == id(there),
        _ => false,
    }
}

/// The file is not removed on other systems.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_folder_is_locked_until_the_lock_is_dropped() {
        let dir = tempfile::tempdir().unwrap();
        assert!(!RunLock::is_taken(dir.path()));
        let lock = RunLock::take(dir.path()).unwrap().unwrap();
        assert!(RunLock::is_taken(dir.path()));
        assert!(RunLock::take(dir.path()).unwrap().is_none());
        drop(lock);
        assert!(!RunLock::is_taken(dir.path()));
        assert!(RunLock::take(dir.path()).unwrap().is_some());
    }

    #[test]
    fn a_file_that_a_killed_run_left_locks_nothing() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(RunLock::path(dir.path()), "").unwrap();
        assert!(!RunLock::is_taken(dir.path()));
        assert!(RunLock::take(dir.path()).unwrap().is_some());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_replaced_and_not_followed() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("target");
        std::os::unix::fs::symlink(&target, RunLock::path(dir.path())).unwrap();
        let lock = RunLock::take(dir.path()).unwrap();
        assert!(lock.is_some() && !target.exists());
    }
}
