#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Starts a one-machine Slurm that listens on the loopback only, from Debian's packages
# (experiments/setup.sh --slurm). Needs root. All its files are in one folder; stop.sh ends it.
# usage: eval "$(sudo experiments/slurm/start.sh)"     sets SLURM_CONF for sbatch and squeue
set -euo pipefail

state=${SLURM_STATE:-/var/tmp/masked_mapper_slurm}
[[ $(id -u) -eq 0 ]] || { echo "start.sh: needs root" >&2; exit 1; }
for program in munged slurmctld slurmd; do
  command -v "$program" >/dev/null || PATH=$PATH:/usr/sbin
  command -v "$program" >/dev/null ||
    { echo "start.sh: no $program; run experiments/setup.sh --slurm" >&2; exit 1; }
done

running() { [[ -s $1 ]] && kill -0 "$(cat "$1")" 2>/dev/null; }

mkdir -p "$state"/{munge,controller,node}
chmod 755 "$state" "$state/munge"
if [[ ! -s $state/munge/key ]]; then
  (umask 077 && head -c 1024 /dev/urandom >"$state/munge/key")
fi
running "$state/munge/pid" ||
  munged --force --key-file="$state/munge/key" --socket="$state/munge/socket" \
    --pid-file="$state/munge/pid" --log-file="$state/munge/log" --seed-file="$state/munge/seed" >&2

cat >"$state/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$state/munge/socket
StateSaveLocation=$state/controller
SlurmctldPidFile=$state/controller.pid
SlurmctldLogFile=$state/controller.log
SlurmdSpoolDir=$state/node
SlurmdPidFile=$state/node.pid
SlurmdLogFile=$state/node.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
MinJobAge=3600
NodeName=localhost NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=local Nodes=localhost Default=YES MaxTime=INFINITE State=UP
CONF
chmod 644 "$state/slurm.conf"

export SLURM_CONF=$state/slurm.conf
running "$state/controller.pid" || slurmctld -c >&2
running "$state/node.pid" || slurmd -N localhost >&2
for _ in $(seq 60); do
  if [[ $(sinfo -h -o %T 2>/dev/null) =~ ^(idle|mixed|allocated)$ ]]; then
    echo "export SLURM_CONF=$SLURM_CONF"
    exit 0
  fi
  sleep 1
done
echo "start.sh: the node did not come up; see $state/*.log" >&2
exit 1
