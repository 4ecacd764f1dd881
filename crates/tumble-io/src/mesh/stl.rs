//! STL, text and binary.
//!
//! The crate `stl_io` (0.11) is not used: it reads every file that begins with `solid ` as text, although many binary files do, reports
//! no line or byte in its errors, and rounds text to single precision.
//!
//! A file is binary if and only if its length matches its number of triangles n (84 + 50 n bytes). Normals, attributes and
//! colours are ignored. All solids of a text file form one mesh.

use glam::DVec3;

use super::error::{Place, ReadError};
use super::parsed::Parsed;
use super::text::{Style, Words, check_text, show};
use crate::counted::counted;

/// Bytes before the first triangle of a binary file: 80 of header, 4 of count.
const HEADER: usize = 84;
/// Bytes of a triangle in a binary file: normal, three corners, two bytes of attributes.
const TRIANGLE: usize = 50;

/// Reads the bytes of an STL file.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, ReadError> {
    // a binary file may begin with "solid", so its size decides
    let declared = declared_triangles(bytes);
    if declared.is_some_and(|count| bytes.len() as u64 == binary_size(count)) {
        return parse_binary(bytes);
    }
    if begins_with_solid(bytes) && check_text(bytes, "STL").is_ok() {
        return parse_text(bytes);
    }
    let length = bytes.len();
    let message = match declared {
        None => format!(
            "the file has only {}; an STL begins with `solid` (text) or has at least {HEADER} bytes (binary)",
            counted(length, "byte", "bytes")
        ),
        Some(count) => format!(
            "the header promises {count} triangles, which take {} bytes, but the file has {length}: it is {}",
            binary_size(count),
            if binary_size(count) > length as u64 {
                "truncated, or no STL"
            } else {
                "followed by something else, or no STL"
            }
        ),
    };
    Err(ReadError::new(declared.map(|_| Place::Byte(80)), message))
}

fn declared_triangles(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(80..HEADER)?.first_chunk()?;
    Some(u32::from_le_bytes(*count))
}

fn binary_size(triangle_count: u32) -> u64 {
    HEADER as u64 + TRIANGLE as u64 * u64::from(triangle_count)
}

fn begins_with_solid(bytes: &[u8]) -> bool {
    let word = Words::new(bytes, Style::Plain).next_word();
    word.is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

fn parse_binary(bytes: &[u8]) -> Result<Parsed, ReadError> {
    let (triangles, _) = bytes[HEADER..].as_chunks::<TRIANGLE>();
    let mut soup = Soup::default();
    for (i, triangle) in triangles.iter().enumerate() {
        // behind the 12 bytes of the normal
        let (floats, _) = triangle[12..48].as_chunks::<4>();
        for (j, corner) in floats.as_chunks::<3>().0.iter().enumerate() {
            let vertex = DVec3::from_array(corner.map(|c| f64::from(f32::from_le_bytes(c))));
            if !vertex.is_finite() {
                let byte = HEADER + TRIANGLE * i + 12 + 12 * j;
                return Err(ReadError::new(
                    Some(Place::Byte(byte as u64)),
                    format!("a corner of triangle {} is {vertex}; it must be finite", i + 1),
                ));
            }
            soup.vertices.push(vertex);
        }
    }
    soup.finish(1)
}

fn parse_text(bytes: &[u8]) -> Result<Parsed, ReadError> {
    let mut words = Words::new(bytes, Style::Plain);
    let mut soup = Soup::default();
    let mut solid_count = 0;
    let mut inside = false;
    loop {
        if let Some(keyword) = words.next_word() {
            match keyword.to_ascii_lowercase().as_slice() {
                b"solid" => {
                    soup.check_whole(&words)?;
                    (solid_count, inside) = (solid_count + 1, true);
                }
                b"endsolid" => {
                    soup.check_whole(&words)?;
                    inside = false;
                }
                b"vertex" => soup.vertices.push(DVec3::new(
                    words.next_number("the x coordinate")?,
                    words.next_number("the y coordinate")?,
                    words.next_number("the z coordinate")?,
                )),
                b"outer" | b"endloop" | b"facet" | b"endfacet" => soup.check_whole(&words)?,
                b"color" => {}
                _ => {
                    return Err(words.error(format!(
                        "{} is no STL statement; solid, facet, outer loop, vertex, endloop, endfacet or endsolid is expected",
                        show(keyword)
                    )));
                }
            }
        }
        if !words.next_line() {
            break;
        }
    }
    if inside {
        return Err(words.line_error("the file ends without `endsolid`: it is truncated"));
    }
    soup.finish(solid_count)
}

/// Triangles without shared vertices, three vertices each (a triangle soup).
#[derive(Default)]
struct Soup {
    vertices: Vec<DVec3>,
}

impl Soup {
    /// Checks that every triangle has three corners; to be called outside of loops.
    fn check_whole(&self, words: &Words<'_>) -> Result<(), ReadError> {
        if self.vertices.len().is_multiple_of(3) {
            return Ok(());
        }
        Err(words.error("a facet has no three vertices here; each needs exactly 3 `vertex` lines"))
    }

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
