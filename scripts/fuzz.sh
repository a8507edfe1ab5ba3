#!/usr/bin/env bash
# Builds the fuzz harnesses with clang and runs each for some time, one after the other.
# Finds are left in build/fuzz/finds.
# usage: scripts/fuzz.sh [SECONDS [HARNESS ...]]     (default: 600 seconds, all)
# The harness `options` is a script that runs the command, built with the preset test.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-600}
shift || true
harnesses=("$@")
if [ "${#harnesses[@]}" -eq 0 ]; then
  harnesses=(pose_graph trajectory ranges graph points csv options)
fi

fuzz_options() {
  cmake --preset test
  cmake --build --preset test --target isotherm_command
  echo "fuzz: options, $seconds s"
  python3 tests/fuzz/fuzz_options.py build/test/apps/isotherm --seconds "$seconds" --seed "$RANDOM"
}
if [ "${harnesses[*]}" = options ]; then
  fuzz_options
  exit
fi

if ! command -v clang++-14 >/dev/null; then
  echo "fuzz: needs clang++-14 and libFuzzer: scripts/install-deps.sh --fuzz" >&2
  exit 1
fi
cmake --preset fuzz
cmake --build build/fuzz --target fuzzers
mkdir -p build/fuzz/finds
for name in "${harnesses[@]}"; do
  if [ "$name" = options ]; then
    fuzz_options
    continue
  fi
  work=build/fuzz/work/$name
  mkdir -p "$work"
  echo "fuzz: $name, $seconds s"
  build/fuzz/tests/fuzz/fuzz_"$name" -max_total_time="$seconds" -max_len=4096 -timeout=10 \
    -rss_limit_mb=1024 -malloc_limit_mb=256 -print_final_stats=1 -verbosity=0 \
    -artifact_prefix=build/fuzz/finds/ "$work" tests/fuzz/corpus tests/data/bad
done
