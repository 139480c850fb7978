#!/usr/bin/env bash
# ./test.sh [--no-install] [ctest ARGS…]
# Installs what is missing, builds everything, and runs the tests.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$root/cmake/setup.sh"

if [[ ${1:-} == --no-install ]]; then
  shift
else
  install_missing "${build_packages[@]}" "${test_packages[@]}"
fi
build all
say "Step 3 of 3: running the tests"
exec ctest --test-dir "$root/build" --output-on-failure --parallel "$(nproc)" "$@"
