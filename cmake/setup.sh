# Sourced by run.sh, test.sh and .ci/run: packages, configuration, build. Needs $root.

build_packages=(
  g++ cmake ninja-build pkg-config git
  libtbb-dev libcli11-dev nlohmann-json3-dev libassimp-dev libcgal-dev libeigen3-dev zlib1g-dev
  libglfw3-dev libimgui-dev libstb-dev python3-glad libgl-dev libegl-dev libgl1-mesa-dri
  libgtest-dev
)
test_packages=(xvfb xdotool python3)

say() { printf '%s\n' "$*" >&2; }

# install_missing PACKAGE… : installs those that are not there.
install_missing() {
  if ! command -v dpkg-query > /dev/null; then
    say "This is no Debian; needed are: $*"
    return
  fi
  local missing=() package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2> /dev/null) == installed ]] ||
      missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo > /dev/null; then
      say "Missing packages: ${missing[*]}"
      say "Install them as root (apt-get install ${missing[*]}) or pass --no-install."
      exit 2
    fi
    as_root=(sudo)
  fi
  say "Installing ${missing[*]}"
  quietly "${as_root[@]}" apt-get -q update
  quietly "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -q install -y --no-install-recommends "${missing[@]}"
}

# quietly COMMAND… : shows what it printed only when it fails.
quietly() {
  local log status=0
  log=$(mktemp)
  "$@" > "$log" 2>&1 < /dev/null || status=$?
  ((status == 0)) || cat "$log" >&2
  rm -f "$log"
  return "$status"
}

# build TARGET… : configures $root/build (Release) and builds. $ICLOTH_CMAKE_FLAGS are added.
build() {
  local flags=() generator=()
  read -r -a flags <<< "${ICLOTH_CMAKE_FLAGS:-}"
  [[ -e $root/build/CMakeCache.txt ]] || ! command -v ninja > /dev/null || generator=(-G Ninja)
  quietly cmake -S "$root" -B "$root/build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release \
    "${flags[@]}"
  if [[ -t 2 ]]; then
    cmake --build "$root/build" --parallel "$(nproc)" --target "$@" >&2
  else
    say "Building $* (the first time takes some minutes)"
    quietly cmake --build "$root/build" --parallel "$(nproc)" --target "$@"
  fi
}
