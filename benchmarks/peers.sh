#!/usr/bin/env bash
# Compares every pruning method on B25b, Bovisa04 and the graphs with injected false
# loops: writes docs/results/peers.md. Every result is kept in build/peers, so that an
# interrupted run goes on where it stopped; remove the folder to start anew.
# usage: benchmarks/peers.sh [--data DIR] [--jobs N] [--page-only]
# ISOTHERM names the command to measure; without it, the release preset is built.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -z "${ISOTHERM:-}" ]; then
  scripts/build.sh release >/dev/null
  ISOTHERM=$PWD/build/release/apps/isotherm
fi
export ISOTHERM
PYTHONPATH=benchmarks/support exec python3 benchmarks/peers/main.py "$@"
