//! Wavefront OBJ, text.
//!
//! The crate `tobj` is not used, because it makes meshes for drawing: it drops vertices that no face uses, orders the others by
//! their first use, splits the file at each object, and reads single precision by default. Here the particles are the `v` lines of the file: all
//! of them, in order, in double precision.
//!
//! Read: `v`, `f` (polygons of any size, negative indices, `v`, `v/vt`, `v//vn`, `v/vt/vn`), `o` and `g`
//! (counted). Weights and colours after a position are ignored, and so are all other statements, except those that would add to the
//! mesh. A face may come before its vertices.

use glam::DVec3;

use super::error::{Place, ReadError};
use super::parsed::Parsed;
use super::polygon::Faces;
use super::text::{Style, Words, check_text, show};
use crate::counted::counted;

/// Reads the bytes of an OBJ file.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, ReadError> {
    check_text(bytes, "OBJ")?;
    let mut reader = Reader::new(bytes);
    loop {
        if let Some(keyword) = reader.words.next_word() {
            reader.statement(keyword)?;
        }
        if !reader.words.next_line() {
            return reader.finish();
        }
    }
}

struct Reader<'a> {
    words: Words<'a>,
    vertices: Vec<DVec3>,
    faces: Faces,
    /// The corners of the current face.
    corners: Vec<u32>,
    /// The largest index of any face, from 0, and where it is.
    largest: Option<(u32, Place)>,
    object_count: usize,
    group_count: usize,
}

impl<'a> Reader<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self {
            words: Words::new(bytes, Style::Obj),
            vertices: Vec::new(),
            faces: Faces::default(),
            corners: Vec::new(),
            largest: None,
            object_count: 0,
            group_count: 0,
        }
    }

    fn statement(&mut self, keyword: &[u8]) -> Result<(), ReadError> {
        match keyword {
            b"v" | b"V" => self.vertex(),
            b"f" | b"F" | b"fo" => self.face(),
            b"o" => {
                self.object_count += 1;
                Ok(())
            }
            b"g" => {
                self.group_count += 1;
                Ok(())
            }
            // without these, a part of the mesh would be missing
            b"surf" | b"bsp" | b"bzp" | b"cdp" => Err(self.words.error(format!(
                "{} is a curved surface, which is not read; export the mesh as polygons",
                show(keyword)
            ))),
            b"call" => Err(self.words.error(
                "`call` inserts another file, which is not read; export the mesh as one file",
            )),
            // other statements do not affect particles
            _ if is_plausible(keyword) => Ok(()),
            _ => Err(self.words.error(format!(
                "{} is no OBJ statement (such as v, f, o); is this an OBJ file?",
                show(keyword)
            ))),
        }
    }

    fn vertex(&mut self) -> Result<(), ReadError> {
        let x = self.words.next_number("the x coordinate")?;
        let y = self.words.next_number("the y coordinate")?;
        let z = self.words.next_number("the z coordinate")?;
        let extra = self.words.count_rest();
        if extra > 5 {
            return Err(self.words.line_error(format!(
                "the vertex has {} numbers; x y z are expected, and a weight or a colour (at most 8 in all)",
                extra + 3
            )));
        }
        self.vertices.push(DVec3::new(x, y, z));
        Ok(())
    }

    fn face(&mut self) -> Result<(), ReadError> {
        self.corners.clear();
        while let Some(word) = self.words.next_word() {
            let index = self.corner(word)?;
            if self.largest.is_none_or(|(largest, _)| index > largest) {
                self.largest = Some((index, self.words.place()));
            }
            self.corners.push(index);
        }
        if self.corners.len() < 3 {
            return Err(self.words.line_error(format!(
                "the face has {}; 3 or more are needed (use `l` for lines and `p` for points)",
                counted(self.corners.len(), "corner", "corners")
            )));
        }
        self.faces.push(&self.corners);
        Ok(())
    }

    /// The vertex of a corner such as `7`, `-1/2` or `7/2/5`, counted from 0.
    fn corner(&self, word: &[u8]) -> Result<u32, ReadError> {
        let slash = word.iter().position(|&b| b == b'/').unwrap_or(word.len());
        let (vertex, rest) = word.split_at(slash);
        let number = if is_texture_and_normal(rest) { parse_integer(vertex) } else { None };
        let count = self.vertices.len();
        match number {
            None => Err(self.words.error(format!(
                "{} is no corner of a face; v, v/vt, v//vn or v/vt/vn is expected, with whole numbers",
                show(word)
            ))),
            Some(0) => Err(self.words.error(
                "face refers to vertex 0, but vertices count from 1 (or from -1 backwards)",
            )),
            Some(back) if back < 0 => usize::try_from(back.unsigned_abs())
                .ok()
                .and_then(|back| count.checked_sub(back))
                .and_then(|index| u32::try_from(index).ok())
                .ok_or_else(|| {
                    self.words.error(format!(
                        "face refers to vertex {back}, but there are only {} before it",
                        counted(count, "vertex", "vertices")
                    ))
                }),
            Some(number) => u32::try_from(number - 1).map_err(|_| {
                self.words.error(format!(
                    "face refers to vertex {}, but no file can have as many",
                    show(vertex)
                ))
            }),
        }
    }

    fn finish(self) -> Result<Parsed, ReadError> {
        let count = self.vertices.len();
        if count == 0 {
            return Err(ReadError::new(
                None,
                "the file has no vertices (no line `v x y z`); is this an OBJ file?",
            ));
        }
        if let Some((index, place)) = self.largest
            && index as usize >= count
        {
            let number = u64::from(index) + 1;
            let vertices = counted(count, "vertex", "vertices");
            let message =
                format!("face refers to vertex {number}, but the file has only {vertices}");
            return Err(ReadError::new(Some(place), message));
        }
        let face_count = self.faces.count;
        let object_count =
            if self.object_count > 0 { self.object_count } else { self.group_count.max(1) };
        let triangles = self.faces.finish(&self.vertices);
        let (vertices, side_files) = (self.vertices, Vec::new());
        Ok(Parsed { vertices, triangles, face_count, object_count, side_files })
    }
}

/// Whether a word may be a keyword of some dialect: letters, digits, `_` and `-`.
fn is_plausible(keyword: &[u8]) -> bool {
    keyword[0].is_ascii_alphabetic()
        && keyword.iter().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-'))
}

/// Whether the text after the vertex of a corner is valid: nothing, `/vt`, `//vn` or `/vt/vn`.
fn is_texture_and_normal(rest: &[u8]) -> bool {
    let mut slashes = 0;
    for byte in rest {
        match byte {
            b'/' => slashes += 1,
            b'0'..=b'9' | b'-' | b'+' => {}
            _ => return false,
        }
    }
    slashes <= 2
}

/// A whole number, saturated at the largest one.
fn parse_integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value = 0_i64;
    for digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value.saturating_mul(10).saturating_add(i64::from(digit - b'0'));
    }
    Some(if negative { -value } else { value })
}
