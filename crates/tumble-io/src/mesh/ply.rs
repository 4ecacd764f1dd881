//! PLY, text and binary of either byte order.
//!
//! The crate `ply-rs-bw` (4.0) is not used: it rejects numbers such as `1.` and `.5` that occur in practice, lets a header request any
//! number of elements without properties, and reports no byte in its errors.
//!
//! Read: the properties x, y, z of the element `vertex` (of any scalar type), the list `vertex_indices` or
//! `vertex_index` of the elements `face` and `tristrips`. Everything else is skipped. A file without faces is a point cloud.

mod header;

use glam::DVec3;

use header::{Element, Encoding, Header, Scalar};

use super::error::{Place, ReadError};
use super::parsed::Parsed;
use super::polygon::Faces;
use super::text::{Style, Words};
use crate::counted::counted;

/// Reads the bytes of a PLY file.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, ReadError> {
    let mut words = Words::new(bytes, Style::Plain);
    let header = Header::read(&mut words)?;
    let start = data_start(bytes, words.offset());
    header.check_size(bytes.len() - start, &words)?;
    let vertex_count = header.vertex_count().map_err(|message| words.line_error(message))?;
    let mut collector = MeshCollector { vertex_count, ..Default::default() };
    match header.encoding {
        Encoding::Text => {
            let mut source = TextSource { words };
            collector.read(&header, &mut source)?;
            source.check_end()?;
        }
        Encoding::Binary { big_endian } => {
            let mut source = BinarySource { bytes, at: start, value_at: start, big_endian };
            collector.read(&header, &mut source)?;
            source.check_end()?;
        }
    }
    let face_count = collector.faces.count;
    let triangles = collector.faces.finish(&collector.vertices);
    let (vertices, side_files) = (collector.vertices, Vec::new());
    Ok(Parsed { vertices, triangles, face_count, object_count: 1, side_files })
}

/// Where the data begin, behind the line break that ends the header.
fn data_start(bytes: &[u8], after_header: usize) -> usize {
    // in a header whose lines end with `\r`, a `\n` behind the last one is the first byte of the data
    let lines_end_with_return =
        matches!(bytes, [b'p', b'l', b'y', b'\r', next, ..] if *next != b'\n');
    let took_two = bytes[..after_header].ends_with(b"\r\n");
    after_header - usize::from(lines_end_with_return && took_two)
}

/// A source of element values, text or binary.
trait Source {
    /// Advances to the next element (in text: to the next line that is not empty).
    fn begin(&mut self) -> Result<(), ReadError>;
    /// A number, as a double, which holds all scalar types.
    fn value(&mut self, scalar: Scalar) -> Result<f64, ReadError>;
    /// Skips a value.
    fn skip(&mut self, scalar: Scalar) -> Result<(), ReadError>;
    /// Checks that the element ends here.
    fn end(&mut self) -> Result<(), ReadError>;
    /// An error at the last value.
    fn error(&self, message: String) -> ReadError;
}

struct TextSource<'a> {
    words: Words<'a>,
}

impl TextSource<'_> {
    fn word(&mut self) -> Result<&[u8], ReadError> {
        let missing = "a value is missing; the line must have those that the header names";
        match self.words.next_word() {
            Some(word) => Ok(word),
            None => Err(self.words.error(missing)),
        }
    }

    /// Checks that nothing follows the last element.
    fn check_end(&mut self) -> Result<(), ReadError> {
        loop {
            if self.words.next_word().is_some() {
                return Err(self
                    .words
                    .error("the file goes on after all the elements of its header"));
            }
            if !self.words.next_line() {
                return Ok(());
            }
        }
    }
}

impl Source for TextSource<'_> {
    fn begin(&mut self) -> Result<(), ReadError> {
        // skip empty lines
        loop {
            let mut ahead = self.words.clone();
            if ahead.next_word().is_some() {
                return Ok(());
            }
            if !self.words.next_line() {
                return Err(self
                    .words
                    .line_error("the file ends before its last element: it is truncated"));
            }
        }
    }

    fn value(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        let value = self.words.next_number("the value")?;
        if !scalar.is_float() && value.fract() != 0.0 {
            return Err(self.error(format!("the value is {value}; a whole number is expected")));
        }
        Ok(value)
    }

    fn skip(&mut self, _: Scalar) -> Result<(), ReadError> {
        self.word().map(|_| ())
    }

    fn end(&mut self) -> Result<(), ReadError> {
        if self.words.next_word().is_some() {
            return Err(self.error("the line has more values than the header names".to_owned()));
        }
        self.words.next_line();
        Ok(())
    }

    fn error(&self, message: String) -> ReadError {
        self.words.error(message)
    }
}

struct BinarySource<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Offset of the last value.
    value_at: usize,
    big_endian: bool,
}

impl BinarySource<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        self.value_at = self.at;
        let Some(bytes) = self.bytes[self.at..].first_chunk::<N>() else {
            return Err(
                self.error("the file ends here, within an element: it is truncated".to_owned())
            );
        };
        self.at += N;
        let mut bytes = *bytes;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Checks that nothing but padding follows the last element.
    fn check_end(&mut self) -> Result<(), ReadError> {
        let rest = &self.bytes[self.at..];
        if rest.iter().all(|byte| byte.is_ascii_whitespace() || *byte == 0) {
            return Ok(());
        }
        self.value_at = self.at;
        Err(self.error(format!(
            "{} the last element that the header promises: its counts are wrong, or something else was appended",
            counted(rest.len(), "byte follows", "bytes follow")
        )))
    }
}

impl Source for BinarySource<'_> {
    fn begin(&mut self) -> Result<(), ReadError> {
        Ok(())
    }

    fn value(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.take()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.take()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.take()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.take()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.take()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.take()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.take()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    fn skip(&mut self, scalar: Scalar) -> Result<(), ReadError> {
        self.value(scalar).map(|_| ())
    }

    fn end(&mut self) -> Result<(), ReadError> {
        Ok(())
    }

    fn error(&self, message: String) -> ReadError {
        ReadError::new(Some(Place::Byte(self.value_at as u64)), message)
    }
}

/// Collects vertices and faces from the elements.
#[derive(Default)]
struct MeshCollector {
    vertex_count: u32,
    vertices: Vec<DVec3>,
    faces: Faces,
    /// The corners of the current face.
    corners: Vec<u32>,
}

/// The meaning of a property of an element.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Axis(usize),
    Corners,
    None,
}

impl MeshCollector {
    fn read(&mut self, header: &Header, source: &mut impl Source) -> Result<(), ReadError> {
        for element in &header.elements {
            // an element without properties has no data, whatever its count
            if !element.properties.is_empty() {
                self.read_elements(element, source)?;
            }
        }
        Ok(())
    }

    fn read_elements(
        &mut self,
        element: &Element,
        source: &mut impl Source,
    ) -> Result<(), ReadError> {
        let roles: Vec<Role> = (0..element.properties.len()).map(|i| role(element, i)).collect();
        for _ in 0..element.count {
            source.begin()?;
            let mut position = DVec3::ZERO;
            self.corners.clear();
            for (property, &role) in element.properties.iter().zip(&roles) {
                let length = match property.list {
                    Some(scalar) => self.read_length(scalar, source)?,
                    None => 1,
                };
                for _ in 0..length {
                    match role {
                        Role::Axis(axis) => {
                            position[axis] = read_coordinate(property.scalar, source)?;
                        }
                        Role::Corners => self.read_corner(property.scalar, source)?,
                        Role::None => source.skip(property.scalar)?,
                    }
                }
            }
            self.keep(element, position, source)?;
            source.end()?;
        }
        Ok(())
    }

    fn read_length(&self, scalar: Scalar, source: &mut impl Source) -> Result<u64, ReadError> {
        match source.value(scalar)? {
            length if (0.0..=f64::from(u32::MAX)).contains(&length) => Ok(length as u64),
            length => Err(source.error(format!("a list cannot have {length} entries"))),
        }
    }

    fn read_corner(&mut self, scalar: Scalar, source: &mut impl Source) -> Result<(), ReadError> {
        let index = source.value(scalar)?;
        // in a strip, -1 begins the next one
        if index != -1.0 && !(0.0..f64::from(self.vertex_count)).contains(&index) {
            return Err(source.error(format!(
                "face refers to vertex {index}, but there are only {} (0 to {})",
                self.vertex_count,
                self.vertex_count - 1
            )));
        }
        self.corners.push(if index < 0.0 { u32::MAX } else { index as u32 });
        Ok(())
    }

    fn keep(
        &mut self,
        element: &Element,
        position: DVec3,
        source: &impl Source,
    ) -> Result<(), ReadError> {
        match element.name.as_slice() {
            b"vertex" => self.vertices.push(position),
            b"face" if self.corners.contains(&u32::MAX) => {
                return Err(
                    source.error("face refers to vertex -1; vertices count from 0".to_owned())
                );
            }
            b"face" if self.corners.len() < 3 => {
                return Err(source.error(format!(
                    "the face has {}; 3 or more are needed",
                    counted(self.corners.len(), "corner", "corners")
                )));
            }
            b"face" => self.faces.push(&self.corners),
            b"tristrips" => {
                for strip in self.corners.split(|&corner| corner == u32::MAX) {
                    self.faces.push_strip(strip);
                }
            }
            _ => {}
        }
        Ok(())
    }
}

fn role(element: &Element, index: usize) -> Role {
    let property = &element.properties[index];
    match (element.name.as_slice(), property.name.as_slice(), property.list) {
        (b"vertex", b"x", None) => Role::Axis(0),
        (b"vertex", b"y", None) => Role::Axis(1),
        (b"vertex", b"z", None) => Role::Axis(2),
        (b"face" | b"tristrips", b"vertex_indices" | b"vertex_index", Some(_)) => Role::Corners,
        _ => Role::None,
    }
}

fn read_coordinate(scalar: Scalar, source: &mut impl Source) -> Result<f64, ReadError> {
    let value = source.value(scalar)?;
    if !value.is_finite() {
        return Err(source.error(format!("the coordinate is {value}; it must be finite")));
    }
    Ok(value)
}
