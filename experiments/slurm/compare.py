# SPDX-License-Identifier: BSD-3-Clause
"""Compares two folders of results file by file; seconds and memory may differ, nothing else.

usage: compare.py FOLDER FOLDER SUMMARY.json     exit code 1 when they differ
"""
import csv
import json
import pathlib
import sys

MEASURED = {"seconds", "cpu_s", "peak_memory_mib"}
DRAWS_SECONDS = {"robustness", "scaling", "table1"}  # their figures


def content(path):
    if path.suffix == ".json":
        with open(path) as file:
            return {key: value for key, value in json.load(file).items() if key not in MEASURED}
    if path.suffix == ".csv":
        with open(path, newline="") as file:
            return [{key: value for key, value in row.items()
                     if not key.endswith("_s") and not key.endswith("_mib")}
                    for row in csv.DictReader(file)]
    return path.read_bytes()


def files_in(folder):
    return {path.relative_to(folder) for path in folder.rglob("*")
            if path.is_file() and not (path.suffix in (".svg", ".png") and
                                       path.stem in DRAWS_SECONDS)}


def main():
    one, other = map(pathlib.Path, sys.argv[1:3])
    names = files_in(one) | files_in(other)
    differing = [name for name in sorted(names)
                 if not ((one / name).is_file() and (other / name).is_file() and
                         content(one / name) == content(other / name))]
    for name in differing:
        print(f"differs: {name}")
    with open(sys.argv[3], "w") as file:
        json.dump({"files": len(names), "same": len(names) - len(differing)}, file)
    print(f"{len(names) - len(differing)} of {len(names)} files are the same")
    sys.exit(1 if differing or not names else 0)


if __name__ == "__main__":
    main()
