#!/usr/bin/env bash
# tests/determinism_matrix.sh [--pair] [BUILD_FOLDER]
# The golden hashes of tests/sim/golden_hash_test.cpp in builds of g++ and clang++, each with -O1 and
# -O3, for one instruction set (x86-64-v3), with 1, 2 and 8 threads. --pair: only the two that differ
# most, g++ -O1 and clang++ -O3. Prints a table; exits with 1 where a hash differs. A compiler that
# is missing is said and left out.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
pair=no
if [[ ${1:-} == --pair ]]; then
  pair=yes
  shift
fi
folder=${1:-$root/build-matrix}
failed=0
for compiler in g++ clang++; do
  if ! command -v "$compiler" > /dev/null; then
    printf '%-8s skipped: it is not installed\n' "$compiler"
    continue
  fi
  for level in O1 O3; do
    if [[ $pair == yes && $compiler-$level != g++-O1 && $compiler-$level != clang++-O3 ]]; then
      continue
    fi
    build=$folder/$compiler-$level
    log=$folder/$compiler-$level.log
    mkdir -p "$build"
    begin=$SECONDS
    if cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-$level" \
        "-DCMAKE_CXX_COMPILER=$compiler" -DICLOTH_NATIVE=OFF -DICLOTH_ARCH=x86-64-v3 \
        -DICLOTH_CUDA=OFF > "$log" 2>&1 &&
      cmake --build "$build" --parallel "$(nproc)" --target golden_hash_test >> "$log" 2>&1 &&
      "$build/bin/golden_hash_test" >> "$log" 2>&1; then
      result="all hashes equal the golden ones"
    else
      result="FAILED, see $log"
      tail -n 30 "$log" >&2
      failed=1
    fi
    printf '%-8s -%s  %s (%d s)\n' "$compiler" "$level" "$result" $((SECONDS - begin))
  done
done
exit "$failed"
