#!/usr/bin/env bash
# tests/on_gpu.sh [--only STAGES] [--build-only] [--arch N] [--jobs N] [--build DIR] [--out DIR]
#                 [--packages DIR]
# tests/on_gpu.sh --pack [DIR]
#
# Builds and runs everything that needs a GPU, on a machine with no more than the CUDA toolkit (12 or
# 13), g++, CMake 3.25, ninja and python3. Prints one table and writes results.json, the table, the
# logs and the pictures to --out ($OUT when set, else results/ in the build folder).
#
#   STAGES      some of build,tests,sanitizer,bench,picture (default: all). The build folder and what
#               earlier stages found are kept, so that the work can be split into several calls;
#               building anew forgets the findings. A missing build is made first.
#   --arch N    compute capability to build for, e.g. 90 (default: the device's)
#   --packages  folder of unpacked packages (default: .gpu_packages here, where it exists), for
#               machines without TBB, CLI11, nlohmann_json, GTest and the OpenGL loaders. --pack
#               fills such a folder, on Debian 12 with network and python3-glad.
#   ICLOTH_COMMIT names the commit where the copy of the source tree has no repository.
#
# Exit codes: 0 all passed, 1 something did not, 2 bad usage, 3 no usable CUDA device.
set -uo pipefail
export LC_ALL=C
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
helper="$root/tests/on_gpu.py"

say() { printf '%s\n' "$*" >&2; }
fail() {
  say "on_gpu.sh: $1"
  exit "${2:-2}"
}

# ---- packages

packages=(
  libtbb-dev libtbb12 libtbbmalloc2 libtbbbind-2-5 nlohmann-json3-dev libcli11-dev libgtest-dev
  libeigen3-dev zlib1g-dev libstb-dev
  libegl-dev libgl-dev libopengl-dev libglx-dev
  libegl1 libglvnd0 libopengl0 libgl1 libglx0 libx11-6 libxcb1 libxau6 libxdmcp6 libbsd0 libmd0
)

# Headers, CMake files and libraries of the packages in DIR/usr, the OpenGL loader in DIR/glad.
pack() {
  local dir=$1 debs deb
  command -v glad > /dev/null || fail "--pack needs glad (package python3-glad)"
  mkdir -p "$dir" && dir=$(cd "$dir" && pwd)
  rm -rf "${dir:?}/usr" "$dir/glad"
  debs=$(mktemp -d)
  (cd "$debs" && apt-get -q download "${packages[@]}") > "$debs/log" 2>&1 ||
    fail "apt-get download failed: $(grep -m 1 '^E:' "$debs/log")" 1
  for deb in "$debs"/*.deb; do dpkg -x "$deb" "$dir" || fail "$deb cannot be unpacked" 1; done
  rm -rf "$debs"
  # Only what a build needs. The C library's zlib is on every machine, here the static one is used.
  (cd "$dir" && rm -rf etc lib usr/share/{doc,man,lintian,X11,bug} usr/src usr/include/eigen3/unsupported \
    usr/lib/x86_64-linux-gnu/lib{z.so,stb*})
  glad --quiet --reproducible --api gl:core=4.5 --extensions "" --out-path "$dir/glad" c ||
    fail "glad failed" 1
  say "$dir: $(du -sm "$dir" | cut -f 1) MiB"
}

# ---- what was asked for

only=build,tests,sanitizer,bench,picture
build_only='' arch='' packages_dir='' build="$root/build-gpu" out=${OUT:-} jobs=$(nproc)
while (($#)); do
  case $1 in
    --pack)
      pack "${2:-$root/.gpu_packages}"
      exit
      ;;
    --build-only) build_only=1 only=build ;;
    --only | --arch | --packages | --build | --out | --jobs)
      (($# > 1)) || fail "$1: expected a value"
      case $1 in
        --only) only=$2 ;;
        --arch) arch=$2 ;;
        --packages) packages_dir=$2 ;;
        --build) build=$2 ;;
        --out) out=$2 ;;
        --jobs) jobs=$2 ;;
      esac
      shift
      ;;
    -h | --help)
      sed -n '2,/^set /s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
      exit
      ;;
    *) fail "'$1' is no option of this script" ;;
  esac
  shift
done
for stage in ${only//,/ }; do
  [[ $stage =~ ^(build|tests|sanitizer|bench|picture)$ ]] ||
    fail "--only $stage: expected some of build,tests,sanitizer,bench,picture"
done
[[ -n $packages_dir || ! -d $root/.gpu_packages ]] || packages_dir=$root/.gpu_packages
[[ -z $packages_dir || -d $packages_dir/usr ]] || fail "--packages $packages_dir: no folder 'usr' in it"

# ---- the machine

device=$(python3 "$helper" device) || {
  [[ -n $build_only ]] || fail "no CUDA device: ${device:-python3 cannot ask the driver}" 3
  say "No CUDA device (${device:-unknown reason}): building only"
  device=''
}
[[ -n $arch || -z $device ]] || arch=$(cut -d ' ' -f 1 <<< "$device")

if [[ -n $packages_dir ]]; then
  packages_dir=$(cd "$packages_dir" && pwd)
  libraries=$packages_dir/usr/lib/x86_64-linux-gnu
fi
# A driver that is mounted into a container often has its EGL entry where nobody looks for it.
mounted=/usr/local/nvidia/share/glvnd/egl_vendor.d/10_nvidia.json
if [[ -z ${__EGL_VENDOR_LIBRARY_FILENAMES:-} && -e $mounted ]] &&
  ! ls /{usr/share,etc}/glvnd/egl_vendor.d/*nvidia* > /dev/null 2>&1; then
  export __EGL_VENDOR_LIBRARY_FILENAMES=$mounted
fi

work=$build/on_gpu
mkdir -p "$work" || fail "--build $build: cannot be made"
icloth=$build/bin/icloth

# step NAME SECONDS COMMAND… : leaves NAME.log and NAME.rc ("exit code, seconds") in $work.
step() {
  local name=$1 limit=$2 begin=$EPOCHREALTIME status=0
  shift 2
  say "$name …"
  timeout -k 10 "$limit" "$@" > "$work/$name.log" 2>&1 < /dev/null || status=$?
  printf '%s %s\n' "$status" "$(python3 -c "print(f'{$EPOCHREALTIME - $begin:.1f}')")" > "$work/$name.rc"
  ((status == 0)) || say "$name: exit code $status, see $work/$name.log"
  return "$status"
}
# The same with the libraries of the packages.
run() {
  local name=$1 limit=$2
  shift 2
  step "$name" "$limit" env ${libraries:+"LD_LIBRARY_PATH=$libraries:${LD_LIBRARY_PATH:-}"} "$@"
}

# ---- the stages

stage_build() {
  rm -rf "$work" && mkdir -p "$work"
  local flags=(-DCMAKE_BUILD_TYPE=Release -DICLOTH_CUDA=ON)
  [[ -z $arch ]] || flags+=("-DCMAKE_CUDA_ARCHITECTURES=$arch")
  if [[ -n $packages_dir ]]; then
    flags+=("-DCMAKE_PREFIX_PATH=$packages_dir/usr" "-DICLOTH_GLAD_SOURCES=$packages_dir/glad"
      "-DCMAKE_LIBRARY_PATH=$libraries" "-DCMAKE_EXE_LINKER_FLAGS=-Wl,-rpath-link,$libraries")
  fi
  step configure 60 cmake -S "$root" -B "$build" -G Ninja "${flags[@]}" || return
  grep -E 'not found|without|CUDA solver|Window' "$work/configure.log" >&2
  local limit=330
  [[ -z $build_only ]] || limit=7200
  step compile "$limit" cmake --build "$build" --parallel "$jobs" -- -k 0
}

stage_tests() {
  run tests 180 ctest --test-dir "$build" --parallel "$jobs" --timeout 120 --output-on-failure \
    --output-junit "$work/tests.xml"
}

# A sheet flung onto a ball: contacts, impact zones, retries and roll-back within a few steps each.
stage_sanitizer() {
  local sanitizer tool name steps settings
  sanitizer=$(PATH=$PATH:/usr/local/cuda/bin:/usr/local/cuda/compute-sanitizer \
    command -v compute-sanitizer)
  for tool in memcheck racecheck; do
    while read -r name steps settings; do
      # shellcheck disable=SC2086  # the settings are words
      run "${tool}_$name" 100 "${sanitizer:-compute-sanitizer}" --tool "$tool" --error-exitcode 9 \
        "$icloth" run "$root/tests/data/drop.json" --device cuda --steps "$steps" --set $settings
    done < <(grep -v '^#' "$root/tests/data/device_runs.txt")
  done
}

stage_bench() {
  run info 30 "$icloth" info
  run bench 220 "$icloth" bench quick --quiet --out "$work/bench"
}

# The same state drawn from shared buffers and from a host copy.
stage_picture() {
  local way
  for way in interop host; do
    run "picture_$way" 40 "$icloth" render scarf --device cuda --steps 40 --size 960x720 \
      --vertices "$way" --out "$work/$way.png"
  done
}

[[ ,$only, == *,build,* || -x $icloth ]] || only=build,$only
for stage in build tests sanitizer bench picture; do
  [[ ,$only, == *,$stage,* ]] || continue
  "stage_$stage" || [[ $stage != build ]] || break
done

out=${out:-$build/results}
mkdir -p "$out" || fail "--out $out: cannot be made"
python3 "$helper" report "$work" "$out" "$device"
