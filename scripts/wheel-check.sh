#!/usr/bin/env bash
# Installs the wheel that scripts/wheel.sh made into a fresh Debian 12 with Python and nothing
# else, and uses it there. Runs as root, and needs debootstrap.
# usage: scripts/wheel-check.sh [folder for the tree, default a temporary one]
set -euo pipefail
cd "$(dirname "$0")/.."

wheels=(out/wheelhouse/isotherm-*.whl)
if [ ! -e "${wheels[0]}" ]; then
  echo "wheel-check: no wheel in out/wheelhouse; scripts/wheel.sh makes it" >&2
  exit 1
fi
tree=${1:-$(mktemp -d)/debian}
if [ ! -x "$tree/usr/bin/python3" ]; then
  debootstrap --variant=minbase --include=ca-certificates,python3,python3-venv bookworm "$tree"
fi
rm -rf "$tree/try"
mkdir "$tree/try"
cp "${wheels[0]}" scripts/wheel-check.py "$tree/try/"
# Names of hosts, and certificates of a proxy, are those of this machine.
cp /etc/resolv.conf /etc/hosts "$tree/etc/"
cp /etc/ssl/certs/ca-certificates.crt "$tree/etc/ssl/certs/"
# /proc, by which the loader finds where the command stands, ends with this.
unshare --mount --fork chroot "$tree" /bin/sh -ec '
  mount -t proc proc /proc
  cd /try
  python3 -m venv env
  env/bin/pip install --quiet --disable-pip-version-check isotherm-*.whl
  env/bin/python wheel-check.py
  env/bin/isotherm --version'
