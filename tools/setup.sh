# Holds the steps that ./demo and ./check share: install missing packages, configure, build. bash sources this file and does not run it.
# SPDX-License-Identifier: Apache-2.0

# step "what happens" prints one line with the seconds since the script began.
step() { printf '[%4ds] %s\n' "$SECONDS" "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

installed() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q '^install ok installed'; }

# Sets missing=() to the packages of apt.txt that are not installed. For "a|b" it takes the first name that apt knows.
find_missing() {
  missing=()
  local line name names found
  while read -r line; do
    line=${line%%#*}; line=${line//[[:space:]]/}
    [ -n "$line" ] || continue
    IFS='|' read -ra names <<<"$line"
    found=
    for name in "${names[@]}"; do installed "$name" && found=1 && break; done
    [ -n "$found" ] && continue
    for name in "${names[@]}"; do
      if [ ${#names[@]} -eq 1 ] || apt-cache show --no-all-versions "$name" >/dev/null 2>&1; then break; fi
    done
    missing+=("$name")
  done <apt.txt
}

install_missing() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    step "no apt here: assuming that the libraries of apt.txt are installed"
    return
  fi
  find_missing
  if [ ${#missing[@]} -eq 0 ]; then step "all packages of apt.txt are installed"; return; fi
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "these packages are missing, and there is no sudo: ${missing[*]}"
    sudo=(sudo)
  fi
  step "installing ${#missing[@]} packages: ${missing[*]}"
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq || step "apt-get update failed: trying with the lists at hand"
  find_missing  # apt may only now know which of two names exists
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" </dev/null >/dev/null ||
    fail "apt-get could not install: ${missing[*]} (on Ubuntu, enable the component \"universe\")"
}

# configure FOLDER [cmake options] runs cmake.
configure() {
  local folder=$1; shift
  local launcher=()
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  step "configuring $folder"
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release "${launcher[@]}" "$@" >"$folder.configure.log" 2>&1 ||
    { cat "$folder.configure.log" >&2; fail "cmake failed"; }
}

# build FOLDER [targets] prints nothing on success and the end of the log on failure. On a terminal ninja shows its progress.
build() {
  local folder=$1; shift
  step "building $folder on $(nproc) processors (the first time takes some minutes)"
  if [ -t 1 ] && [ -z "${CI:-}" ]; then
    ninja -C "$folder" "$@" || fail "the build failed"
  else
    ninja -C "$folder" "$@" >"$folder.build.log" 2>&1 || { tail -n 200 "$folder.build.log" >&2; fail "the build failed"; }
  fi
}
