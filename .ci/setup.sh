# shellcheck shell=bash
# Shared by ./run, ./check and .ci/run: installs what is missing, configures and builds. To be sourced by bash
# in the project's root.

say() { printf '== %s\n' "$*"; }

die() {
  printf '%s: %s\n' "$0" "$1" >&2
  exit "$2"
}

# missing_packages FILE...: the packages named in the files that are not installed, on one line.
missing_packages() {
  local wanted
  wanted=$(sed 's/#.*//' "$@" | tr -s '[:space:]' '\n' | sed '/^$/d')
  # shellcheck disable=SC2086  # one word a package
  comm -23 <(sort -u <<<"$wanted") \
    <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' $wanted 2>/dev/null | sed -n 's/ installed$//p' | sort -u) |
    paste -sd ' '
}

# install_missing FILE...: as root or through sudo; otherwise says what to run and stops with 2.
install_missing() {
  command -v dpkg-query >/dev/null || die "this is no Debian system; install what $* name, then build with: cmake --preset release && cmake --build --preset release" 2
  local missing as_root=()
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    sudo -n true 2>/dev/null || die "packages are missing; install them and start again: sudo apt-get update && sudo apt-get install -y --no-install-recommends $missing" 2
    as_root=(sudo -n)
  fi
  say "installing $missing"
  local log=build/install.log
  mkdir -p build
  # shellcheck disable=SC2086
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive sh -c \
    'apt-get update && apt-get install -y --no-install-recommends "$@"' sh $missing >"$log" 2>&1 ||
    { tail -n 20 "$log" >&2; die "apt-get failed; the whole output is in $log" 2; }
}

# build PRESET: into build/PRESET. A terminal sees the progress; otherwise only a failure is shown.
build() {
  local log=build/$1.log
  mkdir -p build
  say "configuring build/$1"
  cmake --preset "$1" >"$log" 2>&1 || { cat "$log" >&2; die "configuring failed" 3; }
  say "building build/$1 (the first time takes some minutes)"
  if [ -t 1 ]; then
    cmake --build --preset "$1" --parallel "$(nproc)" || die "building failed" 3
  else
    cmake --build --preset "$1" --parallel "$(nproc)" >>"$log" 2>&1 || { tail -n 60 "$log" >&2; die "building failed; the whole output is in $log" 3; }
  fi
}
