#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs a small sweep on this machine alone and through Slurm, and compares what they wrote file by
# file, seconds and memory apart. usage: experiments/slurm/compare.sh     (after start.sh)
set -euo pipefail

cd "$(dirname "$0")/.."
sinfo >/dev/null || { echo "compare.sh: no Slurm answers; run start.sh first" >&2; exit 1; }
targets=(sweep/robustness.csv sweep/fig4.csv sweep/fig5.csv)
out=../out/compare
rm -rf "$out"
snakemake "${targets[@]}" -j"$(nproc)" --quiet --config profile=sweep out="$out/local"
snakemake "${targets[@]}" --profile "$PWD/slurm/profile" --quiet \
  --config profile=sweep out="$out/slurm"
python3 slurm/compare.py "$out/local/sweep" "$out/slurm/sweep" "$out/summary.json"
