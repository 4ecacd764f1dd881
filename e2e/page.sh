#!/usr/bin/env bash
# Tests the viewer page in a browser.
# Requires node, npm and cargo; installs Chromium with apt if it is missing.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! command -v chromium >/dev/null; then
    apt-get update -q && apt-get install -y -q --no-install-recommends chromium
fi
if ! [ -d e2e/.tools/node_modules/playwright-core ]; then
    PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1 npm install --silent --no-audit --no-fund --prefix e2e/.tools playwright-core@1 ws@8
fi

cargo build --release -p tumble-cli --locked
tumble=$(realpath "${CARGO_TARGET_DIR:-target}")/release/tumble
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
for scene in task2 task2-cat racket many slope slider-crank; do
    "$tumble" run "$scene" --out "$out/$scene" >/dev/null
done
"$tumble" run many --out "$out/thousand" --duration 0.5 --set 'body.1.position=[0.0,2.5,0.0]' \
    --set 'body.0.copies={count=[10,5,10],spacing=[0.18,0.2,0.18],seed=1}' \
    --set 'body.1.copies={count=[10,5,10],spacing=[0.18,0.2,0.18],seed=2}' >/dev/null
mkdir "$out/scenes"
cat >"$out/scenes/<img src=x onerror=alert(1)> & <!--.toml" <<'SCENE'
# names that mean something in HTML
duration = 0.1
[[body]]
name = "</script><script>alert(1)</script><!--"
shape = "sphere"
[[body]]
name = "<img src=x onerror=alert(2)> &amp; 'it'"
shape = "sphere"
position = [1, 0, 0]
SCENE
"$tumble" run "$out/scenes/<img src=x onerror=alert(1)> & <!--.toml" --out "$out/names" >/dev/null

node e2e/page.mjs "$out" "$@"
# the tests with a real server, unless a single test was selected
[ -n "${2:-}" ] || node e2e/live.mjs "$tumble" "$@"
