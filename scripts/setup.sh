#!/usr/bin/env bash
# What demo.sh and test.sh share: installs what is missing, configures and builds. Sourced by them, from the project's root.
set -euo pipefail

say() { printf '\n== %s\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

packages=(
  g++ cmake ninja-build pkg-config
  libtinyobjloader-dev libtinygltf-dev libopenmesh-dev libcli11-dev libflatbuffers-dev flatbuffers-compiler
  libopenexr-dev libimath-dev openexr libtbb-dev libfmt-dev libxxhash-dev libstb-dev nlohmann-json3-dev
  doctest-dev libembree-dev
)

install_missing() {
  command -v dpkg-query >/dev/null || die "this script installs Debian packages, and this is no Debian system; install by hand: ${packages[*]}"
  local missing=() package
  for package in "${packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  say "Installing ${#missing[@]} packages: ${missing[*]}"
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "packages are missing, and only root can install them: apt-get install ${missing[*]}"
    root=(sudo)
  fi
  "${root[@]}" apt-get update -qq || die "apt-get update failed: is the network there?"
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null ||
    die "apt-get could not install ${missing[*]}"
}

# build TARGET...: configures once, builds the targets (all, if none is named).
build() {
  if [ ! -f build/build.ninja ]; then
    say "Configuring"
    cmake --preset release ${KD_CMAKE_FLAGS:-} | grep -E '^-- (kdtrace|  )' || die "configuring failed: run cmake --preset release to see why"
  fi
  say "Building"
  local names=()
  [ $# -gt 0 ] && names=(--target "$@")
  cmake --build build "${names[@]}" || die "building failed"
}
