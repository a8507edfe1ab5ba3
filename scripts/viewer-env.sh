#!/usr/bin/env bash
# Installs in viewer/node_modules what the viewer is built and tested with. Does nothing
# if it is up to date.
# usage: scripts/viewer-env.sh
set -euo pipefail
cd "$(dirname "$0")/../viewer"

stamp=node_modules/installed.json
if ! cmp -s package-lock.json "$stamp"; then
  npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
  cp package-lock.json "$stamp"
fi
