#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs those of the named Debian packages that are missing, as root or with sudo.
# usage: scripts/install_packages.sh PACKAGE...
set -euo pipefail

missing=()
for package in "$@"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: these Debian packages are missing, and installing them needs root or sudo:" >&2
    echo "  ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "setup: installing ${#missing[@]} Debian packages (a few minutes): ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o Dpkg::Use-Pty=0 "$@" >"$log" 2>&1 ||
    { tail -n 30 "$log" >&2; echo "setup: apt-get $1 failed" >&2; exit 1; }
}
apt_get update
apt_get install --no-install-recommends "${missing[@]}"
echo "setup: done"
