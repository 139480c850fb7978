#!/usr/bin/env bash
# tests/fuzz/run.sh [SECONDS] [TARGET…]
# Builds icloth_fuzz with clang, ASan and UBSan, and runs each target (default: all) for SECONDS
# (default: 60), one after the other. Prints a line a target; the corpus and what was found stay in
# the build folder, $ICLOTH_FUZZ_BUILD or build-fuzz/. Status 1 when something was found.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
source "$root/cmake/setup.sh"

seconds=60
if [[ ${1:-} =~ ^[0-9]+$ ]]; then
  seconds=$1
  shift
fi
targets=("$@")
((${#targets[@]})) || targets=(scene material recording camera obj ply pc2 mdd query pattern
                            dxf body)

build=${ICLOTH_FUZZ_BUILD:-$root/build-fuzz}
if ! command -v clang++ > /dev/null; then
  say "clang++ is missing (package clang); libFuzzer comes with it"
  exit 2
fi
quietly cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O2 -g" \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DICLOTH_CUDA=OFF \
  -DICLOTH_SANITIZE=address -DICLOTH_FUZZ=ON -DCMAKE_CXX_FLAGS=-D_GLIBCXX_ASSERTIONS
quietly cmake --build "$build" --target icloth_fuzz

# Fields of the statistics at the end of a log.
field() { sed -n "s/^stat::$1: *//p" "$2" | tail -n 1; }

# run_target NAME: fails when it ended early.
run_target() {
  local name=$1 dictionary status=0
  local corpus=$build/corpus/$name found=$build/found/$name log=$build/found/$name.log
  if [[ ! -d $here/seeds/$name ]]; then
    say "no target '$name'"
    exit 2
  fi
  mkdir -p "$corpus" "$found"
  cp "$here/seeds/$name"/* "$corpus"
  find "$here/regressions/$name" -type f -exec cp {} "$corpus" \; 2> /dev/null || true
  case $name in
    scene | material | recording | camera | pattern) dictionary=json ;;
    pc2 | mdd | dxf | body) dictionary= ;;
    *) dictionary=$name ;;
  esac
  # A file of 8 KiB needs no more than 64 MiB at once: unchecked sizes show.
  ASAN_OPTIONS=quarantine_size_mb=32:${ASAN_OPTIONS:-} "$build/bin/icloth_fuzz" "--target=$name" \
    -max_total_time="$seconds" -timeout=5 -max_len=8192 -rss_limit_mb=1024 -malloc_limit_mb=64 \
    -print_final_stats=1 -artifact_prefix="$found/" \
    ${dictionary:+-dict="$here/dictionaries/$dictionary.dict"} "$corpus" > "$log" 2>&1 || status=$?
  printf '%-10s %12s executions %8s a second   ' "$name" \
    "$(field number_of_executed_units "$log")" "$(field average_exec_per_sec "$log")"
  if ((status == 0)); then
    echo "nothing found"
  else
    echo "FOUND: $log"
  fi
  return "$status"
}

result=0
for target in "${targets[@]}"; do
  run_target "$target" || result=1
done
exit "$result"
