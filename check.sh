#!/usr/bin/env bash
# The checks that a change must pass; the same for a person and for CI.
# With --e2e, those that need a browser and other programs to judge exports; it installs them.
set -euo pipefail
cd "$(dirname "$0")"

# Whoever checks twice gets the same answer twice: random tests take the same cases. `cargo test` alone takes new ones.
export PROPTEST_RNG_SEED=2026

say() { printf '\n== %s\n' "$1"; }

if [ "${1:-}" = --e2e ]; then
    say "the page in a browser"
    e2e/page.sh
    say "exports, by the programs that read them"
    e2e/exports.sh
    say "all end-to-end checks passed"
    exit
fi

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

say "format"
cargo fmt --all --check

say "lints"
cargo clippy --workspace --all-targets --locked -- -D warnings

say "tests (the README's command)"
cargo test --locked

say "examples of the library"
for example in crates/tumble/examples/*.rs; do
    echo "-- $(basename "$example" .rs)"
    cargo run --quiet --release --locked -p tumble --example "$(basename "$example" .rs)" > "$out/example" || {
        cat "$out/example"
        exit 1
    }
done

say "tests of the cat's modeller, and the cat as it would model it again"
cargo test --release -p tumble-modeller --locked

say "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

say "every built-in scene"
cargo build --release --locked
for scene in $(target/release/tumble scenes | awk '{ print $1 }'); do
    target/release/tumble run "$scene" --out "$out/$scene"
done

say "every scene of docs/classics.md"
docs/classics.sh target/release/tumble

say "physics against theory"
target/release/tumble verify

say "hostile input: a bounded run of every fuzz target"
fuzz/run.sh 10

say "packages: each published crate builds from what it would upload"
# In a folder of its own: Cargo unpacks a package once for each path it was made in, and never looks whether it has changed.
cargo publish --workspace --dry-run --allow-dirty --locked --target-dir "$out/packages"

say "all checks passed"
