# Sourced by run.sh, test.sh and .ci/run: packages, configuration, build. Needs $root.

build_packages=(
  g++ cmake ninja-build pkg-config git
  libtbb-dev libcli11-dev nlohmann-json3-dev libassimp-dev libcgal-dev libboost-dev libeigen3-dev
  zlib1g-dev fonts-dejavu-core libglfw3-dev libimgui-dev libstb-dev python3-glad libgl-dev libopengl-dev libegl-dev libgl1-mesa-dri
  libgtest-dev
)
test_packages=(xvfb xdotool python3 ffmpeg dpkg-dev)

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
  say "Step 1 of 3: installing ${#missing[@]} packages: ${missing[*]}"
  quietly "${as_root[@]}" apt-get -q update
  install_with_progress "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -q install -y --no-install-recommends -o APT::Status-Fd=3 "${missing[@]}"
}

# install_with_progress COMMAND… : says how far apt is, which it writes to file descriptor 3 as
# "dlstatus:…:PERCENT:…" and "pmstatus:…:PERCENT:…". Shows what it printed only when it fails.
install_with_progress() {
  local log status=0
  log=$(mktemp)
  { "$@" 3>&1 > "$log" 2>&1 < /dev/null || printf '%s\n' "$?" > "$log.status"; } |
    while IFS=: read -r kind _ percent _; do
      local what=installed
      [[ $kind != dlstatus ]] || what=downloaded
      [[ $kind != [dp][lm]status ]] || show_share "$what" "${percent%%.*}" 100 "% of the packages"
    done
  [[ ! -e $log.status ]] || status=$(< "$log.status")
  ((status == 0)) || cat "$log" >&2
  rm -f "$log" "$log.status"
  return "$status"
}

# show_share WHAT DONE ALL UNIT : one line that is overwritten on a terminal; elsewhere a line each
# quarter of the way.
last_share=""
show_share() {
  local what=$1 done=$2 all=$3 unit=$4
  [[ $done =~ ^[0-9]+$ ]] && ((all > 0)) || return 0
  if [[ -t 2 ]]; then
    printf '\r\033[K  %s %s%s' "$what" "$done" "$unit" >&2
    ((done < all)) || printf '\n' >&2
  else
    local share="$what $((4 * done / all))"
    [[ $share != "$last_share" ]] || return 0
    last_share=$share
    say "  $what $done$unit"
  fi
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
  local flags=() generator=() log status=0
  read -r -a flags <<< "${ICLOTH_CMAKE_FLAGS:-}"
  [[ -e $root/build/CMakeCache.txt ]] || ! command -v ninja > /dev/null || generator=(-G Ninja)
  say "Step 2 of 3: building $*"
  quietly cmake -S "$root" -B "$root/build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release \
    "${flags[@]}"

  # ninja's lines begin with [DONE/ALL], make's with [PERCENT%].
  log=$(mktemp)
  { cmake --build "$root/build" --parallel "$(nproc)" --target "$@" 2>&1 ||
      printf '%s\n' "$?" > "$log.status"; } | tee "$log" |
    while IFS= read -r line; do
      if [[ $line =~ ^\[\ *([0-9]+)/([0-9]+)\] ]]; then
        show_share compiled "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" " of ${BASH_REMATCH[2]} files"
      elif [[ $line =~ ^\[\ *([0-9]+)%\] ]]; then
        show_share compiled "${BASH_REMATCH[1]}" 100 " %"
      fi
    done
  [[ ! -e $log.status ]] || status=$(< "$log.status")
  ((status == 0)) || grep -v '^\[' "$log" >&2 || true
  rm -f "$log" "$log.status"
  return "$status"
}
