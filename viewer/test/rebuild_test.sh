#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The committed page is what its source builds. usage: rebuild_test.sh FOLDER (to work in)
set -euo pipefail
viewer=$(realpath "$(dirname "$0")/..")
# shellcheck source=packages.sh
source "$viewer/test/packages.sh"
packages "$1"
cd "$1"
node build.mjs rebuilt
for file in viewer.html LICENSES.txt; do
  cmp "rebuilt/$file" "$viewer/dist/$file" ||
    { echo "viewer/dist/$file is not what viewer/src builds: run viewer/build.sh" >&2; exit 1; }
done
