#!/usr/bin/env bash
# Compares every pruning method on B25b, Bovisa04 and the graphs with injected
# false loops; the table of docs/results/peers.md is its output.
# usage: benchmarks/peers.sh [NAME ...]   (only graphs whose name contains a NAME)
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/build.sh release >&2
exec python3 benchmarks/peers.py build/release/apps/isotherm \
  "${ISOTHERM_DATA:-../shared/data}" "$@"
