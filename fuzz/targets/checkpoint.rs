//! Any bytes as a checkpoint, as they are and with length and checksum put right: what is read is
//! written again to the same bytes, or in the present version and then to the same bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sha2::{Digest, Sha256};
use tumble_io::checkpoint::parse_checkpoint;

/// Where the length of the whole file lies: after 12 bytes of magic and 4 of version.
const LENGTH: std::ops::Range<usize> = 16..24;

/// Where its version lies.
const VERSION: std::ops::Range<usize> = 12..16;

fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    if bytes.len() < LENGTH.end {
        return;
    }
    // without these, few bytes would get past the checksum
    let mut whole = bytes.to_vec();
    whole[LENGTH].copy_from_slice(&(bytes.len() as u64 + 32).to_le_bytes());
    let sum = Sha256::digest(&whole);
    whole.extend(sum);
    read(&whole);
});

fn read(bytes: &[u8]) {
    match parse_checkpoint(bytes) {
        Ok(checkpoint) => {
            let written = checkpoint.to_bytes();
            let is_present = bytes[VERSION] == written[VERSION];
            if is_present {
                assert_eq!(written, bytes);
            } else {
                assert_eq!(
                    parse_checkpoint(&written).map(|again| again.to_bytes()).ok(),
                    Some(written)
                );
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
