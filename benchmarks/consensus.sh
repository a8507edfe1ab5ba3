#!/usr/bin/env bash
# Consensus on clean, corrupted, real and drifting pose graphs.
# Writes docs/results/consensus.md. Every row is kept in build/consensus-rows, so
# that an interrupted run goes on where it stopped; remove the folder to start anew.
# usage: benchmarks/consensus.sh [--quick] [--rows-so-far] [data folder]
#   --quick        one seed, two fractions, of the larger graphs three types
#   --rows-so-far  writes the page from the rows that are there, and measures nothing
#   data folder    default $ISOTHERM_DATA or ../shared/data
# ISOTHERM names the command to measure; without it, the release preset is built.
# The comparison with GTSAM and g2o needs their Python packages: see consensus_peers.py (PYTHON names
# the interpreter; default .venv/bin/python).
set -euo pipefail
cd "$(dirname "$0")/.."

quick=false
measure=true
if [ "${1:-}" = --quick ]; then quick=true; shift; fi
if [ "${1:-}" = --rows-so-far ]; then measure=false; shift; fi
data=${1:-${ISOTHERM_DATA:-../shared/data}}
isotherm=${ISOTHERM:-build/release/apps/isotherm}
page=docs/results/consensus.md
rows=build/consensus-rows
python=${PYTHON:-.venv/bin/python}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ ! -d "$data" ]; then echo "consensus: no folder $data" >&2; exit 1; fi
if $measure && [ -z "${ISOTHERM:-}" ]; then scripts/build.sh release >/dev/null; fi
mkdir -p "$rows"
missing=0

seeds="1 2 3"; fractions="0.1 0.3 0.5 0.7 0.9"
corrupted="intel CSAIL kitti_00 kitti_02 ringCity"
types="random local random-grouped local-grouped all-random"
large="city10000 sphere2500 torus3D parking-garage cubicle"
large_styles="vertigo paper"; large_types=$types; large_fractions="0.5 0.1"
large_seeds=$seeds; large_once=0.9  # a fraction measured with seed 1 only
clean="MIT CSAIL intel ais2klinik ring ringCity city10000 kitti_00 kitti_02 kitti_06 kitti_07 kitti_09
  B25b_0.600 tinyGrid3D smallGrid3D parking-garage sphere2500 torus3D cubicle"
if $quick; then
  seeds=1; fractions="0.5 0.9"
  large_styles=vertigo; large_types="random random-grouped local-grouped"; large_fractions=0.5
  large_seeds=1; large_once=""
fi

path_of() {
  case $1 in
    kitti_*) echo "$data/paper/kitti/$1.g2o" ;;
    B25b_*) echo "$data/paper/b25b/$1.g2o" ;;
    intel | CSAIL | MIT | ais2klinik | city10000) echo "$data/posegraph2d/$1/$1.g2o" ;;
    ring | ringCity) echo "$data/posegraph2d/$1/originalDataset/$1.g2o" ;;
    torus3D) echo "$data/posegraph3d/torus3D/torus3D.g2o.gz" ;;
    *) echo "$data/posegraph3d/$1/$1.g2o" ;;
  esac
}

# field FILE KEY: a top-level number of a JSON result.
field() { sed -n "s/^  \"$2\": \(-\{0,1\}[0-9.e-]*\),\{0,1\}$/\1/p" "$1"; }

# cached NAME command...: prints the row of that name, made at most once.
cached() {
  local row=$rows/${1//\//_}
  shift
  if [ ! -f "$row" ]; then
    if ! $measure; then missing=$((missing + 1)); return; fi
    "$@" >"$row.part"
    mv "$row.part" "$row"
  fi
  cat "$row"
}

# prune arguments...: on one thread; the CPU time it takes goes to $work/seconds.
TIMEFORMAT=%U
prune() { { time $isotherm prune --threads 1 -q "$@" 2>&3; } 3>&2 2>"$work/seconds"; }

# judge NAME GRAPH LABELS: a row with the figures of pruning.
judge() {
  prune "$2" -o "$work/pruned.g2o" --verdicts "$work/v.csv" --json "$work/p.json"
  $isotherm eval loops "$work/v.csv" "$3" --json "$work/e.json" >/dev/null
  printf '| %s | %.4f | %.4f | %s | %s | %s | %.2f |' "$1" "$(field "$work/e.json" precision)" \
    "$(field "$work/e.json" recall)" "$(field "$work/e.json" fp)" "$(field "$work/e.json" fn)" \
    "$(field "$work/p.json" ambiguous)" "$(cat "$work/seconds")"
}

clean_row() {
  prune "$(path_of "$1")" --json "$work/p.json"
  printf '| %s | %s | %s | %s | %.2f |\n' "$1" "$(field "$work/p.json" candidates)" \
    "$(field "$work/p.json" pruned)" "$(field "$work/p.json" ambiguous)" \
    "$(cat "$work/seconds")"
}

corrupt_row() {
  local graph=$1 style=$2 type=$3 fraction=$4 seed=$5 truth=$rows/$1.optimum.g2o
  if [ ! -f "$truth" ]; then $isotherm optimize "$(path_of "$graph")" -o "$truth" -q; fi
  $isotherm corrupt "$(path_of "$graph")" --ground-truth "$truth" --style "$style" --type "$type" \
    --fraction "$fraction" --seed "$seed" -o "$work/bad.g2o" --labels "$work/l.csv" -q
  judge "$graph, $style $type $fraction, seed $seed" "$work/bad.g2o" "$work/l.csv"
  echo
}

# corrupt_rows GRAPH STYLES TYPES FRACTIONS SEEDS: one row for each combination.
corrupt_rows() {
  local style type fraction seed
  for style in $2; do
    for type in $3; do
      for fraction in $4; do
        for seed in $5; do
          cached "corrupt-$1-$style-$type-$fraction-$seed" \
            corrupt_row "$1" "$style" "$type" "$fraction" "$seed"
        done
      done
    done
  done
}

shared_row() {
  judge "$1" "$data/outliers/$1.g2o.gz" "$data/outliers/$1.labels.csv"
  echo
}

# real_row NAME GRAPH TRUTH STAMPS GAP LABEL_OPTIONS...: pruning, pruning where loops
# within 1 m of the limit are ignored, and the optimised trajectory.
real_row() {
  local name=$1 graph=$2 truth=$3 stamps=$4 gap=$5
  shift 5
  $isotherm label "$graph" --ground-truth "$truth" --timestamps "$stamps" "$@" -o "$work/l.csv" -q
  judge "$name" "$graph" "$work/l.csv"
  printf ' %.4f |' "$(field "$work/e.json" f1)"
  $isotherm label "$graph" --ground-truth "$truth" --timestamps "$stamps" "$@" --ignore-band 1 \
    -o "$work/l.csv" -q
  $isotherm eval loops "$work/v.csv" "$work/l.csv" --json "$work/e.json" >/dev/null
  printf ' %.4f | %.4f |' "$(field "$work/e.json" precision)" "$(field "$work/e.json" recall)"
  for kernel in none cauchy "sc --kernel-width 3"; do
    # shellcheck disable=SC2086  # a kernel and its width
    $isotherm optimize "$work/pruned.g2o" --kernel $kernel -o "$work/o.g2o" -q
    $isotherm eval ate "$work/o.g2o" "$truth" --timestamps "$stamps" --max-gap "$gap" --align se \
      --json "$work/a.json" >/dev/null
    printf ' %.3f |' "$(field "$work/a.json" rmse)"
  done
  echo
}

b25b_row() {
  real_row "$1" "$2" "$data/paper/b25b/Bicocca_2009-02-25b-GT-extended.csv" \
    "$data/paper/b25b/B25b_timestamps.txt" 0.25
}

# Ten vertices a row of ground truth, and no times: those are told by position.
bovisa_row() {
  local folder=$data/posegraph2d/bovisa04
  awk '/^VERTEX_SE2/ { printf "%.6f,%s,%s,%s\n", ++row * 11393 / 1140, $3, $4, $5 }' \
    "$folder/Bovisa04_GT_GPS.g2o" >"$work/bovisa.csv"
  seq 0 11392 >"$work/bovisa.txt"
  real_row "Bovisa04" "$folder/Bovisa04_odometry_bow_tr.g2o" "$work/bovisa.csv" \
    "$work/bovisa.txt" 10 --max-translation-error 5 --max-rotation-error 3.2
}

large_row() {
  $isotherm simulate city --poses "$1" --loops $(($1 / 2)) --seed 1 -o "$work/c.g2o" \
    --ground-truth "$work/gt.g2o" -q
  $isotherm corrupt "$work/c.g2o" --ground-truth "$work/gt.g2o" --fraction 0.5 --seed 1 \
    -o "$work/bad.g2o" --labels "$work/l.csv" -q
  judge "$1 poses" "$work/bad.g2o" "$work/l.csv"
  echo
}

drift_row() {
  local drift=$1 group=$2 seed=$3
  $isotherm simulate city --poses 3500 --drift "$drift" --seed "$seed" -o "$work/c.g2o" \
    --ground-truth "$work/gt.g2o" -q
  $isotherm corrupt "$work/c.g2o" --ground-truth "$work/gt.g2o" --type random-grouped \
    --fraction 0.5 --group-size "$group" --seed "$seed" -o "$work/bad.g2o" --labels "$work/l.csv" -q
  judge "$drift m, groups of $group, seed $seed" "$work/bad.g2o" "$work/l.csv"
  echo
}

peer_rows() { "$python" benchmarks/consensus_peers.py "$isotherm" "$data"; }

figures='| graph | precision | recall | true pruned | false not pruned | ambiguous | seconds |
|---|---|---|---|---|---|---|'

{
  cat <<'HEAD'
# Consensus: measured

Made by `benchmarks/consensus.sh` at default options for every file. A positive is a
pruned loop; false loops that are ambiguous count as not pruned. Injected loops are
labelled at the optimum of the clean graph, real ones by ground truth (2 m, 0.5 rad).
Seconds are CPU time of `isotherm prune --threads 1`, reading and writing included.
HEAD
  if $quick; then
    echo "This page is of a \`--quick\` run."
  fi
  printf '\n## Clean graphs\n\n| graph | loops | pruned | ambiguous | seconds |\n|---|---|---|---|---|\n'
  for graph in $clean; do cached "clean-$graph" clean_row "$graph"; done
  printf '\n## Injected false loops beside the figures of other programs\n\n%s\n' "$figures"
  for file in "$data"/outliers/*.g2o.gz; do
    name=$(basename "$file" .g2o.gz)
    cached "shared-$name" shared_row "$name"
  done
  printf '\n## Real false loops, and the five noise types on top\n\n'
  printf 'α and lc-...: Bicocca. The second precision and recall ignore loops whose error is within\n'
  printf '1 m of the limit of 2 m (Bovisa04: 5 m, any rotation, since its ground truth is coarse).\n'
  printf 'RMSE in metres after rigid alignment of the optimised result, without a kernel and with\n'
  printf 'Cauchy at its default width or switchable constraints at 3, the mean of chi-squared\n'
  printf 'of a true loop.\n\n'
  printf '%s F | precision, 1 m ignored | recall, 1 m ignored | RMSE | Cauchy | SC |\n' "${figures%%$'\n'*}"
  printf '%s---|---|---|---|---|---|\n' "${figures##*$'\n'}"
  cached bovisa04 bovisa_row
  for alpha in 0.000 0.100 0.200 0.300; do
    cached "b25b-$alpha" b25b_row "α = $alpha" "$data/paper/b25b/B25b_$alpha.g2o"
  done
  for file in "$data"/paper/b25b_noise5/*.g2o; do
    name=$(basename "$file" .g2o)
    cached "b25b-$name" b25b_row "${name#B25b_0.000-}" "$file"
  done
  printf '\n## Drift: cities of 3,500 poses, half of the loops false and in groups\n\n%s\n' "$figures"
  for drift in 5 20 40; do
    for group in 5 10 20; do
      for seed in $seeds; do cached "drift-$drift-$group-$seed" drift_row "$drift" "$group" "$seed"; done
    done
  done
  printf '\n## CPU time beside GTSAM and g2o\n\n'
  printf 'Half of the loops false (vertigo, random, seed 1), `benchmarks/consensus_peers.py`: the whole\n'
  printf 'command on one thread beside `GncLMOptimizer` and g2o with `RobustKernelDCS`, both from odometry\n'
  printf 'and without reading, in the same run. Ratios are of their seconds to those of consensus.\n\n'
  cached peers peer_rows
  printf '\n## Size: cities with as many candidates as poses, half of them false\n\n%s\n' "$figures"
  for poses in 10000 20000 50000 100000; do cached "large-$poses" large_row "$poses"; done
  printf '\n## Injected false loops: five types, both styles\n\n'
  printf 'Fractions of all loops: %s, seeds %s; of %s: %s, seeds %s%s.\n\n%s\n' \
    "$fractions" "$seeds" "${large// /, }" "$large_fractions" "$large_seeds" \
    "${large_once:+; $large_once, seed 1}" "$figures"
  for graph in $corrupted; do
    corrupt_rows "$graph" "vertigo paper" "$types" "$fractions" "$seeds"
  done
  for graph in $large; do
    corrupt_rows "$graph" "$large_styles" "$large_types" "$large_once" 1
  done
  for fraction in $large_fractions; do
    for graph in $large; do
      corrupt_rows "$graph" "$large_styles" "$large_types" "$fraction" "$large_seeds"
    done
  done
  if [ "$missing" -gt 0 ]; then
    printf '\n%s further rows of this list have not been measured yet.\n' "$missing"
  fi
} >"$work/page.md"
mkdir -p "$(dirname "$page")"
mv "$work/page.md" "$page"
echo "consensus: wrote $page" >&2
