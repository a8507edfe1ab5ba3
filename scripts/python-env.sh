#!/usr/bin/env bash
# Makes .venv, the Python environment of the Python package, its tests, the site, and the tests
# and benchmarks that compare with other programs, and prints its interpreter. Does nothing if it
# is up to date.
# usage: scripts/python-env.sh
set -euo pipefail
cd "$(dirname "$0")/.."

wanted=({tests/interop,tests/python,tests/site}/requirements.txt)
stamp=.venv/installed.txt
if ! python3 -c 'import ensurepip' 2>/dev/null; then
  echo "python-env: needs Python with venv (Debian packages python3 and python3-venv)" >&2
  exit 1
fi
if ! cat "${wanted[@]}" | cmp -s - "$stamp"; then
  python3 -m venv .venv >&2
  .venv/bin/pip install --quiet --disable-pip-version-check "${wanted[@]/#/-r}" >&2
  cat "${wanted[@]}" > "$stamp"
fi
echo "$PWD/.venv/bin/python"
