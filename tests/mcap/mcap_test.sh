#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# MCAP as Foxglove's own library reads and writes it: a simulated drive is read by it as we wrote it,
# and gives the same map when it has written it anew.
# usage: mcap_test.sh FOLDER PROGRAM      FOLDER: to work in; PROGRAM: masked_mapper
set -euo pipefail
here=$(realpath "$(dirname "$0")")
skip() {
  echo "skipped: $1"
  exit 77
}
command -v npm >/dev/null || skip "npm is not installed (apt-get install npm)"
mkdir -p "$1"
cp "$here"/{package.json,package-lock.json,.npmrc,check.mjs} "$1"
(cd "$1" && npm ci --ignore-scripts --prefer-offline --loglevel=error) ||
  skip "the npm packages of tests/mcap/package-lock.json cannot be fetched"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
program=$2
"$program" simulate --building office --length 60 -o "$work/drive.mcap" --quiet
counts=$(node "$1/check.mjs" "$work/drive.mcap")
echo "$counts"
scans=$(wc -l <"$work/drive.mcap.truth.tum")
[[ $counts == *"\"/scan\":$scans"[,}]* ]] || { echo "not the $scans scans of the truth" >&2; exit 1; }

map() { "$program" map "$1" -o "$2" --quiet --threads 1; }
map "$work/drive.mcap" "$work/ours"
for kind in plain zstd shuffled; do
  node "$1/check.mjs" "$work/drive.mcap" "$work/$kind.mcap" "$kind" >/dev/null
  map "$work/$kind.mcap" "$work/$kind"
  for file in building.bt trajectory.tum graph.g2o; do
    cmp "$work/ours/$file" "$work/$kind/$file"
  done
done
