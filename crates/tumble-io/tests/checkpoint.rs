//! `checkpoint.tumble`: checkpoints are read back bit for bit, and invalid files are rejected.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::OnceLock;

use proptest::prelude::*;
use sha2::{Digest, Sha256};
use tumble::{ContactImpulse, ContactKind, DVec3, PairSpring};
use tumble_io::checkpoint::{
    Checkpoint, CheckpointError, MAGIC, VERSION, parse_checkpoint, read_checkpoint,
};
use tumble_io::scene::{LoadOptions, Loaded, Source, load_text};

const SCENE: &str = "dt = 2e-4\n\
    collision = { restitution = 0.6, friction_stiffness = 0.5 }\n\
    wall = [{ normal = [0.2, 1.0, 0.0] }]\n\
    [[body]]\nshape = \"box\"\ndivisions = 2\nsize = [0.3, 0.2, 0.2]\nposition = [0, 0.2, 0]\n\
    initial_velocity = [1, -1, 0.2]\ninitial_angular_velocity = [1, 2, 3]\n";

fn load(text: &str) -> Loaded {
    let source = Source { name: "s.toml".to_owned(), text: text.to_owned() };
    load_text("s", source, Path::new("."), &LoadOptions::default()).unwrap()
}

/// A checkpoint of a run during a contact with friction.
fn checkpoint() -> &'static Checkpoint {
    static CHECKPOINT: OnceLock<Checkpoint> = OnceLock::new();
    CHECKPOINT.get_or_init(|| {
        let Loaded { scene, mut world } = load(SCENE);
        let energy_start = world.energy().total();
        while world.state().springs[0].len() < 3 || world.state().step < 2000 {
            world.step().unwrap();
        }
        Checkpoint {
            name: "s".to_owned(),
            scene: scene.to_toml(),
            force: true,
            energy_start,
            state: world.state().clone(),
        }
    })
}

/// The same bytes with a correct checksum.
fn with_checksum(mut bytes: Vec<u8>) -> Vec<u8> {
    let body = bytes.len() - 32;
    let checksum = Sha256::digest(&bytes[..body]);
    bytes[body..].copy_from_slice(&checksum);
    bytes
}

#[test]
fn a_checkpoint_is_read_back_unchanged() {
    let written = checkpoint();
    let bytes = written.to_bytes();
    let read = parse_checkpoint(&bytes).unwrap();
    assert_eq!(read.state.hash(), written.state.hash());
    assert_eq!(&read, written);
    assert_eq!(read.to_bytes(), bytes);
    assert_ne!(
        read.state.bodies[0].orientation_compensation.length(),
        0.0,
        "the checkpoint has no compensation to test"
    );
}

/// Bytes of what version 6 adds, without joints.
const JOINTS: usize = 3 * 8;

/// The bytes as version 3 or 4 has them, of a checkpoint without impulses and joints.
fn as_version(version: u32, mut bytes: Vec<u8>) -> Vec<u8> {
    let before = bytes.len();
    let section = bytes.windows(4).position(|name| name == b"STAT").unwrap();
    // from the end: checksum, the number of joints and their totals of version 6, three totals of version 5, six older ones, then the
    // division of steps, the time since the kick and the number of impulses
    let joints = bytes.len() - 32 - JOINTS;
    bytes.drain(joints..joints + JOINTS);
    let totals = bytes.len() - 32 - 9 * 8;
    bytes.drain(totals + 6 * 8..totals + 9 * 8);
    bytes.drain(totals - 2 * 8 - 4..totals);
    if version == 3 {
        // name, length, then step, time, number of bodies and the position of the only body
        let compensation = section + 4 + 8 + 3 * 8 + 3 * 8;
        bytes.drain(compensation..compensation + 3 * 8);
    }
    let removed = (before - bytes.len()) as u64;
    for at in [MAGIC.len() + 4, section + 4] {
        let length = u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) - removed;
        bytes[at..at + 8].copy_from_slice(&length.to_le_bytes());
    }
    bytes[MAGIC.len()..][..4].copy_from_slice(&version.to_le_bytes());
    with_checksum(bytes)
}

/// Version 3 lacks the compensation of the position, and versions before 5 what the integrator `implicit` adds.
#[test]
fn checkpoints_of_older_versions_are_read() {
    let written = checkpoint();
    assert_eq!(parse_checkpoint(&as_version(4, written.to_bytes())).unwrap(), *written);
    let mut without = written.clone();
    assert_ne!(without.state.bodies[0].position_compensation, DVec3::ZERO);
    without.state.bodies[0].position_compensation = DVec3::ZERO;
    assert_eq!(parse_checkpoint(&as_version(3, written.to_bytes())).unwrap(), without);
}

#[test]
fn a_resumed_world_is_bit_identical_to_an_uninterrupted_one() {
    let mut uninterrupted = load(SCENE).world;
    let read = parse_checkpoint(&checkpoint().to_bytes()).unwrap();
    let mut resumed = load(&read.scene).world;
    resumed.restore(read.state).unwrap();
    while resumed.state().step < 4000 {
        resumed.step().unwrap();
    }
    while uninterrupted.state().step < 4000 {
        uninterrupted.step().unwrap();
    }
    assert_eq!(uninterrupted.state().hash(), resumed.state().hash());
}

#[test]
fn negative_zero_and_subnormal_numbers_are_preserved() {
    let mut written = checkpoint().clone();
    written.state.bodies[0].position.x = -0.0;
    written.state.bodies[0].velocity.y = f64::from_bits(1);
    written.state.totals.evaluations = u64::MAX;
    let read = parse_checkpoint(&written.to_bytes()).unwrap();
    assert_eq!(read.to_bytes(), written.to_bytes());
    assert!(read.state.bodies[0].position.x.is_sign_negative());
}

/// A checkpoint with contacts between bodies, which the scene itself does not produce.
fn with_pair_contacts() -> Checkpoint {
    let kinds = [
        ContactKind::SphereWall,
        ContactKind::SphereSphere,
        ContactKind::PointMesh,
        ContactKind::MeshPoint,
    ];
    let mut checkpoint = checkpoint().clone();
    checkpoint.state.pair_springs = (0..)
        .zip(kinds)
        .map(|(i, kind)| PairSpring {
            first: i,
            second: i + 1,
            kind,
            particle: 7 * i,
            other: u32::MAX - i,
            stretch: DVec3::new(1e-3, -0.0, f64::from(i)),
        })
        .collect();
    checkpoint.state.pair_impulses = vec![
        ContactImpulse { normal: 0.25, tangential: DVec3::new(-1.0, 0.0, 1e-300) },
        ContactImpulse { normal: -0.0, tangential: DVec3::ZERO },
    ];
    (checkpoint.state.since_kick, checkpoint.state.step_divisions) = (1e-5, 3);
    let totals = &mut checkpoint.state.totals;
    (totals.work, totals.numerical) = (-12.5, 3e-9);
    (totals.iterations, totals.not_converged) = (77, 1);
    checkpoint
}

#[test]
fn contacts_between_bodies_and_totals_are_preserved() {
    let written = with_pair_contacts();
    let read = parse_checkpoint(&written.to_bytes()).unwrap();
    assert_eq!(read, written);
    assert_eq!(read.state.hash(), written.state.hash());
}

#[test]
fn invalid_contact_kinds_and_counts_are_rejected() {
    let bytes = with_pair_contacts().to_bytes();
    // from the end: checksum, joints, totals, the division of steps, the time since the kick, the impulses and their number, then the last spring
    let impulses = bytes.len() - 32 - JOINTS - 9 * 8 - 4 - 8 - 2 * 32 - 8;
    assert_eq!(bytes[impulses], 2);
    let kind = impulses - 41 + 8;
    assert_eq!(bytes[kind], 3);
    let count = impulses - 4 * 41 - 8;
    assert_eq!(bytes[count], 4);
    for (at, value) in [
        (kind, 4),
        (kind, 255),
        (count, 3),
        (count, 5),
        (count + 7, 255),
        (impulses, 1),
        (impulses, 3),
        (impulses + 7, 255),
    ] {
        let mut other = bytes.clone();
        other[at] = value;
        let error = parse_checkpoint(&with_checksum(other)).unwrap_err();
        assert!(matches!(error, CheckpointError::Invalid("the state")), "{at} {value}: {error}");
    }
}

#[test]
fn every_truncated_file_is_reported_as_truncated() {
    let bytes = checkpoint().to_bytes();
    for length in 1..bytes.len() {
        let error = parse_checkpoint(&bytes[..length]).unwrap_err();
        assert!(matches!(error, CheckpointError::Truncated { .. }), "{length}: {error}");
    }
    let longer = [bytes.as_slice(), b"x"].concat();
    assert!(matches!(parse_checkpoint(&longer), Err(CheckpointError::Damaged)));
    assert!(matches!(parse_checkpoint(b""), Err(CheckpointError::Empty)));
}

#[test]
fn other_files_are_rejected_with_the_reason() {
    let assert_error = |bytes: &[u8], part: &str| {
        let error = parse_checkpoint(bytes).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    };
    assert_error(b"duration = 3.0\n", "is no checkpoint: it begins with other bytes");
    assert_error(b"\x89PNG\r\n\x1a\n", "begins with other bytes");
    assert_error(&[0; 1000], "begins with other bytes");
    let mut later = checkpoint().to_bytes();
    later[MAGIC.len()..][..4].copy_from_slice(&(VERSION + 6).to_le_bytes());
    assert_error(&later, "damaged");
    assert_error(
        &with_checksum(later),
        "format version 12, but this program reads versions 3 to 6",
    );
    let mut earlier = checkpoint().to_bytes();
    earlier[MAGIC.len()..][..4].copy_from_slice(&2u32.to_le_bytes());
    assert_error(
        &with_checksum(earlier),
        "format version 2, but this program reads versions 3 to 6",
    );
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(read_checkpoint(folder.path()), Err(CheckpointError::NotAFile)));
    let missing = read_checkpoint(&folder.path().join("no")).unwrap_err();
    assert!(missing.to_string().starts_with("cannot be read: "));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 400, ..Default::default() })]

    #[test]
    fn a_single_flipped_bit_is_detected(at in any::<prop::sample::Index>(), bit in 0..8u32) {
        let mut bytes = checkpoint().to_bytes();
        let at = at.index(bytes.len());
        bytes[at] ^= 1 << bit;
        prop_assert!(parse_checkpoint(&bytes).is_err());
    }

    /// Forged content with a correct checksum causes no panic, neither in the reader nor in the world.
    #[test]
    fn forged_content_does_not_panic(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in 0..200usize,
    ) {
        let mut bytes = checkpoint().to_bytes();
        // uniform positions hit both the header and the counts within the state
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        bytes.truncate(bytes.len() - cut);
        if let Ok(read) = parse_checkpoint(&with_checksum(bytes)) {
            let mut world = load(SCENE).world;
            if world.restore(read.state).is_ok() {
                let _ = world.step();
                let _ = world.energy();
            }
        }
    }

    #[test]
    fn random_bytes_do_not_panic(tail in prop::collection::vec(any::<u8>(), 0..300)) {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(&tail);
        let _ = parse_checkpoint(&bytes);
        if tail.len() >= 32 {
            let _ = parse_checkpoint(&with_checksum(bytes));
        }
    }
}
