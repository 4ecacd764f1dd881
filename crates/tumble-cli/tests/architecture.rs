//! The paths in ARCHITECTURE.md exist.

use std::path::Path;

#[test]
fn every_path_that_the_architecture_names_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = std::fs::read_to_string(root.join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    // all in the first column of its table, and every other one that is written from the root
    let in_table = text
        .lines()
        .filter(|line| line.starts_with("| `"))
        .filter_map(|line| line.split('|').nth(1))
        .flat_map(in_backticks);
    let from_root = in_backticks(&text).filter(|path| path.starts_with("crates/"));
    let paths: Vec<&str> = in_table.chain(from_root).collect();
    assert!(paths.len() > 10, "the table of paths is missing");
    for path in paths {
        assert!(root.join(path).exists(), "{path} is named in ARCHITECTURE.md but does not exist");
    }
}

fn in_backticks(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}
