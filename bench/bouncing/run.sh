#!/usr/bin/env bash
# Simulates one body of 40,000 points that bounces in a closed box with several engines. Prints Markdown tables to standard
# output, progress to standard error.
# Environment: TUMBLE, path of a built tumble (default: build it); ROUNDS, number of timing rounds (3);
# RAPIER_TARGET, target folder of the Rapier program (rapier/target).
set -euo pipefail
cd "$(dirname "$0")"
source ../common.sh

find_tumble
engines=("tumble=$tumble")
require "NumPy and SciPy" numpy==2.4.6 scipy==1.17.1
if install MuJoCo mujoco==4.0.0; then engines+=("mujoco=yes"); fi
if build_rapier bouncing-rapier; then engines+=("rapier=$rapier"); fi
find_core

"$python" body.py "$scratch"
echo "Machine: $(machine); median of ${ROUNDS:-3} rounds."
echo
"${pin[@]}" "$python" compare.py "$scratch" "${ROUNDS:-3}" "${engines[@]}"
print_skipped
