//! Output files that get their final name only when they are complete.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::ExportError;
use crate::new_file::create_anew;

/// A file under a temporary name in the folder of the output file; removed on drop unless finished.
pub(super) struct PartialFile {
    path: PathBuf,
    temporary: PathBuf,
    file: Option<BufWriter<File>>,
    force: bool,
}

/// Checks that a file may be written at `path`.
pub(super) fn check_path(path: &Path, force: bool) -> Result<(), ExportError> {
    let refuse = |kind: io::ErrorKind, reason: &str| {
        Err(ExportError::Write(path.to_owned(), io::Error::new(kind, reason)))
    };
    match path.symlink_metadata() {
        Ok(_) if path.is_dir() => return refuse(io::ErrorKind::IsADirectory, "it is a folder"),
        Ok(_) if !force => return Err(ExportError::Exists(path.to_owned())),
        _ => {}
    }
    match parent_folder(path).metadata() {
        Ok(folder) if !folder.is_dir() => {
            refuse(io::ErrorKind::NotADirectory, "its parent is a file, not a folder")
        }
        Ok(_) => Ok(()),
        Err(error) => Err(ExportError::Write(path.to_owned(), error)),
    }
}

/// The folder that contains `path`.
pub(super) fn parent_folder(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A hidden path in the same folder, unique to this process.
pub(super) fn temporary_path(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.partial", std::process::id()));
    parent_folder(path).join(name)
}

impl PartialFile {
    /// Creates the temporary file of the output file `path`.
    pub fn create(path: &Path, force: bool) -> Result<Self, ExportError> {
        let temporary = temporary_path(path);
        let file =
            create_anew(&temporary).map_err(|error| ExportError::Write(path.to_owned(), error))?;
        let file = Some(BufWriter::with_capacity(1 << 16, file));
        Ok(Self { path: path.to_owned(), temporary, file, force })
    }

    /// The temporary path, for another program to write to.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// Renames the file to its final name. Returns its size in bytes.
    pub fn finish(mut self) -> Result<u64, ExportError> {
        let write_error = |error| ExportError::Write(self.path.clone(), error);
        if let Some(mut file) = self.file.take() {
            file.flush().and_then(|()| file.get_ref().sync_all()).map_err(write_error)?;
        }
        // another process may have created the file in the meantime
        if !self.force && self.path.symlink_metadata().is_ok() {
            return Err(ExportError::Exists(self.path.clone()));
        }
        let bytes = fs::metadata(&self.temporary).map_err(write_error)?.len();
        fs::rename(&self.temporary, &self.path).map_err(write_error)?;
        Ok(bytes)
    }
}

impl Write for PartialFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_mut().map_or(Ok(bytes.len()), |file| file.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        // after a rename the file does not exist; after an error, that error is reported instead
        let _ = fs::remove_file(&self.temporary);
    }
}
