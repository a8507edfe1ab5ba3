#!/usr/bin/env bash
# Installs what is missing, builds the command, and runs the main job on a graph
# that is simulated here: corrupt it, prune it, compare with the truth.
# usage: scripts/quickstart.sh [output folder, default out/quickstart]
set -euo pipefail
cd "$(dirname "$0")/.."

out=${1:-out/quickstart}
isotherm=build/release/apps/isotherm

scripts/install-deps.sh
scripts/build.sh release
mkdir -p "$out"

echo
echo "== A city of 2,000 poses with 800 loop closures, and 400 false ones =="
$isotherm simulate city --poses 2000 --loops 800 --seed 1 \
  -o "$out/clean.g2o" --ground-truth "$out/truth.g2o"
$isotherm corrupt "$out/clean.g2o" --ground-truth "$out/truth.g2o" --count 400 --seed 1 \
  -o "$out/corrupted.g2o" --labels "$out/labels.csv"

echo
echo "== Prune =="
$isotherm prune "$out/corrupted.g2o" -o "$out/pruned.g2o" \
  --verdicts "$out/verdicts.csv" --json "$out/result.json" \
  --report "$out/report.html" --ground-truth "$out/truth.g2o"

echo
echo "== Optimise what is left, and for comparison what came in =="
$isotherm optimize "$out/pruned.g2o" -o "$out/map.g2o"
$isotherm optimize "$out/corrupted.g2o" -o "$out/ruined.g2o"

echo
echo "== Against the truth =="
$isotherm eval loops "$out/verdicts.csv" "$out/labels.csv"
echo "trajectory error of the pruned map:"
$isotherm eval ate "$out/map.g2o" "$out/truth.g2o" --align se
echo "without pruning:"
$isotherm eval ate "$out/ruined.g2o" "$out/truth.g2o" --align se

echo
echo "== Written to $out =="
ls -1 "$out"

echo
echo "== See what was pruned, and why =="
echo "open this file in a browser: file://$(realpath "$out/report.html")"
