#!/usr/bin/env bash
# Runs every scene of docs/classics.md with the program TUMBLE: docs/classics.sh TUMBLE
set -euo pipefail
tumble=$(realpath "$1")
page=$(dirname "$(realpath "$0")")/classics.md
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
# a file for each block
awk -v out="$out" '/^```toml/ { file = sprintf("%s/%02d.toml", out, ++count); next } /^```/ { file = "" } file { print > file }' "$page"
for scene in "$out"/*.toml; do
    "$tumble" run "$scene" --out "${scene%.toml}" >/dev/null || { cat "$scene"; exit 1; }
done
ls "$out"/*.toml | wc -l
