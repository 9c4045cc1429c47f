#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills a mapping run at random moments, lets it go on with --resume, and holds what it ends with
against an unbroken run, byte for byte.

usage: kill_and_resume.py PROGRAM LOG [--times N] [--kills K] [--seed S] [-- flags of map ...]

Prints a line per broken run: when it was killed, how long the rest took, and whether the bytes are
the same. Exit code 1 when any differ.
"""
import argparse
import filecmp
import json
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time


def files_below(folder):
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())


def differing(a, b):
    """Files that differ, but for the two that tell of the run itself."""
    own = {"summary.json", "report.html"}
    names = set(files_below(a)) | set(files_below(b))
    return sorted(n for n in names - own
                  if not ((a / n).is_file() and (b / n).is_file()
                          and filecmp.cmp(a / n, b / n, shallow=False)))


def without_seconds(path):
    summary = json.loads(path.read_text())
    for key in ("seconds", "peak_memory_mib"):
        summary.pop(key, None)
    return summary


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("log")
    parser.add_argument("--times", type=int, default=50)
    parser.add_argument("--kills", type=int, default=1, help="per broken run")
    parser.add_argument("--seed", type=int, default=1)
    arguments, flags = parser.parse_known_args()
    flags = [flag for flag in flags if flag != "--"]
    rng = random.Random(arguments.seed)
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="kill_and_resume_"))
    try:
        return run(arguments, flags, rng, scratch)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def run(arguments, flags, rng, scratch):
    def start(out):
        return subprocess.Popen([arguments.program, "map", arguments.log, "-o", str(out),
                                 "--resume", "--quiet"] + flags)

    whole = scratch / "whole"
    began = time.monotonic()
    if start(whole).wait() != 0:
        return 1
    whole_seconds = time.monotonic() - began
    print(f"unbroken: {whole_seconds:.1f} s", flush=True)
    same = 0
    for i in range(arguments.times):
        out = scratch / "broken"
        shutil.rmtree(out, ignore_errors=True)
        killed = []
        for _ in range(arguments.kills):
            process = start(out)
            moment = rng.uniform(0.0, whole_seconds)
            try:
                process.wait(timeout=moment)
                break
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.wait()
                killed.append(f"{moment:.2f}")
        began = time.monotonic()
        code = start(out).wait()
        rest = time.monotonic() - began
        wrong = [f"exit code {code}"] if code != 0 else differing(whole, out)
        if not wrong and without_seconds(whole / "summary.json") != without_seconds(
                out / "summary.json"):
            wrong = ["summary.json"]
        left = [p.name for p in scratch.iterdir() if p.name not in ("whole", "broken")]
        wrong += [name + " is left" for name in left if ".partial-" not in name]
        for name in left:
            shutil.rmtree(scratch / name, ignore_errors=True)
        same += not wrong
        print(f"{i + 1}: killed after {' + '.join(killed) or 'its end'} s, the rest took "
              f"{rest:.1f} s: {'differs: ' + ', '.join(wrong) if wrong else 'the same'}", flush=True)
    print(f"{same} of {arguments.times} the same")
    return 0 if same == arguments.times else 1


if __name__ == "__main__":
    sys.exit(main())
