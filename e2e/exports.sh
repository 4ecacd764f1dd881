#!/usr/bin/env bash
# Validates the files written by `tumble export` with the Khronos glTF validator, the USD validators, VTK and
# ffmpeg. Installs them into e2e/; requires node, npm and python3.
#
#   e2e/exports.sh [TUMBLE]     TUMBLE is the program to test; without it, it is built
set -euo pipefail
cd "$(dirname "$0")"

tumble=${1:-}
if [ -z "$tumble" ]; then
    cargo build --release --locked --manifest-path ../Cargo.toml -p tumble-cli
    tumble=$(cargo metadata --format-version 1 --no-deps --manifest-path ../Cargo.toml |
        python3 -c 'import json, sys; print(json.load(sys.stdin)["target_directory"])')/release/tumble
fi
tumble=$(realpath "$tumble")

[ -d node_modules/gltf-validator ] || npm install --no-audit --no-fund --no-package-lock --no-save gltf-validator@2.0.0-dev.3.10
if [ ! -x .venv/bin/python ] || ! .venv/bin/python -c 'import pxr, pyvista' 2>/dev/null; then
    python3 -m venv .venv
    .venv/bin/pip install --quiet usd-core==26.11 pyvista==0.49.1
fi
if ! command -v ffprobe > /dev/null; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends ffmpeg > /dev/null
fi

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cat > "$out/points.toml" << 'SCENE'
# bare particles, gravity along -z, names that must be escaped in XML, USD, JSON or HTML
duration = 0.5
gravity = [0.0, 0.0, -9.8]
wall = [{ normal = [0.0, 0.3, 1.0] }]
[[body]]
name = "0 <points> & \\ öß"
particles = [[0, 0, 0], [0.3, 0, 0], [0, 0.2, 0], [0, 0, 0.5]]
position = [0.0, 0.0, 1.0]
initial_angular_velocity = [1.0, 2.0, 3.0]
[[body]]
name = "</script><!-- it's"
particles = [[0, 0, 0], [0.3, 0, 0]]
position = [1.0, 0.0, 1.0]
[[body]]
name = "../../Shapes {def} ]]> $HOME `id`"
particles = [[0, 0, 0], [0.3, 0, 0]]
position = [2.0, 0.0, 1.0]
[[body]]
name = "=1+1"
particles = [[0, 0, 0], [0.3, 0, 0]]
position = [3.0, 0.0, 1.0]
SCENE

"$tumble" run racket --out "$out/racket" --duration 3 > /dev/null
"$tumble" run task2-cat --out "$out/cat" --duration 0.3 > /dev/null
"$tumble" run many --out "$out/many" --duration 0.6 > /dev/null
"$tumble" run "$out/points.toml" --out "$out/points" > /dev/null

for scene in racket cat many points; do
    for format in glb usda pvd csv; do
        "$tumble" export "$out/$scene" --to "$out/$scene.$format"
    done
    "$tumble" export "$out/$scene" --to "$out/$scene.png" --size 640x400
    "$tumble" export "$out/$scene" --to "$out/$scene.gif" --size 400x250
    "$tumble" export "$out/$scene" --to "$out/$scene.mp4" --size 399x251
    node gltf.js "$out/$scene.glb"
    .venv/bin/python exports.py "$out" "$scene"
done
echo "all exports are valid"
