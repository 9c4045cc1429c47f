#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What Snakemake asks of a job: running, success or failed.
set -euo pipefail

state=$(scontrol -o show job "$1" 2>/dev/null | sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p')
case $state in
  COMPLETED) echo success ;;
  PENDING|CONFIGURING|RUNNING|COMPLETING|SUSPENDED|"") echo running ;;
  *) echo failed ;;
esac
