#!/usr/bin/env bash
# Installs what Isotherm needs on Debian 12, and nothing that is there already.
# Runs as root or through sudo.
set -euo pipefail

packages=(
  # tools
  build-essential cmake ninja-build ccache
  # libraries
  libboost-dev libcgal-dev libeigen3-dev libspectra-dev libsuitesparse-dev libtbb-dev zlib1g-dev
  libfast-float-dev libnanoflann-dev libcli11-dev nlohmann-json3-dev libfmt-dev
  # dense kernels, also for CHOLMOD; several times as fast as the reference ones. The -serial one
  # gives wrong products when two threads call it at a time.
  libblas-dev libopenblas0-pthread
  # tests
  libgtest-dev libgmock-dev python3
  # benchmarks
  libbenchmark-dev
)

# What only the tests of the Python package (the rest comes from PyPI, by python-env.sh) and of
# completion need.
test_packages=(python3-dev python3-venv zsh fish)

# What only the tests of the report viewer need, as `command package`: Node may come
# from elsewhere than Debian, and then brings npm along.
test_commands=("chromium chromium" "node nodejs" "npm npm")

# What scripts/check.sh calls.
check_packages=(clang-format-14 clang-tidy-16 shellcheck git)

# What scripts/fuzz.sh builds with; libFuzzer and the sanitizers are a package of their own.
fuzz_packages=(clang-14 libclang-rt-14-dev)

# What the distributed spectral engine needs: solvers, and MPI to start them with.
mpi_packages=(slepc-dev petsc-dev openmpi-bin pkg-config)

usage() {
  cat <<'USAGE'
usage: scripts/install-deps.sh [--tests] [--checks] [--fuzz] [--mpi] [--list]

Installs the Debian packages Isotherm is built with.
  --tests  also those that only the tests need: Python's headers, shells, a browser and Node
  --checks also those that scripts/check.sh calls
  --fuzz   also those that scripts/fuzz.sh builds with
  --mpi    also PETSc, SLEPc and MPI, for the spectral engine beyond one machine
  --list   only print which packages are missing
USAGE
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
      echo "$package"
  done
  if $tests; then
    for package in "${test_commands[@]}"; do
      command -v "${package% *}" >/dev/null || echo "${package#* }"
    done
  fi
}

list_only=false
tests=false
for argument in "$@"; do
  case "$argument" in
    --list) list_only=true ;;
    --tests) tests=true; packages+=("${test_packages[@]}") ;;
    --checks) packages+=("${check_packages[@]}") ;;
    --mpi) packages+=("${mpi_packages[@]}") ;;
    --fuzz) packages+=("${fuzz_packages[@]}") ;;
    --help | -h) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

if ! command -v apt-get >/dev/null; then
  echo "install-deps: apt-get not found; install these yourself: ${packages[*]}" >&2
  exit 1
fi

mapfile -t missing < <(missing_packages)
if [ "${#missing[@]}" -eq 0 ]; then
  echo "install-deps: everything is installed"
  exit 0
fi
echo "install-deps: missing: ${missing[*]}"
if $list_only; then exit 0; fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install-deps: not root and no sudo; run as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}"
