#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test.
# usage: scripts/test.sh [ctest options ...]
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install-deps.sh --tests
scripts/viewer-env.sh
python=$(scripts/python-env.sh)
scripts/build.sh test -DISOTHERM_BUILD_PYTHON=ON -DPython_EXECUTABLE="$python"
ctest --preset test "$@"
