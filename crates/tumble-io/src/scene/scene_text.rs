//! Reads the text of a scene file.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use super::write::HEADER;

/// The largest size of a scene file. That is room for more than a hundred thousand bodies written one by one, while a file
/// that was named by mistake is refused before it is read: what is read takes many times its size in memory.
const MAX_BYTES: u64 = 16 << 20;
/// The same for the scene of a run, in which all defaults are written out: a body then takes about ten times the text.
const MAX_BYTES_OF_RUN: u64 = 256 << 20;

/// The text of the scene file at `path`.
///
/// # Errors
/// What is wrong, and with which file.
pub(crate) fn read_scene_text(path: &Path) -> Result<String, String> {
    let shown = path.display();
    let unreadable = |error: io::Error| format!("cannot read the scene {shown}: {error}");
    let metadata = fs::metadata(path).map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(format!("{shown} is a folder; name the scene file in it"));
    }
    if !metadata.is_file() {
        return Err(format!("{shown} is not a regular file; save the scene to one first"));
    }
    let mut file = File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    file.by_ref().take(HEADER.len() as u64).read_to_end(&mut bytes).map_err(unreadable)?;
    let most = if bytes == HEADER.as_bytes() { MAX_BYTES_OF_RUN } else { MAX_BYTES };
    let too_large = || {
        format!(
            "{shown} is larger than {} MiB, the most for a scene; put particles into a mesh file, and write many equal \
             bodies as one with `copies`",
            most >> 20
        )
    };
    if metadata.len() > most {
        return Err(too_large());
    }
    // bound the read, since the file may grow
    file.take(most).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > most {
        return Err(too_large());
    }
    decode(bytes).map_err(|at| {
        format!("{shown} is no scene: a scene is TOML text in UTF-8, and byte {at} is not")
    })
}

/// The text, or the place of the first byte that is not UTF-8.
fn decode(bytes: Vec<u8>) -> Result<String, usize> {
    let mut text = String::from_utf8(bytes).map_err(|error| error.utf8_error().valid_up_to())?;
    // the byte order mark that some editors write would count as a column
    if text.starts_with('\u{feff}') {
        text.remove(0);
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_file_that_is_too_large_is_not_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("s.toml");
        let set_length = |length| {
            File::options().write(true).open(&path).unwrap().set_len(length).unwrap();
        };
        // holes in a file take no space
        for (text, most) in [("", MAX_BYTES), (HEADER, MAX_BYTES_OF_RUN)] {
            fs::write(&path, text).unwrap();
            set_length(1000);
            assert_eq!(read_scene_text(&path).unwrap().len(), 1000);
            set_length(most + 1);
            let message = read_scene_text(&path).unwrap_err();
            assert!(message.contains("s.toml is larger than "), "{message}");
            assert!(message.contains(&format!(" {} MiB", most >> 20)), "{message}");
        }
        assert!(read_scene_text(dir.path()).unwrap_err().contains("is a folder"));
    }

    #[test]
    fn a_byte_order_mark_is_dropped_and_other_bytes_are_named() {
        assert_eq!(decode("\u{feff}dt = 1".into()).unwrap(), "dt = 1");
        assert_eq!(decode(b"dt = 1\xff".to_vec()), Err(6));
    }
}
