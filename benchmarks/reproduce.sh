#!/usr/bin/env bash
# Repeats the paper's experiments: writes docs/results/paper.md and the figures in
# docs/images/paper. Every result is kept in build/reproduce, so that an interrupted
# run goes on where it stopped; remove the folder to start anew.
# usage: benchmarks/reproduce.sh [--quick] [--data DIR] [--jobs N]
#   --quick   one seed, three noise levels, six kernel widths
#   --data    default $ISOTHERM_DATA or ../shared/data
#   --jobs    programs to run at once, default 2
# ISOTHERM names the command to measure; without it, the release preset is built.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -z "${ISOTHERM:-}" ]; then
  scripts/build.sh release >/dev/null
  ISOTHERM=$PWD/build/release/apps/isotherm
fi
export ISOTHERM
python=$(scripts/python-env.sh)
PYTHONPATH=benchmarks/support exec "$python" benchmarks/reproduce/main.py "$@"
