#!/usr/bin/env bash
# Runs a test of the report viewer with Node, if what it needs is there. Without it the
# test is skipped (77), but fails in continuous integration, where nothing may be missing.
# usage: run.sh [--browser] SCRIPT [arguments ...]
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
needs=(node)
if [ "${1:-}" = --browser ]; then
  shift
  needs+=("${CHROMIUM:-chromium}")
fi

missing=()
for command in "${needs[@]}"; do
  command -v "$command" >/dev/null || missing+=("$command")
done
if [ ! -d "$here/../../viewer/node_modules" ]; then missing+=(viewer/node_modules); fi
if [ "${#missing[@]}" -gt 0 ]; then
  echo "missing: ${missing[*]}; scripts/install-deps.sh --tests and scripts/viewer-env.sh bring it"
  if [ -n "${CI:-}" ]; then exit 1; fi
  exit 77
fi
exec node "$@"
