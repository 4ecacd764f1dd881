#!/usr/bin/env bash
# Makes docs/benchmarks.md: times on this machine. Takes some twenty minutes; let the machine do nothing else.
set -euo pipefail
cd "$(dirname "$0")/.."
page=$(mktemp)
trap 'rm -f "$page"' EXIT
cargo build --release --locked

cat >"$page" <<'PAGE'
# Benchmarks

Made by `docs/benchmarks.sh`, which runs `cargo bench`, `bench/bouncing/run.sh` and
`bench/heap/run.sh`. Times are those of one machine on one day; ratios
come from one run, in which the candidates take turns, and say more.

The plain loop does the basic system for every particle: turn it, its velocity, gravity, drag, five walls with springs, force and torque. *Compiled*
is the loop as one writes it down; *vectors* is the same by hand in the widest registers of the processor. The body is a sphere of
radius 0.3 m. In *flight* it is near no wall; *bouncing*, it is thrown into the arena for 3 s; at *rest*, 5.7 % of its particles are
in contact with the floor. Dashpots and friction are tumble's alone: the loop beside them has springs only. Both loops step as `euler` does;
`splitting` pays for exact flight.

PAGE
cargo bench --locked -p tumble-bench --bench speed >>"$page"
{
    printf '\n## Bouncing, beside MuJoCo and Rapier\n\n'
    printf 'One body of 40,000 points in a closed box; [bench/README.md](../bench/README.md) has the settings that make it fair.\n\n'
    TUMBLE=$PWD/target/release/tumble bench/bouncing/run.sh
    printf '\n## A heap of clumps, beside LAMMPS\n\n'
    printf 'Clumps of eight spheres fall into an open box; [bench/README.md](../bench/README.md) says how. One core each.\n\n'
    TUMBLE=$PWD/target/release/tumble bench/heap/run.sh
    printf '\n## Heaps at rest, small and large\n\n'
    printf 'A heap of 1000 such clumps at rest, and 8 and 100 of it side by side; all take turns, medians of nine rounds.\n\n'
    cargo bench --locked -p tumble-bench --bench heaps
} >>"$page"
mv "$page" docs/benchmarks.md
chmod 644 docs/benchmarks.md
trap - EXIT
