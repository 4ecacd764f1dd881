//! ARCHITECTURE.md names only what is there.

use std::path::Path;

#[test]
fn every_path_that_the_architecture_names_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = std::fs::read_to_string(root.join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    // the first column of its table of rooms
    let rooms: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("| `"))
        .filter_map(|line| line.split('`').next())
        .collect();
    assert!(rooms.len() > 10, "the table of rooms is gone");
    for room in rooms {
        assert!(root.join(room).exists(), "{room} is named in ARCHITECTURE.md but does not exist");
    }
}
