//! A tokeniser for the text formats. It copies nothing and knows the place of each word.

use super::error::{Place, ReadError};

/// Iterates over the words of a text, line by line.
#[derive(Clone)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    line_start: usize,
    word_start: usize,
    style: Style,
}

/// The syntax of a text format.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Style {
    /// `#` opens a comment, a backslash at the end of a line joins the next line to it.
    Obj,
    /// Neither comments nor joined lines.
    Plain,
}

impl<'a> Words<'a> {
    pub(super) fn new(bytes: &'a [u8], style: Style) -> Self {
        // skip a byte order mark
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, line: 1, line_start: at, word_start: at, style }
    }

    /// The next word of this line, or `None` at its end.
    pub(super) fn next_word(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        self.word_start = self.at;
        loop {
            // most bytes belong to a word
            let rest = &self.bytes[self.at..];
            self.at += rest.iter().position(|&b| b <= b' ' || b == b'\\').unwrap_or(rest.len());
            match self.bytes.get(self.at) {
                Some(b'\\') if self.joined_line().is_some() => break,
                None | Some(b'\n' | b'\r') => break,
                Some(&byte) if is_blank(byte) => break,
                Some(_) => self.at += 1,
            }
        }
        (self.at > self.word_start).then(|| &self.bytes[self.word_start..self.at])
    }

    fn skip_blanks(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if is_blank(byte) {
                self.at += 1;
            } else if let Some(next) = self.joined_line() {
                (self.at, self.line, self.line_start) = (next, self.line + 1, next);
            } else {
                // a comment runs to the end of its line
                if byte == b'#' && self.style == Style::Obj {
                    self.at = self.line_end();
                }
                return;
            }
        }
    }

    /// The start of the next line, if a backslash here joins it to this one.
    fn joined_line(&self) -> Option<usize> {
        match self.bytes.get(self.at..)? {
            [b'\\', b'\r', b'\n', ..] if self.style == Style::Obj => Some(self.at + 3),
            [b'\\', b'\r' | b'\n', ..] if self.style == Style::Obj => Some(self.at + 2),
            _ => None,
        }
    }

    fn line_end(&self) -> usize {
        let rest = &self.bytes[self.at..];
        self.at + rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(rest.len())
    }

    /// Advances to the next line (after `\n`, `\r\n` or `\r`). Returns false at the end of the text.
    pub(super) fn next_line(&mut self) -> bool {
        // skip the rest of a statement that continues on the next line
        while self.style == Style::Obj && self.next_word().is_some() {}
        let end = self.line_end();
        let width = match &self.bytes[end..] {
            [] => 0,
            [b'\r', b'\n', ..] => 2,
            _ => 1,
        };
        (self.at, self.line) = (end + width, self.line + usize::from(width > 0));
        (self.line_start, self.word_start) = (self.at, self.at);
        width > 0
    }

    /// The next word, of this line or of a later one, or `None` at the end of the text.
    pub(super) fn next_word_of_text(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.next_word() {
                return Some(word);
            }
            if !self.next_line() {
                return None;
            }
        }
    }

    /// The next word as a finite number; `what` names it in messages.
    pub(super) fn next_number(&mut self, what: &str) -> Result<f64, ReadError> {
        match self.next_word() {
            Some(word) => self.number(word, what),
            None => Err(self.error(format!("{what} is missing; a number is expected"))),
        }
    }

    /// A word as a finite number.
    pub(super) fn number(&self, word: &[u8], what: &str) -> Result<f64, ReadError> {
        let text = std::str::from_utf8(word).unwrap_or("");
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) if text.bytes().any(|b| b.is_ascii_digit()) => Err(self.error(format!(
                "{what} is {}, which is larger than a double can hold (about 1.8e308)",
                show(word)
            ))),
            Ok(_) => Err(self.error(format!("{what} is {}; it must be finite", show(word)))),
            Err(_) => Err(self.error(format!("{what} is {}, which is not a number", show(word)))),
        }
    }

    /// Skips the remaining words of this line and returns their number.
    pub(super) fn count_rest(&mut self) -> usize {
        std::iter::from_fn(|| self.next_word()).count()
    }

    /// The current offset (bytes).
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    /// The place of the last word.
    pub(super) fn place(&self) -> Place {
        Place::Line { line: self.line, column: Some(self.word_start - self.line_start + 1) }
    }

    /// An error at the last word.
    pub(super) fn error(&self, message: impl Into<String>) -> ReadError {
        ReadError::new(Some(self.place()), message)
    }

    /// An error for the whole line.
    pub(super) fn line_error(&self, message: impl Into<String>) -> ReadError {
        ReadError::new(Some(Place::Line { line: self.line, column: None }), message)
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

/// A word for a message: shortened, and with control characters escaped.
pub(super) fn show(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(160)]);
    let mut shown: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    if text.chars().count() > 40 {
        shown.push('…');
    }
    format!("`{shown}`")
}

/// Whether bytes begin with the byte order mark of UTF-16, as PowerShell writes it.
pub(super) fn is_utf16(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff")
}

/// Rejects bytes that cannot be text, to give a clearer error than the parser would.
pub(super) fn check_text(bytes: &[u8], format: &str) -> Result<(), ReadError> {
    if is_utf16(bytes) {
        return Err(ReadError::new(
            Some(Place::Byte(0)),
            format!(
                "the file is UTF-16 text; {format} must be plain ASCII or UTF-8: save it as UTF-8"
            ),
        ));
    }
    match bytes.iter().take(8192).position(|&b| b == 0) {
        None => Ok(()),
        Some(at) => Err(ReadError::new(
            Some(Place::Byte(at as u64)),
            format!(
                "not a text file (this byte is zero), but {format} is text: is the file another format, or damaged?"
            ),
        )),
    }
}
