#!/usr/bin/env bash
# ./run.sh [--no-install] [--cuda] [ARGS…]
# Installs what is missing, builds, and runs `icloth ARGS…`. Without ARGS: the scarf scene in a
# window, or without a display that can show it a headless run of it that prints statistics and
# writes scarf.png. CUDA is built where a device can be seen, and with --cuda wherever nvcc is.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$root/cmake/setup.sh"

install=yes
while [[ ${1:-} == --no-install || ${1:-} == --cuda ]]; do
  if [[ $1 == --cuda ]]; then
    ICLOTH_CMAKE_FLAGS="${ICLOTH_CMAKE_FLAGS:-} -DICLOTH_CUDA=ON"
  else
    install=no
  fi
  shift
done
[[ $install == no ]] || install_missing "${build_packages[@]}"

# The benchmark suites are a program of their own, which only `icloth bench` needs.
targets=(icloth)
[[ ${1:-} != bench ]] || targets+=(icloth-bench)
build "${targets[@]}"
icloth=$root/build/bin/icloth

if (($#)); then
  exec "$icloth" "$@"
elif [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]]; then
  status=0
  "$icloth" view scarf || status=$?
  ((status == 3)) || exit "$status"
fi
say "Step 3 of 3: no window, so the scarf scene is simulated and drawn into scarf.png"
status=0
"$icloth" render scarf --steps 600 --out scarf.png || status=$?
if ((status == 3)); then  # not even software rendering: at least the numbers
  status=0
  "$icloth" run scarf --steps 600 || status=$?
fi
exit "$status"
