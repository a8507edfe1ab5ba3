#!/usr/bin/env bash
# Builds the site from docs/, the public headers and the Python package of the preset test, which
# scripts/test.sh builds. It goes to build/site.
# usage: scripts/site.sh
set -euo pipefail
cd "$(dirname "$0")/.."

if [ ! -d build/test/python/isotherm/_core ]; then
  echo "site: no Python package in build/test; scripts/test.sh builds it" >&2
  exit 1
fi
python=$(scripts/python-env.sh)
NO_MKDOCS_2_WARNING=1 "$python" -m mkdocs build --strict
echo "file://$PWD/build/site/index.html"
