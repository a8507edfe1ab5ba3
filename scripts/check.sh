#!/usr/bin/env bash
# Checks the sources without building them: formatting, scripts, layers and rooms, and with
# clang-tidy (16: 14 cannot read GCC 12's ranges) what differs from a base.
# usage: scripts/check.sh [--quick | --all | --base REF]
#   --quick     without clang-tidy
#   --all       clang-tidy on every source (long)
#   --base REF  clang-tidy on the sources that differ from REF; the default is HEAD~1
set -euo pipefail
cd "$(dirname "$0")/.."

# CI has minutes for this, not hours: the first so many of the files that changed.
most_files=12

tidy=changed
base=HEAD~1
while [ $# -gt 0 ]; do
  case "$1" in
    --quick) tidy=none ;;
    --all) tidy=all ;;
    --base) base=${2:?--base needs a commit}; shift ;;
    *) sed -n '4,7s/^# //p' "$0" >&2; exit 2 ;;
  esac
  shift
done

for tool in clang-format-14 shellcheck python3 cmake; do
  if ! command -v "$tool" >/dev/null; then
    echo "check: needs $tool; scripts/install-deps.sh --checks installs it" >&2
    exit 1
  fi
done

echo "check: formatting"
git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format-14 --dry-run -Werror
echo "check: scripts"
git ls-files -z '*.sh' '.ci/run' | xargs -0 shellcheck -S warning
echo "check: layers and rooms"
cmake -DROOT="$PWD" -P tests/layers/check_layers.cmake
python3 tests/layers/check_rooms.py .

layers=({base,spectral,geometry,network,slam,apps,python}/'*.cpp')

sources() {
  if [ "$tidy" = all ]; then
    git ls-files "${layers[@]}"
  elif git rev-parse -q --verify "$base" >/dev/null; then
    git diff --name-only --diff-filter=d "$base" -- "${layers[@]}" | head -n "$most_files"
  else
    echo "check: no $base here; clang-tidy is left out" >&2
  fi
}

if [ "$tidy" = none ]; then exit 0; fi
mapfile -t files < <(sources)
if [ "${#files[@]}" -eq 0 ]; then exit 0; fi
echo "check: clang-tidy on ${#files[@]} files"
python=$(scripts/python-env.sh)
cmake --preset dev -DISOTHERM_BUILD_PYTHON=ON -DPython_EXECUTABLE="$python" >/dev/null
printf '%s\0' "${files[@]}" | xargs -0 -n1 -P2 clang-tidy-16 -p build/dev --quiet \
  --extra-arg=-Wno-unknown-warning-option 2>/dev/null
