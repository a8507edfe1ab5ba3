#!/usr/bin/env bash
# Installs what the distributed spectral engine needs, builds it, and runs its tests on 1, 2 and 4
# ranks.
# usage: scripts/test-mpi.sh [ctest options ...]
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-deps.sh --mpi
scripts/build.sh mpi
ctest --preset mpi "$@"
