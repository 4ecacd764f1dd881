#!/usr/bin/env bash
# Generates docs/benchmarks.md with the times of this machine. Takes about an hour. Keep the machine otherwise idle.
set -euo pipefail
cd "$(dirname "$0")/.."
page=$(mktemp)
trap 'rm -f "$page"' EXIT
cargo build --release --locked

cat >"$page" <<'PAGE'
# Benchmarks

`docs/benchmarks.sh` generates this page. It runs `cargo bench`, `bench/bouncing/run.sh`, `bench/heap/run.sh` and `bench/big_steps/run.sh`.
The times of each section are from one machine. The ratios are more meaningful than the times: they compare candidates that took turns in
the same run.

The plain loop evaluates the basic system for every particle: its rotation, its velocity, gravity, drag, the springs of five walls, force and torque.
*Compiled* is scalar code that the compiler optimises. *Vectors* is the same loop written with explicit vectors for the widest registers of the
processor. The body is a sphere of radius 0.3 m. In *flight* it is far from every wall. *Bouncing*, it is thrown into the arena for 3 s. At *rest*, 5.7 % of
its particles are in contact with the floor. Only tumble has dashpots and friction; the loop in those rows has springs only. Both loops use
the `euler` integrator. `splitting` costs more per step and integrates free flight exactly.

PAGE
cargo bench --locked -p tumble-bench --bench speed >>"$page"
{
    printf '\n## Bouncing body, compared with MuJoCo and Rapier\n\n'
    printf 'One body of 40,000 points bounces in a closed box. [bench/README.md](../bench/README.md) describes the settings of each engine.\n\n'
    TUMBLE=$PWD/target/release/tumble bench/bouncing/run.sh
    printf '\n## Heap of clumps, compared with LAMMPS\n\n'
    printf 'Clumps of eight spheres fall into an open box, simulated on one core. [bench/README.md](../bench/README.md) describes the set-up.\n\n'
    TUMBLE=$PWD/target/release/tumble bench/heap/run.sh
    printf '\n## Big steps, compared with LAMMPS, Rapier and MuJoCo\n\n'
    printf 'The heap of 1000 clumps with `integrator = "implicit"`, compared with `splitting` and with other programs. '
    printf '[bench/README.md](../bench/README.md) describes the set-up. '
    printf 'The heaps on two cores consist of 1, 8 and 100 copies of a heap of 1000 such clumps at rest. They are timed in turns; '
    printf 'values are medians of nine rounds.\n\n'
    TUMBLE=$PWD/target/release/tumble PICTURE=$PWD/docs/pictures/big_steps.svg bench/big_steps/run.sh
    printf '\n![penetration and cost](pictures/big_steps.svg)\n'
} >>"$page"
mv "$page" docs/benchmarks.md
chmod 644 docs/benchmarks.md
trap - EXIT
