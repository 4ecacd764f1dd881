//! The binary container of glTF (`.glb`): a header and chunks.

use super::super::error::{Place, ReadError};

/// Bytes before the first chunk.
const HEADER: usize = 12;
/// Bytes of the header of a chunk: its length and its kind.
const CHUNK_HEADER: usize = 8;
/// The kind of a chunk that holds a buffer.
const BINARY: &[u8; 4] = b"BIN\0";

/// The JSON part and the binary part of a file that begins with `glTF`.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ReadError> {
    let (version, length) = (word(bytes, 4)?, word(bytes, 8)? as usize);
    if version != 2 {
        let message = format!(
            "the .glb has version {version} (glTF {version}.0); only glTF 2 is read: convert it first"
        );
        return Err(error_at(4, message));
    }
    let Some(bytes) = bytes.get(..length) else {
        let found = bytes.len();
        let message = format!("the .glb promises {length} bytes, but has {found}: it is truncated");
        return Err(error_at(8, message));
    };
    let (kind, json) = chunk(bytes, HEADER)?;
    if &kind != b"JSON" {
        return Err(error_at(16, "the first chunk of the .glb must be JSON".to_owned()));
    }
    // the second chunk may be binary
    let binary = match following(bytes, HEADER + CHUNK_HEADER + json.len()) {
        Some(start) => {
            let (kind, content) = chunk(bytes, start)?;
            (&kind == BINARY).then_some(content)
        }
        None => None,
    };
    // some programs pad the JSON with zeros, not spaces
    let padding = json.iter().rev().take_while(|&&byte| byte == 0).count();
    Ok((&json[..json.len() - padding], binary))
}

/// The start of the chunk that follows the end of another, if one does.
///
/// Chunks begin at multiples of 4 bytes. Blender 2.80 did not pad the JSON: the next chunk then begins at once.
fn following(bytes: &[u8], end: usize) -> Option<usize> {
    let begins_at_once = bytes.get(end + 4..end + 8) == Some(BINARY);
    let start = if begins_at_once { end } else { end.next_multiple_of(4) };
    (start < bytes.len()).then_some(start)
}

/// The kind and the content of the chunk that begins at a byte.
fn chunk(bytes: &[u8], start: usize) -> Result<([u8; 4], &[u8]), ReadError> {
    let length = word(bytes, start)? as usize;
    let kind = word(bytes, start + 4)?.to_le_bytes();
    match bytes.get(start + CHUNK_HEADER..).and_then(|rest| rest.get(..length)) {
        Some(content) => Ok((kind, content)),
        None => Err(error_at(
            start,
            format!(
                "a chunk promises {length} bytes, more than are left: the .glb is damaged, export it again"
            ),
        )),
    }
}

fn word(bytes: &[u8], at: usize) -> Result<u32, ReadError> {
    let word = bytes.get(at..).and_then(|rest| rest.first_chunk());
    word.map(|b| u32::from_le_bytes(*b)).ok_or_else(|| {
        error_at(at, "the file ends within a header of the .glb: it is truncated".to_owned())
    })
}

fn error_at(byte: usize, message: String) -> ReadError {
    ReadError::new(Some(Place::Byte(byte as u64)), message)
}
