//! The paths in ARCHITECTURE.md exist.

use std::path::Path;

#[test]
fn every_path_that_the_architecture_names_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = std::fs::read_to_string(root.join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    // the first column of its table
    let paths: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("| `"))
        .filter_map(|line| line.split('`').next())
        .collect();
    assert!(paths.len() > 10, "the table of paths is missing");
    for path in paths {
        assert!(root.join(path).exists(), "{path} is named in ARCHITECTURE.md but does not exist");
    }
}
