#!/usr/bin/env bash
# Writes reports of runs of six kinds, and pictures of each as wide as a screen and as a phone:
# what docs/images shows, and what a change to the page should be looked at with. Needs
# scripts/install-deps.sh --tests, scripts/viewer-env.sh, scripts/python-env.sh and real data.
# usage: benchmarks/report_images.sh [COMMAND [FOLDER]]
#   COMMAND  default: build/release/apps/isotherm
#   FOLDER   of pages and pictures; default: build/report
# The tops of the pages go to docs/images; FOLDER has whole pages, too.
set -euo pipefail
cd "$(dirname "$0")/.."

isotherm=$(realpath "${1:-build/release/apps/isotherm}")
out=${2:-build/report}
data=${ISOTHERM_DATA:?names the folder of real data}
mkdir -p "$out"

explain() {
  local name=$1
  shift
  "$isotherm" "$@" -q --report "$out/$name.json"
  "$isotherm" report "$out/$name.json" -q -o "$out/$name.html"
}

"$isotherm" corrupt "$data/paper/kitti/kitti_00.g2o" --fraction 0.9 --seed 1 -q \
  -o "$out/kitti_00.g2o"
explain kitti prune "$out/kitti_00.g2o" --ground-truth "$data/paper/kitti/poses_00.txt"
explain bicocca prune "$data/paper/b25b/B25b_0.000.g2o" \
  --ground-truth "$data/paper/b25b/Bicocca_2009-02-25b-GT-extended.csv" \
  --timestamps "$data/paper/b25b/B25b_timestamps.txt"
explain garage prune "$data/posegraph3d/parking-garage/parking-garage.g2o"
explain robots prune "$data"/multirobot/doorslam_argos_4robots/spoiled/{0,1,2,3}.g2o
"$isotherm" simulate network --nodes 300 --degree 15 --false-fraction 0.1 --seed 1 -q \
  -o "$out/network.csv" --anchor-file "$out/anchors.csv" --ground-truth "$out/truth.csv"
explain network localize "$out/network.csv" --anchors "$out/anchors.csv" \
  --ground-truth "$out/truth.csv"
python=$(scripts/python-env.sh)
"$python" benchmarks/graphs.py --write-minnesota 0.05 "$data" "$out"
explain minnesota edges "$out/minnesota.csv" --positions "$out/positions.csv"

# The same graph by two methods, side by side.
"$isotherm" prune "$out/kitti_00.g2o" --method heat -q --report "$out/kitti-heat.json"
"$isotherm" report "$out/kitti.json" "$out/kitti-heat.json" -q -o "$out/compared.html"

node benchmarks/report_images.mjs "$out" docs/images \
  kitti bicocca garage robots network minnesota compared
# Colours of a palette take a third of the room; by octree the rare ones stay, too.
"$python" - docs/images/report-*.png <<'PYTHON'
import sys
from PIL import Image
for path in sys.argv[1:]:
    Image.open(path).convert("RGB").quantize(256, Image.Quantize.FASTOCTREE, dither=0).save(path, optimize=True)
PYTHON
