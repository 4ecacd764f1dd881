//! Source texts and positions in them, for error messages.

use std::ops::Range;

/// A text that a scene was read from.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its name in messages: the path of the file, or `--set`.
    pub name: String,
    /// The text.
    pub text: String,
}

/// A position in a source: which source, and which bytes of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Index into the sources of a scene: 0 is the file, then one for each override.
    pub source: usize,
    /// Bytes of the source's text.
    pub span: Range<usize>,
}
