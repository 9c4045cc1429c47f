# SPDX-License-Identifier: BSD-3-Clause
"""One run of the program: map a log, hold the map against the truth, keep a small JSON of both.

usage: run.py --program FILE --log LOG --mask MASK -o RUN.json [--truth FILE] [--relations FILE]
              [--set key=value]... [--threads N] [--repeats N] [--keep DIR]

The map itself is thrown away; --keep leaves what `evaluate` and the figures read. With --repeats the
fastest of N runs is reported. Everything but `seconds`, `cpu_s` and `peak_memory_mib` is the same
each time.
"""
import argparse
import csv
import hashlib
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

# What closures.csv says of a closure that no mask offered: the finished map brought its ends near.
NOT_OFFERED = "near in the optimised map"
KEPT = ["nodes.tum", "graph.g2o", "trajectory.tum", "closures.csv", "summary.json", "floors"]


def cpu_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def call(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}\nexit code {done.returncode}")
    return done.stdout


def map_once(arguments, folder):
    command = [arguments.program, "map", arguments.log, "-o", folder, "--force", "--quiet",
               "--mask", arguments.mask, "--threads", str(arguments.threads)]
    for setting in arguments.set:
        command += ["--set", setting]
    before = cpu_of_children()
    call(command)
    cpu = cpu_of_children() - before
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file), cpu


def evaluate(arguments, folder):
    command = [arguments.program, "evaluate", folder, "--json"]
    for option in ("truth", "relations"):
        if getattr(arguments, option):
            command += ["--" + option, getattr(arguments, option)]
    return json.loads(call(command)) if len(command) > 4 else {}


def path_driven(folder):
    """Metres, and seconds, of the trajectory as it was mapped."""
    length, last, first_stamp = 0.0, None, None
    with open(os.path.join(folder, "trajectory.tum")) as file:
        for line in file:
            stamp, x, y = map(float, line.split()[:3])
            if last is None:
                last, first_stamp = (x, y), stamp
            step = ((x - last[0]) ** 2 + (y - last[1]) ** 2) ** 0.5
            if step > 0.05:  # less is the noise of a robot at rest
                length, last = length + step, (x, y)
    return length, stamp - first_stamp


def not_offered(folder):
    """Validated closures that no mask offered."""
    with open(os.path.join(folder, "closures.csv"), newline="") as file:
        return sum(row["state"] == "validated" and row["reason"] == NOT_OFFERED
                   for row in csv.DictReader(file))


def keep(folder, target):
    shutil.rmtree(target, ignore_errors=True)
    os.makedirs(target)
    for name in KEPT:
        source = pathlib.Path(folder, name)
        if source.is_dir():
            os.makedirs(os.path.join(target, name))
            for grid in [*source.glob("*.pgm"), *source.glob("*.yaml")]:
                shutil.copy(grid, os.path.join(target, name))
        elif source.exists():
            shutil.copy(source, target)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--log", required=True)
    parser.add_argument("--mask", required=True)
    parser.add_argument("--truth")
    parser.add_argument("--relations")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()

    with tempfile.TemporaryDirectory(prefix="masked_mapper_run_") as scratch:
        folder = os.path.join(scratch, "map")
        runs = [map_once(arguments, folder) for _ in range(arguments.repeats)]
        summary, cpu = min(runs, key=lambda run: run[0]["seconds"]["total"])
        length, duration = path_driven(folder)
        run = {
            "log": os.path.basename(arguments.log),
            "mask": arguments.mask,
            "settings": sorted(arguments.set),
            "threads": arguments.threads,
            "path_driven_m": round(length, 3),
            "duration_s": round(duration, 3),
            "counts": {**summary["counts"], "not_offered": not_offered(folder)},
            "floors": len(summary["floors"]),
            "area_m2": sum(floor["area_m2"] for floor in summary["floors"]),
            "motion": summary.get("motion", {}),
            "evaluation": evaluate(arguments, folder),
            "seconds": summary["seconds"],
            "cpu_s": round(cpu, 3),
            "peak_memory_mib": summary["peak_memory_mib"],
            "program": hashlib.sha256(pathlib.Path(arguments.program).read_bytes()).hexdigest()[:12],
        }
        if arguments.keep:
            keep(folder, arguments.keep)
    partial = arguments.output + ".part"
    with open(partial, "w") as file:
        json.dump(run, file, indent=1)
        file.write("\n")
    os.replace(partial, arguments.output)


if __name__ == "__main__":
    main()
