#!/usr/bin/env bash
# Writes the report of a graph of 100,000 poses and 100,000 loop closures, 10,000 of them
# false, and opens it in a headless browser. Needs scripts/install-deps.sh --tests and
# scripts/viewer-env.sh.
# usage: benchmarks/report.sh [BUILD FOLDER [METHOD]]     (default: build/release, consensus)
set -euo pipefail
cd "$(dirname "$0")/.."

isotherm=/tmp/vt/bb/apps/isotherm
method=${2:-consensus}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

timed() {
  local label=$1
  shift
  local TIMEFORMAT="$label: %R s elapsed, %U s of CPU"
  time "$@"
}

truth=(--ground-truth "$out/truth.g2o")
$isotherm simulate city --poses 100000 --loops 90000 --seed 1 -o "$out/clean.g2o" "${truth[@]}" -q
$isotherm corrupt "$out/clean.g2o" "${truth[@]}" --count 10000 --seed 1 -o "$out/bad.g2o" -q
prune=("$isotherm" prune "$out/bad.g2o" --method "$method" --quiet)
timed "prune" "${prune[@]}" -o "$out/pruned.g2o"
timed "optimize" "$isotherm" optimize "$out/pruned.g2o" -o "$out/map.g2o" --quiet
timed "prune with report (holds both)" "${prune[@]}" "${truth[@]}" --report "$out/report.json"
timed "report from the saved document" "$isotherm" report "$out/report.json" -o "$out/report.html"
echo "page: $(stat -c %s "$out/report.html") bytes"
node benchmarks/report_view.mjs "$out/report.html" 5
