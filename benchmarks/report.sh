#!/usr/bin/env bash
# Writes the report of a graph of 100,000 poses and 100,000 loop closures, and opens it in
# a headless browser. Loops are judged by the method that decides fastest. Needs
# scripts/install-deps.sh --tests and scripts/viewer-env.sh.
# usage: benchmarks/report.sh [BUILD FOLDER]     (default: build/release)
set -euo pipefail
cd "$(dirname "$0")/.."

isotherm=$PWD/${1:-build/release}/apps/isotherm
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

timed() {
  local label=$1
  shift
  local TIMEFORMAT="$label: %R s elapsed, %U s of CPU"
  time "$@"
}

truth=(--ground-truth "$out/truth.g2o")
$isotherm simulate city --poses 100000 --loops 100000 --seed 1 -o "$out/city.g2o" "${truth[@]}" -q
prune=("$isotherm" prune "$out/city.g2o" --method chi2 --quiet)
timed "prune" "${prune[@]}" -o "$out/pruned.g2o"
timed "optimize" "$isotherm" optimize "$out/pruned.g2o" -o "$out/map.g2o" --quiet
echo "load: $(cut -d' ' -f1 /proc/loadavg) on $(nproc) cores"
timed "prune with report (holds both)" "${prune[@]}" "${truth[@]}" --report "$out/report.json"
timed "report from the saved document" "$isotherm" report "$out/report.json" -o "$out/report.html"
echo "page: $(stat -c %s "$out/report.html") bytes"
node benchmarks/report_view.mjs "$out/report.html" 5
