//! Files that appear when they are whole.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::ExportError;

/// A file that grows under another name beside its own, and is removed unless it is finished.
pub(super) struct Draft {
    path: PathBuf,
    temporary: PathBuf,
    file: Option<BufWriter<File>>,
    force: bool,
}

/// Whether a file may be written at `path`.
pub(super) fn check(path: &Path, force: bool) -> Result<(), ExportError> {
    let refuse = |kind: io::ErrorKind, why: &str| {
        Err(ExportError::Write(path.to_owned(), io::Error::new(kind, why)))
    };
    match path.symlink_metadata() {
        Ok(_) if path.is_dir() => return refuse(io::ErrorKind::IsADirectory, "it is a folder"),
        Ok(_) if !force => return Err(ExportError::Taken(path.to_owned())),
        _ => {}
    }
    match folder_of(path).metadata() {
        Ok(folder) if !folder.is_dir() => {
            refuse(io::ErrorKind::NotADirectory, "what should be its folder is a file")
        }
        Ok(_) => Ok(()),
        Err(error) => Err(ExportError::Write(path.to_owned(), error)),
    }
}

/// The folder in which a file lies.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A hidden name beside a file, of this process alone.
pub(super) fn beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.partial", std::process::id()));
    folder_of(path).join(name)
}

impl Draft {
    /// Begins a file that will be at `path`.
    pub fn create(path: &Path, force: bool) -> Result<Self, ExportError> {
        let temporary = beside(path);
        let file =
            File::create(&temporary).map_err(|error| ExportError::Write(path.to_owned(), error))?;
        let file = Some(BufWriter::with_capacity(1 << 16, file));
        Ok(Self { path: path.to_owned(), temporary, file, force })
    }

    /// A name for another program to write to; what is there will be the file.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// The file is whole: it appears under its own name. Returns its size in bytes.
    pub fn finish(mut self) -> Result<u64, ExportError> {
        let failed = |error| ExportError::Write(self.path.clone(), error);
        if let Some(mut file) = self.file.take() {
            file.flush().and_then(|()| file.get_ref().sync_all()).map_err(failed)?;
        }
        // somebody else may have been faster
        if !self.force && self.path.symlink_metadata().is_ok() {
            return Err(ExportError::Taken(self.path.clone()));
        }
        let bytes = fs::metadata(&self.temporary).map_err(failed)?.len();
        fs::rename(&self.temporary, &self.path).map_err(failed)?;
        Ok(bytes)
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_mut().map_or(Ok(bytes.len()), |file| file.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // after a rename it is gone; otherwise the first error is the one to tell
        let _ = fs::remove_file(&self.temporary);
    }
}
