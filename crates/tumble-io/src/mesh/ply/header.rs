//! Reads the header of a PLY file and checks it against the size of the file.

use super::super::error::ReadError;
use super::super::text::{Words, show};

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Text,
    Binary { big_endian: bool },
}

pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

pub(super) struct Element {
    pub(super) name: Vec<u8>,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

pub(super) struct Property {
    pub(super) name: Vec<u8>,
    /// The type of the number of entries, if this is a list.
    pub(super) list: Option<Scalar>,
    pub(super) scalar: Scalar,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &[u8]) -> Option<Self> {
        match name {
            b"char" | b"int8" => Some(Self::I8),
            b"uchar" | b"uint8" => Some(Self::U8),
            b"short" | b"int16" => Some(Self::I16),
            b"ushort" | b"uint16" => Some(Self::U16),
            b"int" | b"int32" => Some(Self::I32),
            b"uint" | b"uint32" => Some(Self::U32),
            b"float" | b"float32" => Some(Self::F32),
            b"double" | b"float64" => Some(Self::F64),
            _ => None,
        }
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }
}

impl Header {
    pub(super) fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        if words.next_word() != Some(b"ply") {
            return Err(words.error("the file does not begin with `ply`; is this a PLY file?"));
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        loop {
            if !words.next_line() {
                return Err(
                    words.line_error("the file ends within the header, without `end_header`")
                );
            }
            match words.next_word() {
                None | Some(b"comment" | b"obj_info") => {}
                Some(b"format") => encoding = Some(read_encoding(words)?),
                Some(b"element") => elements.push(read_element(words)?),
                Some(b"property") => {
                    let property = read_property(words)?;
                    let Some(element) = elements.last_mut() else {
                        return Err(words.line_error("a property must follow an element"));
                    };
                    element.properties.push(property);
                }
                Some(b"end_header") => break,
                Some(word) => {
                    return Err(words.error(format!(
                        "{} is no header statement; format, element, property, comment, obj_info or end_header is expected",
                        show(word)
                    )));
                }
            }
        }
        let encoding =
            encoding.ok_or_else(|| words.line_error("the header has no line `format`"))?;
        words.next_line();
        Ok(Self { encoding, elements })
    }

    /// Checks that the declared elements fit into the bytes that follow, before any is read.
    pub(super) fn check_size(&self, available: usize, words: &Words<'_>) -> Result<(), ReadError> {
        let mut needed = 0_u64;
        for element in &self.elements {
            // a text value takes at least one digit and one separator
            let each: usize = match self.encoding {
                Encoding::Text => 2 * element.properties.len(),
                Encoding::Binary { .. } => {
                    element.properties.iter().map(|p| p.list.unwrap_or(p.scalar).size()).sum()
                }
            };
            needed = needed.saturating_add(element.count.saturating_mul(each as u64));
            // the last line may end without a line break
            if needed > available as u64 + 1 {
                return Err(words.line_error(format!(
                    "the header promises {} times {}, for which the {available} bytes after it are too few: the file is truncated, or no PLY",
                    element.count,
                    show(&element.name)
                )));
            }
        }
        Ok(())
    }

    /// Checks the vertex and face elements and returns the number of vertices.
    pub(super) fn vertex_count(&self) -> Result<u32, String> {
        let mut found = self.elements.iter().filter(|e| e.name == b"vertex");
        let (Some(vertex), None) = (found.next(), found.next()) else {
            return Err("the header must have exactly one `element vertex`".to_owned());
        };
        for axis in [b"x", b"y", b"z"] {
            let property = vertex.properties.iter().find(|p| p.name == axis);
            if property.is_none_or(|p| p.list.is_some()) {
                let axis = show(axis);
                return Err(format!(
                    "the element vertex has no number {axis}; x, y and z are needed"
                ));
            }
        }
        self.check_faces()?;
        match u32::try_from(vertex.count) {
            Ok(0) => Err("the file has no vertices (`element vertex 0`)".to_owned()),
            Ok(count) => Ok(count),
            Err(_) => Err(format!("{} vertices are too many", vertex.count)),
        }
    }

    /// Checks that faces have a list of vertices, and nothing else has: it would be missing in the mesh.
    fn check_faces(&self) -> Result<(), String> {
        let is_corners = |p: &Property| {
            matches!(p.name.as_slice(), b"vertex_indices" | b"vertex_index")
                && p.list.is_some()
                && !p.scalar.is_float()
        };
        for element in self.elements.iter().filter(|element| element.count > 0) {
            let list_count = element.properties.iter().filter(|p| is_corners(p)).count();
            let name = show(&element.name);
            match (element.name.as_slice(), list_count) {
                (b"face" | b"tristrips", 1) => {}
                (b"face" | b"tristrips", _) => {
                    return Err(format!(
                        "the element {name} needs one list `vertex_indices` (or `vertex_index`) of whole numbers"
                    ));
                }
                // the grid of a range scan refers to its points only
                (_, 0) | (b"range_grid", _) => {}
                _ => {
                    return Err(format!(
                        "the element {name} has a list of vertices, but only `face` and `tristrips` are read: rename it if these are the faces, or remove it"
                    ));
                }
            }
        }
        Ok(())
    }
}

fn read_encoding(words: &mut Words<'_>) -> Result<Encoding, ReadError> {
    match words.next_word().unwrap_or_default() {
        b"ascii" => Ok(Encoding::Text),
        b"binary_little_endian" => Ok(Encoding::Binary { big_endian: false }),
        b"binary_big_endian" => Ok(Encoding::Binary { big_endian: true }),
        other => Err(words.error(format!(
            "unknown format {}; ascii, binary_little_endian or binary_big_endian is expected",
            show(other)
        ))),
    }
}

fn read_element(words: &mut Words<'_>) -> Result<Element, ReadError> {
    let name = words.next_word().unwrap_or_default().to_vec();
    let count = words.next_word().unwrap_or_default();
    match std::str::from_utf8(count).ok().and_then(|count| count.parse().ok()) {
        Some(count) => Ok(Element { name, count, properties: Vec::new() }),
        None => Err(words.error(format!(
            "the count of element {} is {}; a whole number is expected",
            show(&name),
            show(count)
        ))),
    }
}

fn read_property(words: &mut Words<'_>) -> Result<Property, ReadError> {
    let next_type = |words: &mut Words<'_>| {
        let word = words.next_word().unwrap_or_default();
        Scalar::from_name(word).ok_or_else(|| {
            let allowed =
                "char, uchar, short, ushort, int, uint, float, double (or int8 to float64)";
            words.error(format!("unknown type {}; allowed are {allowed}, and list", show(word)))
        })
    };
    // a list has its count type first
    let mut ahead = words.clone();
    let list = if ahead.next_word() == Some(b"list") {
        words.next_word();
        let count = next_type(words)?;
        if count.is_float() {
            return Err(words.error("the count of a list must be of a whole-number type"));
        }
        Some(count)
    } else {
        None
    };
    let scalar = next_type(words)?;
    match words.next_word() {
        Some(name) => Ok(Property { name: name.to_vec(), list, scalar }),
        None => Err(words.line_error("the property has no name")),
    }
}
