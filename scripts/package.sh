#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the program and its Debian packages, then proves them: unpacks them into a temporary prefix,
# runs the program from there, and builds and runs somebody else's project against the library.
# usage: scripts/package.sh [FOLDER]     FOLDER: where the .deb files go (build/package)
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
  -h|--help) sed -n '3,5s/^# //p' "$0"; exit 0 ;;
  -*) echo "package.sh: unknown option $1 (try --help)" >&2; exit 2 ;;
esac
packages=$(realpath -m "${1:-build/package}")
jobs=$(nproc)

cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
# Program and library; tests and examples are no part of the packages.
cmake --build build/release -j "$jobs" --target masked_mapper_installed
mkdir -p "$packages"
rm -f "$packages"/*masked-mapper*.deb
(cd build/release && cpack -B "$packages")
rm -rf "$packages/_CPack_Packages"

trial=$(mktemp -d)
trap 'rm -rf "$trial"' EXIT
for deb in "$packages"/*masked-mapper*.deb; do
  echo "$(basename "$deb"): $(dpkg-deb --field "$deb" Depends)"
  dpkg-deb --extract "$deb" "$trial/root"
done
prefix=$trial/root/usr

if grep -rF "$PWD" "$prefix/lib"/cmake "$prefix/lib"/*/cmake 2>/dev/null; then
  echo "package.sh: the CMake package names the folder that it was built in" >&2
  exit 1
fi
"$prefix/bin/masked_mapper" simulate --building corridors --length 60 --quiet -o "$trial/a.log"
"$prefix/bin/masked_mapper" map "$trial/a.log" -o "$trial/out" --quiet
[[ -s $trial/out/building.bt ]] || { echo "package.sh: the program wrote no map" >&2; exit 1; }

cmake -S tests/package -B "$trial/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$trial/build" -j "$jobs"
"$trial/build/own_mask" | grep -q doorways ||
  { echo "package.sh: the example's mask is not registered" >&2; exit 1; }
echo "packages in $packages: the program runs, and the library can be built on"
