#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Sets up, builds, maps the bundled log and says what it wrote and how to look at it.
# usage: scripts/demo.sh [LOG [OUT]]     default: data/office.log.gz into out-demo
set -euo pipefail
cd "$(dirname "$0")/.."

log=${1:-data/office.log.gz}
out=${2:-out-demo}

scripts/setup.sh --build-only
echo "demo: building (a few minutes the first time)"
mkdir -p build/release
cmake --preset release >build/release/configure.log 2>&1 || { cat build/release/configure.log >&2; exit 1; }
cmake --build --preset release -j "$(nproc)" --target masked_mapper

program=build/release/apps/masked_mapper
echo "demo: $program map $log -o $out --mask openings --force"
"$program" map "$log" -o "$out" --mask openings --force

cat <<END

The map is in $out:
$(cd "$out" && find . -type f -printf '  %P  %k KiB\n' | sort)

How to look at it:
  any browser on $out/report.html            all floors in 3D, closures, plots, options
  octovis $out/building.bt                   the building as an octree       (apt install octovis)
  pcl_viewer $out/building.pcd               its floors, told apart by colour (apt install pcl-tools)
  any picture viewer on $out/floors/*.pgm    the plan of each floor
  less $out/summary.json                     counts, floors, times, options
Your own log: $program map LOG -o OUT       ($program --help)
END
