#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds dist/viewer.html and dist/LICENSES.txt from src/ and the packages of package-lock.json.
# usage: viewer/build.sh [FOLDER]      FOLDER: where to build to instead of viewer/dist
set -euo pipefail
destination=$(realpath -m "${1:-$(dirname "$0")/dist}")
cd "$(dirname "$0")"
# The packages' own scripts are not needed, so they are not run.
npm ci --ignore-scripts --prefer-offline --loglevel=error
node build.mjs "$destination"
