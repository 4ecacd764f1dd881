# Functions of the run.sh scripts, which source this file from their own folder. It creates a temporary folder `scratch` and a
# list `skipped` of what could not be installed or run, and lets Python import common.py.
# Environment: TUMBLE, path of a built tumble (default: build it).
venv=$PWD/../.venv
python=$venv/bin/python
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
log=$scratch/log
skipped=()
export PYTHONPATH=$PWD/.. RAYON_NUM_THREADS=1 OMP_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1

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

require() { # require NAME PACKAGE…: creates the virtual environment if needed, and installs what the scripts cannot do without
    [ -x "$python" ] || python3 -m venv "$venv"
    install "$@" && return
    echo "$1: required. ${skipped[*]}" >&2
    exit 1
}

find_tumble() { # sets `tumble` to the path of the program
    tumble=${TUMBLE:-}
    if [ -z "$tumble" ]; then
        echo "build tumble" >&2
        cargo build --release --locked -p tumble-cli --manifest-path ../../Cargo.toml >&2
        tumble=${CARGO_TARGET_DIR:-$PWD/../../target}/release/tumble
    fi
    tumble=$(realpath "$tumble")
}

build_rapier() { # build_rapier NAME: builds the program of rapier/ and sets `rapier` to its path
    echo "build Rapier" >&2
    local target=${RAPIER_TARGET:-$PWD/rapier/target}
    if cargo build --release --locked --manifest-path rapier/Cargo.toml --target-dir "$target" >"$log" 2>&1; then
        rapier=$target/release/$1
        return
    fi
    skipped+=("Rapier: not built: $(last_log_line)")
    return 1
}

find_core() { # sets `pin` to the command that runs a program on one core, the last one
    pin=()
    command -v taskset >/dev/null || return 0
    local last
    last=$(sed -n 's/^Cpus_allowed_list:.*[^0-9]\([0-9]*\)$/\1/p' /proc/self/status)
    if taskset -c "${last:-0}" true 2>/dev/null; then pin=(taskset -c "${last:-0}"); fi
}

machine() { # the machine and the versions, in one line
    echo "$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1); $(uname -sm); $("$python" --version);" \
        "$(rustc --version 2>/dev/null | cut -d ' ' -f 1-2); ${pin[*]:-not pinned to a core}"
}

print_skipped() { # the last line of the results
    if [ ${#skipped[@]} -eq 0 ]; then
        echo "Nothing was skipped."
    else
        printf 'Skipped: %s\n' "${skipped[@]}"
    fi
}
