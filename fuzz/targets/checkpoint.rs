//! Parses arbitrary bytes as a checkpoint, unchanged and with corrected length and checksum. A checkpoint
//! that is read is written back to the same bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sha2::{Digest, Sha256};
use tumble_io::checkpoint::parse_checkpoint;

/// Position of the length of the complete file: after 12 bytes of magic and 4 of version.
const LENGTH: std::ops::Range<usize> = 16..24;

fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    if bytes.len() < LENGTH.end {
        return;
    }
    // otherwise hardly any input would pass the checksum
    let mut complete = bytes.to_vec();
    complete[LENGTH].copy_from_slice(&(bytes.len() as u64 + 32).to_le_bytes());
    let checksum = Sha256::digest(&complete);
    complete.extend(checksum);
    read(&complete);
});

fn read(bytes: &[u8]) {
    match parse_checkpoint(bytes) {
        Ok(checkpoint) => assert_eq!(checkpoint.to_bytes(), bytes),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
