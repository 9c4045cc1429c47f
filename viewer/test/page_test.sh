#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps the log in data/, looks at its report in headless Chromium, and edits the map as it proposes.
# usage: page_test.sh FOLDER PROGRAM      FOLDER: to work in; PROGRAM: masked_mapper
set -euo pipefail
viewer=$(realpath "$(dirname "$0")/..")
# shellcheck source=packages.sh
source "$viewer/test/packages.sh"
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
[[ -n $chromium ]] || skip "Chromium is not installed (apt-get install chromium)"
packages "$1"
map=$(mktemp -d)
trap 'rm -rf "$map"' EXIT
# A name that would be markup if it were taken for it.
log="$map/<b>office & '\"<script>alert(1)<!--.log.gz"
cp "$viewer/../data/office.log.gz" "$log"
"$2" map "$log" -o "$map/out" --quiet
# From where the drive began to where half of it was done.
scan() { awk -v line="$2" 'NR == line {print "t=" $1}' "$1/trajectory.tum"; }
scans=$(wc -l < "$map/out/trajectory.tum")
"$2" route "$map/out" --from "$(scan "$map/out" 1)" --to "$(scan "$map/out" $((scans / 2)))" \
  --report "$map/way.html" --quiet
cat > "$map/hall.txt" <<'EOT'
building hall
floor 0 0
wall -2 -3 12 -3 12 3 8 3 8 4 6 4 6 3 -2 3 -2 -3
box 3 2 20 1 0.5
overhead 7 -1.5 0 1.6 0.8 0.7 0.75
point a 0 0
point b 10 0
corridor a b
EOT
"$2" simulate --building "$map/hall.txt" --lidar vlp16 --lidar-rate 2 -o "$map/hall.mcap" --quiet
"$2" map "$map/hall.mcap" -o "$map/hall" --quiet
node "$1/test/page_test.mjs" "$chromium" "$map/out/report.html" "$map/edits.yaml" "$map/way.html" \
  "$map/hall/report.html"
"$2" export "$map/out" --format all --edits "$map/edits.yaml" -o "$map/edited" --quiet
validated() { grep -c ',validated,' "$1/closures.csv"; }
[[ $(validated "$map/edited") -eq $(validated "$map/out") ]] ||
  { echo "one closure in and one out leave $(validated "$map/edited")" >&2; exit 1; }
! cmp -s "$map/out/closures.csv" "$map/edited/closures.csv"
