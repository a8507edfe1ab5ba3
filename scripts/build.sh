#!/usr/bin/env bash
# Configures and builds one CMake preset, through ccache where it is installed.
# usage: scripts/build.sh PRESET [cmake configure options ...]
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:?usage: scripts/build.sh PRESET [options]}
shift
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake --preset "$preset" "${launcher[@]}" "$@"
cmake --build --preset "$preset"
