#!/usr/bin/env bash
# Fuzzes every target for SECONDS each (default 20), or only the named ones:
#     fuzz/run.sh [SECONDS] [TARGET…]
# Needs a nightly toolchain and a C++ compiler; without a nightly toolchain it says so and skips.
# Inputs that make a target fail are saved in fuzz/findings/; the corpus grows in fuzz/corpus/ (neither is in git).
set -euo pipefail
cd "$(dirname "$0")"

seconds=${1:-20}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(scene obj stl ply gltf checkpoint)

if ! cargo +nightly --version >/dev/null 2>&1; then
    echo "fuzz: skipped, no nightly toolchain (rustup toolchain install nightly)"
    exit 0
fi

# with an explicit target triple, the flags below do not apply to build scripts
triple=$(rustc +nightly -vV | sed -n 's/^host: //p')
folder=${CARGO_TARGET_DIR:-target}
# the coverage instrumentation of libFuzzer (as cargo-fuzz sets it) and the address sanitizer
export RUSTFLAGS="--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1 -Zsanitizer=address"
cargo +nightly build --release --locked --target "$triple"

failed=()
mkdir -p findings
for target in "${targets[@]}"; do
    echo "== fuzz $target, $seconds s"
    mkdir -p "corpus/$target"
    options=(-max_total_time="$seconds" -rss_limit_mb=1024 -timeout=10 -max_len=4096
        -artifact_prefix="findings/$target-" -print_final_stats=1 -verbosity=0)
    [ ! -f "dictionaries/$target" ] || options+=(-dict="dictionaries/$target")
    "$folder/$triple/release/$target" "${options[@]}" "corpus/$target" "seeds/$target" ||
        failed+=("$target")
done

if [ ${#failed[@]} -gt 0 ]; then
    echo "fuzz: findings in ${failed[*]}; see fuzz/findings/"
    exit 1
fi
echo "fuzz: nothing found"
