//! Errors of the mesh readers, with the place in the file.

use std::path::{Path, PathBuf};

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In a text file.
    Line {
        /// The line, from 1.
        line: usize,
        /// The byte within the line, from 1.
        column: Option<usize>,
    },
    /// In a binary file: the offset in bytes.
    Byte(u64),
}

/// An error in reading a mesh: what is wrong, where, and what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    /// The file, if the bytes came from one.
    pub path: Option<PathBuf>,
    /// The place in the file, if there is one.
    pub place: Option<Place>,
    /// What is wrong, and what to do.
    pub message: String,
}

impl ReadError {
    pub(in crate::mesh) fn new(place: Option<Place>, message: impl Into<String>) -> Self {
        Self { path: None, place, message: message.into() }
    }

    pub(in crate::mesh) fn with_path(self, path: &Path) -> Self {
        Self { path: Some(path.to_owned()), ..self }
    }
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (&self.path, self.place) {
            (Some(path), Some(Place::Line { line, column: None })) => {
                write!(f, "{}:{line}: ", path.display())?;
            }
            (Some(path), Some(Place::Line { line, column: Some(column) })) => {
                write!(f, "{}:{line}:{column}: ", path.display())?;
            }
            (Some(path), Some(Place::Byte(byte))) => {
                write!(f, "{}: at byte {byte}: ", path.display())?;
            }
            (Some(path), None) => write!(f, "{}: ", path.display())?,
            (None, Some(Place::Line { line, column: None })) => write!(f, "line {line}: ")?,
            (None, Some(Place::Line { line, column: Some(column) })) => {
                write!(f, "line {line}, column {column}: ")?;
            }
            (None, Some(Place::Byte(byte))) => write!(f, "at byte {byte}: ")?,
            (None, None) => {}
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for ReadError {}
