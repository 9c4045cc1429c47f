#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that the build and the tests need and that are missing; nothing else.
# usage: scripts/setup.sh [--build-only]     --build-only: leave out what only the checks need
set -euo pipefail

packages=(
  build-essential cmake ninja-build
  libeigen3-dev libpcl-dev liboctomap-dev libceres-dev
  libyaml-cpp-dev libcli11-dev nlohmann-json3-dev zlib1g-dev libbz2-dev libdeflate-dev
  liblz4-dev libzstd-dev libsqlite3-dev libfastcdr-dev
  libgtest-dev
)
checks=(
  clang-format clang-tidy python3 file dpkg-dev
  octomap-tools
  python3-rosbag python3-sensor-msgs python3-nav-msgs python3-tf2-msgs  # to write test bags
)
# Of the report page's tests; Node.js often comes from elsewhere, and then brings npm along.
command -v npm >/dev/null || checks+=(nodejs npm)
command -v chromium >/dev/null || checks+=(chromium)

case "${1:-}" in
  "") packages+=("${checks[@]}") ;;
  --build-only) ;;
  -h|--help) sed -n '3,4s/^# //p' "$0"; exit 0 ;;
  *) echo "setup.sh: unknown option $1 (try --help)" >&2; exit 2 ;;
esac

"$(dirname "$0")/install_packages.sh" "${packages[@]}"
