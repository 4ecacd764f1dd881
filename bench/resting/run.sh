#!/usr/bin/env bash
# Simulates six scenes of boxes at rest on each other with several engines. Prints a Markdown table for each scene to standard
# output, progress to standard error.
# Environment: TUMBLE, path of a built tumble (default: build it); RAPIER_TARGET, target folder of the Rapier program
# (rapier/target).
set -euo pipefail
cd "$(dirname "$0")"
source ../common.sh

find_tumble
engines=("tumble=$tumble")
require NumPy numpy==2.4.6
if install MuJoCo mujoco==4.0.0; then engines+=("mujoco=yes"); fi
if build_rapier resting-rapier; then engines+=("rapier=$rapier"); fi
find_core

"${pin[@]}" "$python" compare.py "${engines[@]}" >"$scratch/tables"
echo "Machine: $(machine); load $(cut -d ' ' -f 1-3 /proc/loadavg) at the end."
echo
cat "$scratch/tables"
print_skipped
