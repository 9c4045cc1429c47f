# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the tests: skip REASON, and packages FOLDER, which puts a copy of the viewer's source with
# its npm packages there. Both tests may want them at once.

skip() {
  echo "skipped: $1"
  exit 77
}

packages() {
  local folder=$1
  command -v npm >/dev/null || skip "npm is not installed (apt-get install npm)"
  mkdir -p "$folder"
  exec 9>"$folder/lock"
  flock 9
  rm -rf "$folder/src" "$folder/test"
  cp -r "$viewer"/{package.json,package-lock.json,.npmrc,build.mjs,src,test} "$folder"
  if ! cmp -s "$folder/package-lock.json" "$folder/installed-lock.json"; then
    (cd "$folder" && npm ci --ignore-scripts --prefer-offline --loglevel=error) ||
      skip "the npm packages of viewer/package-lock.json cannot be fetched"
    cp "$folder/package-lock.json" "$folder/installed-lock.json"
  fi
  flock -u 9
}
