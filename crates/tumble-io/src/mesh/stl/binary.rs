//! Binary STL: a header of 80 bytes, the number of triangles, 50 bytes for each, and sometimes something else.

use glam::DVec3;

use super::super::error::{Place, ReadError};
use super::super::parsed::Parsed;
use super::Soup;
use crate::counted::counted;

/// Bytes before the first triangle: 80 of header, 4 of count.
const HEADER: usize = 84;
/// Bytes of a triangle: normal, three corners, two bytes of attributes.
const TRIANGLE: usize = 50;
/// Counts of programs that write triangles before they know how many, and cannot go back.
const UNKNOWN: [u32; 2] = [0, u32::MAX];

/// Whether the length of the bytes is that of the number of triangles they declare.
pub(super) fn fits(bytes: &[u8]) -> bool {
    declared_triangles(bytes).is_some_and(|count| bytes.len() as u64 == size(count))
}

/// Reads the bytes of a binary file.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, ReadError> {
    let Some(declared) = declared_triangles(bytes) else {
        let length = counted(bytes.len(), "byte", "bytes");
        let message = format!(
            "the file has only {length}; an STL begins with `solid` (text) or has at least {HEADER} bytes (binary)"
        );
        return Err(ReadError::new(None, message));
    };
    let (records, _) = bytes[HEADER..].as_chunks::<TRIANGLE>();
    let count = triangle_count(declared, &bytes[HEADER..])
        .map_err(|message| ReadError::new(Some(Place::Byte(80)), message))?;
    let mut soup = Soup::default();
    for (i, record) in records.iter().take(count).enumerate() {
        let [_, corners @ ..] = vectors(record);
        if let Some(j) = corners.iter().position(|corner| !corner.is_finite()) {
            let byte = HEADER + TRIANGLE * i + 12 + 12 * j;
            let corner = corners[j];
            return Err(ReadError::new(
                Some(Place::Byte(byte as u64)),
                format!("a corner of triangle {} is {corner}; it must be finite", i + 1),
            ));
        }
        soup.vertices.extend(corners);
    }
    soup.finish(1)
}

fn declared_triangles(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(80..HEADER)?.first_chunk()?;
    Some(u32::from_le_bytes(*count))
}

fn size(triangle_count: u32) -> u64 {
    HEADER as u64 + TRIANGLE as u64 * u64::from(triangle_count)
}

/// The number of triangles in the bytes behind the header, of which it promises `declared`.
fn triangle_count(declared: u32, body: &[u8]) -> Result<usize, String> {
    let (whole, rest) = (body.len() / TRIANGLE, body.len() % TRIANGLE);
    let Some(tail) = usize::try_from(declared)
        .ok()
        .and_then(|count| count.checked_mul(TRIANGLE))
        .and_then(|length| body.get(length..))
    else {
        return match rest {
            0 if UNKNOWN.contains(&declared) => Ok(whole),
            _ => Err(mismatch(declared, body.len(), "it is truncated, or no STL")),
        };
    };
    let declared_count = declared as usize;
    if tail.len() < TRIANGLE || is_padding(tail) {
        return Ok(declared_count);
    }
    if fits(tail) {
        return Err(mismatch(
            declared,
            body.len(),
            "another STL follows; give it a file of its own",
        ));
    }
    let (records, _) = tail.as_chunks::<TRIANGLE>();
    match rest {
        // the length of the file is that of another count
        0 if UNKNOWN.contains(&declared) || records.iter().all(is_triangle) => Ok(whole),
        0 => Err(mismatch(declared, body.len(), WRONG_COUNT)),
        _ if UNKNOWN.contains(&declared) || is_triangle(&records[0]) => {
            Err(mismatch(declared, body.len(), WRONG_COUNT))
        }
        // something else follows the triangles
        _ => Ok(declared_count),
    }
}

const WRONG_COUNT: &str =
    "either the count is wrong or something else follows the triangles; export the file again";

fn mismatch(declared: u32, body: usize, what: &str) -> String {
    let (whole, rest) = (body / TRIANGLE, body % TRIANGLE);
    format!(
        "the header promises {}, which take {} bytes, but the file has {}, that is, {} and {}: {what}",
        counted(declared as usize, "triangle", "triangles"),
        size(declared),
        HEADER + body,
        counted(whole, "triangle", "triangles"),
        counted(rest, "byte", "bytes"),
    )
}

/// Whether bytes are zeros or text, which triangles are not.
fn is_padding(bytes: &[u8]) -> bool {
    bytes.iter().all(|&byte| byte == 0)
        || bytes.iter().all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace())
}

/// Whether 50 bytes can hardly be anything but a triangle: its corners differ, and its normal has the length 1 or 0.
fn is_triangle(record: &[u8; TRIANGLE]) -> bool {
    let [normal, a, b, c] = vectors(record);
    let length = normal.length_squared();
    let is_normal = length == 0.0 || (0.98..1.02).contains(&length);
    is_normal && [a, b, c].iter().all(|p| p.is_finite()) && a != b && b != c && c != a
}

/// The normal and the corners of a triangle.
fn vectors(record: &[u8; TRIANGLE]) -> [DVec3; 4] {
    let (floats, _) = record.as_chunks::<4>();
    let number = |i: usize| f64::from(f32::from_le_bytes(floats[i]));
    [0, 3, 6, 9].map(|i| DVec3::new(number(i), number(i + 1), number(i + 2)))
}
