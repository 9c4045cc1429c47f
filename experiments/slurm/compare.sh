#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs a small sweep on this machine alone and through Slurm, and compares what they wrote file by
# file, seconds and memory apart. usage: experiments/slurm/compare.sh     (after start.sh)
set -euo pipefail

cd "$(dirname "$0")/.."
sinfo >/dev/null || { echo "compare.sh: no Slurm answers; run start.sh first" >&2; exit 1; }
rm -rf out/local out/slurm
targets() { echo "out/$1/sweep/robustness.csv" "out/$1/sweep/fig4.csv" "out/$1/sweep/fig5.csv"; }
# shellcheck disable=SC2046
snakemake -q -j"$(nproc)" --config profile=sweep out=out/local -- $(targets local)
# shellcheck disable=SC2046
snakemake -q --profile slurm/profile --config profile=sweep out=out/slurm -- $(targets slurm)
python3 slurm/compare.py out/local/sweep out/slurm/sweep
