//! The oldest supported Rust (`rust-version`) is not newer than the compiler and not older than what a dependency needs.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

#[test]
fn the_installed_compiler_is_at_least_the_oldest_supported_one() {
    let oldest = parse(env!("CARGO_PKG_RUST_VERSION"));
    // "rustc 1.95.0 (…)", "rustc 1.97.0-nightly (…)"
    let text = output("rustc", &["--version"]);
    let installed = text.split([' ', '-']).nth(1).map(parse).expect("a version");
    assert!(installed >= oldest, "Cargo.toml needs Rust {oldest:?} or newer, but this is {text}");
}

#[test]
fn no_dependency_needs_a_newer_compiler_than_the_oldest_supported_one() {
    let oldest = parse(env!("CARGO_PKG_RUST_VERSION"));
    let host = output("rustc", &["-vV"]);
    let host = host.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    // only the packages for this platform: these are on the disk, so the test needs no network
    let metadata = output(
        env!("CARGO"),
        &["metadata", "--format-version=1", "--locked", "--filter-platform", host],
    );
    let metadata: Value = serde_json::from_str(&metadata).expect("the metadata of cargo");
    let packages = metadata["packages"].as_array().expect("a list of packages");
    assert!(packages.len() > 50, "the list of packages is too short: {}", packages.len());
    for package in packages {
        // a package that names no version makes no claim
        let Some(needed) = package["rust_version"].as_str() else { continue };
        let (name, version) = (&package["name"], &package["version"]);
        assert!(
            parse(needed) <= oldest,
            "{name} {version} needs Rust {needed}: raise rust-version in Cargo.toml, which is now {oldest:?}"
        );
    }
}

/// "1.89" or "1.89.0" as numbers.
fn parse(version: &str) -> [u32; 3] {
    let mut parts = version.split('.').map(|part| part.trim().parse().expect("a number"));
    std::array::from_fn(|_| parts.next().unwrap_or(0))
}

/// What a command prints when run in the workspace.
fn output(command: &str, args: &[&str]) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let output = Command::new(command).args(args).current_dir(root).output();
    let output = output.unwrap_or_else(|error| panic!("{command}: {error}"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}
