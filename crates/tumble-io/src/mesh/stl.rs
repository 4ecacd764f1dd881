//! STL, text and binary.
//!
//! The crate `stl_io` (0.11) is not used: it reads every file that begins with `solid ` as text, although many binary files do, reports
//! no line or byte in its errors, and rounds text to single precision.
//!
//! A file whose length matches its number of triangles n (84 + 50 n bytes) is binary. Of the others, text begins with `solid` and
//! has no zero byte; the rest is binary with a tail or with a wrong count (`binary`). Normals, attributes and colours are ignored. All
//! solids of a text file form one mesh.

mod binary;
mod text;

use glam::DVec3;

use super::error::ReadError;
use super::parsed::Parsed;
use super::text::{Style, Words, check_text, is_utf16};

/// Reads the bytes of an STL file.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, ReadError> {
    // a binary file may begin with "solid", so its size decides
    let begins_with_solid = begins_with_solid(bytes);
    if !binary::fits(bytes) && begins_with_solid && check_text(bytes, "STL").is_ok() {
        return text::parse(bytes);
    }
    binary::parse(bytes).map_err(|mut error| {
        if is_utf16(bytes) {
            return check_text(bytes, "STL").err().unwrap_or(error);
        }
        if begins_with_solid {
            error.message += " (it begins with `solid`, but is not text: it has zero bytes)";
        }
        error
    })
}

fn begins_with_solid(bytes: &[u8]) -> bool {
    let word = Words::new(bytes, Style::Plain).next_word_of_text();
    word.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

/// Triangles without shared vertices, three vertices each (a triangle soup).
#[derive(Default)]
struct Soup {
    vertices: Vec<DVec3>,
}

impl Soup {
    fn finish(self, object_count: usize) -> Result<Parsed, ReadError> {
        if self.vertices.is_empty() {
            return Err(ReadError::new(None, "the STL has no triangles"));
        }
        let face_count = self.vertices.len() / 3;
        let triangles = (0..face_count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let (vertices, side_files) = (self.vertices, Vec::new());
        Ok(Parsed { vertices, triangles, face_count, object_count, side_files })
    }
}
