#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Ends what start.sh started and removes its folder.
set -euo pipefail

state=${SLURM_STATE:-/var/tmp/masked_mapper_slurm}
for daemon in node controller munge/; do
  file=$state/$daemon.pid
  [[ $daemon != munge/ ]] || file=$state/munge/pid
  [[ ! -s $file ]] || kill "$(cat "$file")" 2>/dev/null || true
done
sleep 2
rm -rf "$state"
