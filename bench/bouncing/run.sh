#!/usr/bin/env bash
# Simulates one body of 40,000 points that bounces in a closed box with several engines. Prints Markdown tables to standard
# output, progress to standard error.
# Environment: TUMBLE, path of a built tumble (default: build it); ROUNDS, number of timing rounds (3);
# RAPIER_TARGET, target folder of the Rapier program (rapier/target).
set -euo pipefail
cd "$(dirname "$0")"
venv=$PWD/../.venv
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
log=$scratch/log
skipped=()
engines=()

install() { # install NAME PACKAGE…: installs into the virtual environment
    local name=$1
    shift
    echo "install $name" >&2
    "$venv/bin/pip" install --quiet --disable-pip-version-check "$@" >"$log" 2>&1 && return
    skipped+=("$name: not installed: $(grep -v '^ *$' "$log" | tail -n 1)")
    return 1
}

tumble=${TUMBLE:-}
if [ -z "$tumble" ]; then
    echo "build tumble" >&2
    cargo build --release --locked -p tumble-cli --manifest-path ../../Cargo.toml >&2
    tumble=${CARGO_TARGET_DIR:-$PWD/../../target}/release/tumble
fi
tumble=$(realpath "$tumble")
engines+=("tumble=$tumble")

[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
python=$venv/bin/python
if ! install "NumPy and SciPy" numpy==2.4.6 scipy==1.17.1; then
    echo "NumPy and SciPy are required. ${skipped[*]}" >&2
    exit 1
fi
if install MuJoCo mujoco==4.0.0; then engines+=("mujoco=yes"); fi

echo "build Rapier" >&2
target=${RAPIER_TARGET:-$PWD/rapier/target}
if cargo build --release --locked --manifest-path rapier/Cargo.toml --target-dir "$target" >"$log" 2>&1; then
    engines+=("rapier=$target/release/bouncing-rapier")
else
    skipped+=("Rapier: not built: $(grep -v '^ *$' "$log" | tail -n 1)")
fi

# run all engines on one core, the last one
pin=()
if command -v taskset >/dev/null; then
    last=$(sed -n 's/^Cpus_allowed_list:.*[^0-9]\([0-9]*\)$/\1/p' /proc/self/status)
    if taskset -c "${last:-0}" true 2>/dev/null; then pin=(taskset -c "${last:-0}"); fi
fi

"$python" body.py "$scratch"
echo "Machine: $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1); $(uname -sm);" \
    "$("$python" --version); $(rustc --version | cut -d ' ' -f 1-2);" \
    "${pin[*]:-not pinned to a core}; median of ${ROUNDS:-3} rounds."
echo
"${pin[@]}" "$python" compare.py "$scratch" "${ROUNDS:-3}" "${engines[@]}"
if [ ${#skipped[@]} -eq 0 ]; then
    echo "Nothing was skipped."
else
    printf 'Skipped: %s\n' "${skipped[@]}"
fi
