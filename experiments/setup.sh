#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that the experiments need and that are missing; nothing else.
# usage: experiments/setup.sh [--slurm]     --slurm: also what slurm/start.sh needs
set -euo pipefail

packages=(snakemake python3-matplotlib python3-numpy)
case "${1:-}" in
  "") ;;
  --slurm) packages+=(slurm-wlm munge) ;;
  -h|--help) sed -n '3,4s/^# //p' "$0"; exit 0 ;;
  *) echo "setup.sh: unknown option $1 (try --help)" >&2; exit 2 ;;
esac

"$(dirname "$0")/../scripts/install_packages.sh" "${packages[@]}"
