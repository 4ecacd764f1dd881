//! `checkpoint.tumble`: everything that a run needs to continue with bit-identical results.
//!
//! | bytes | content |
//! |---|---|
//! | 12 | [`MAGIC`] |
//! | 4 | version of the format, [`VERSION`] |
//! | 8 | length of the whole file |
//! | | four sections, each: a name of 4 letters, its length (8 bytes), its bytes |
//! | 32 | SHA-256 of everything before |
//!
//! The sections, in this order: `NAME`, the scene's name; `SCEN`, the scene as TOML; `HOW `, a byte that is 1 if
//! the run was forced, and the energy at the start (J); `STAT`, the state. All numbers
//! are little-endian, doubles as their bits. Every version, including future ones, ends with the SHA-256
//! of everything before, so that a file of a later version can be distinguished from a damaged one.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use sha2::{Digest, Sha256};
use tumble::State;

mod bytes;
mod state;

use bytes::Bytes;

/// The first bytes of every checkpoint; a transfer in text mode would change them.
pub const MAGIC: [u8; 12] = *b"\x89TUMBLE\r\n\x1a\n\0";
/// The version of the format that is written.
pub const VERSION: u32 = 6;
/// The oldest version that is read: its bodies have no `position_compensation`.
pub const OLDEST_VERSION: u32 = 3;
/// Bytes before the first section.
const HEADER_LENGTH: usize = 12 + 4 + 8;
/// Bytes after the last section.
const CHECKSUM_LENGTH: usize = 32;
/// The largest size of a checkpoint.
const MAX_BYTES: u64 = 4 << 30;

/// Everything that a run needs to continue.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The scene's name.
    pub name: String,
    /// The scene as run, as TOML, with meshes by path from the folder of the run, and by hash.
    pub scene: String,
    /// Whether a step above the critical one was accepted.
    pub force: bool,
    /// Total energy at the start of the run (J).
    pub energy_start: f64,
    /// The state.
    pub state: State,
}

/// An error in reading a checkpoint. The message continues a sentence that begins with the name of the file.
#[derive(Debug)]
pub enum CheckpointError {
    /// It cannot be read.
    Read(io::Error),
    /// It is not a regular file, or too large.
    NotAFile,
    /// It is empty.
    Empty,
    /// It is not a checkpoint.
    NotACheckpoint,
    /// Its end is missing.
    Truncated {
        /// Number of bytes found.
        found: u64,
    },
    /// Its checksum does not match.
    Damaged,
    /// Another version of the program wrote it.
    Version(u32),
    /// It is complete, but this part of it is invalid.
    Invalid(&'static str),
}

impl std::fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Read(error) => write!(f, "cannot be read: {error}"),
            Self::NotAFile => write!(f, "is not a regular file of at most {} GiB", MAX_BYTES >> 30),
            Self::Empty => write!(f, "is empty"),
            Self::NotACheckpoint => write!(f, "is no checkpoint: it begins with other bytes"),
            Self::Truncated { found } => {
                let verb = if *found == 1 { "byte is" } else { "bytes are" };
                write!(f, "is cut short: only its first {found} {verb} there")
            }
            Self::Damaged => write!(f, "is damaged: its checksum does not match its bytes"),
            Self::Version(version) => write!(
                f,
                "is of format version {version}, but this program reads versions {OLDEST_VERSION} to {VERSION}: \
                 resume it with the program that wrote it"
            ),
            Self::Invalid(part) => write!(f, "is not a checkpoint of a run: {part} is invalid"),
        }
    }
}

impl std::error::Error for CheckpointError {}

impl Checkpoint {
    /// The bytes of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let Self { name, scene, force, energy_start, state } = self;
        encode((name, scene), (*force, *energy_start), state)
    }
}

/// The bytes of a checkpoint, from borrowed parts.
pub(crate) fn encode(
    (name, scene): (&str, &str),
    (force, energy_start): (bool, f64),
    state: &State,
) -> Vec<u8> {
    let mut conditions = vec![u8::from(force)];
    conditions.extend(energy_start.to_le_bytes());
    let state = state::encode(state);
    let sections: [(&[u8; 4], &[u8]); 4] = [
        (b"NAME", name.as_bytes()),
        (b"SCEN", scene.as_bytes()),
        (b"HOW ", &conditions),
        (b"STAT", &state),
    ];
    let length = HEADER_LENGTH
        + CHECKSUM_LENGTH
        + sections.iter().map(|(_, bytes)| 12 + bytes.len()).sum::<usize>();
    let mut encoded = Vec::with_capacity(length);
    encoded.extend(MAGIC);
    encoded.extend(VERSION.to_le_bytes());
    encoded.extend((length as u64).to_le_bytes());
    for (section, bytes) in sections {
        encoded.extend(section);
        encoded.extend((bytes.len() as u64).to_le_bytes());
        encoded.extend(bytes);
    }
    let checksum = Sha256::digest(&encoded);
    encoded.extend(checksum);
    encoded
}

/// Reads the checkpoint in the file at `path`.
///
/// # Errors
/// [`CheckpointError`].
pub fn read_checkpoint(path: &Path) -> Result<Checkpoint, CheckpointError> {
    let metadata = std::fs::metadata(path).map_err(CheckpointError::Read)?;
    if !metadata.is_file() || metadata.len() > MAX_BYTES {
        return Err(CheckpointError::NotAFile);
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(CheckpointError::Read)?;
    // bound the read, since the file may grow
    file.take(MAX_BYTES).read_to_end(&mut bytes).map_err(CheckpointError::Read)?;
    parse_checkpoint(&bytes)
}

/// Reads a checkpoint from untrusted bytes. It needs at most a few times their size in memory.
///
/// # Errors
/// [`CheckpointError`] for anything but a complete checkpoint.
pub fn parse_checkpoint(bytes: &[u8]) -> Result<Checkpoint, CheckpointError> {
    let found = bytes.len() as u64;
    if bytes.is_empty() {
        return Err(CheckpointError::Empty);
    }
    if !bytes.starts_with(&MAGIC[..bytes.len().min(MAGIC.len())]) {
        return Err(CheckpointError::NotACheckpoint);
    }
    let truncated = CheckpointError::Truncated { found };
    if bytes.len() < HEADER_LENGTH + CHECKSUM_LENGTH {
        return Err(truncated);
    }
    let (body, checksum) = bytes.split_at(bytes.len() - CHECKSUM_LENGTH);
    let is_intact = Sha256::digest(body).as_slice() == checksum;
    let mut rest = Bytes(&body[MAGIC.len()..]);
    let header = rest.u32().zip(rest.u64());
    let (version, length) = header.ok_or(CheckpointError::Damaged)?;
    if !is_intact {
        return Err(if length > found { truncated } else { CheckpointError::Damaged });
    }
    if !(OLDEST_VERSION..=VERSION).contains(&version) {
        return Err(CheckpointError::Version(version));
    }
    if length != found {
        return Err(CheckpointError::Invalid("its length"));
    }
    let name = rest.section(b"NAME").and_then(text);
    let name = name.ok_or(CheckpointError::Invalid("the scene's name"))?;
    let scene = rest.section(b"SCEN").and_then(text);
    let scene = scene.ok_or(CheckpointError::Invalid("the scene"))?;
    let conditions = rest.section(b"HOW ").and_then(|mut bytes| {
        let (force, energy) = (bytes.take(1)?[0], bytes.f64()?);
        (force <= 1 && energy.is_finite() && bytes.is_empty()).then_some((force == 1, energy))
    });
    let (force, energy_start) =
        conditions.ok_or(CheckpointError::Invalid("the energy at the start"))?;
    let state = rest.section(b"STAT").and_then(|bytes| state::decode(bytes, version));
    let state = state.filter(|_| rest.is_empty());
    let state = state.ok_or(CheckpointError::Invalid("the state"))?;
    Ok(Checkpoint { name, scene, force, energy_start, state })
}

fn text(bytes: Bytes) -> Option<String> {
    String::from_utf8(bytes.0.to_vec()).ok()
}
