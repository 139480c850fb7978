#!/usr/bin/env bash
# ./run.sh [--no-install] [ARGS…]
# Installs what is missing, builds, and runs `icloth ARGS…`. Without ARGS: the scarf scene in a
# window, or without a display that can show it a headless run of it that prints statistics and
# writes scarf.png.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$root/cmake/setup.sh"

if [[ ${1:-} == --no-install ]]; then
  shift
else
  install_missing "${build_packages[@]}"
fi
build icloth
icloth=$root/build/bin/icloth

if (($#)); then
  exec "$icloth" "$@"
elif [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]]; then
  status=0
  "$icloth" view scarf || status=$?
  ((status == 3)) || exit "$status"
fi
say "No window: simulating the scarf scene and drawing scarf.png"
status=0
"$icloth" render scarf --steps 600 --out scarf.png || status=$?
if ((status == 3)); then  # not even software rendering: at least the numbers
  status=0
  "$icloth" run scarf --steps 600 || status=$?
fi
exit "$status"
