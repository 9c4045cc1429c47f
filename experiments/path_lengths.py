# SPDX-License-Identifier: BSD-3-Clause
"""Path-length errors of maps of one real log, as the paper measures them.

usage: path_lengths.py PROGRAM OUT.json MAP...     (MAP.json beside MAP is its run)

The truth is the shortest way over those of the maps that were found free of false closures and that
closed loops at all. Maps are checked against the reference trajectory; where a log has none, no map
counts as checked.
"""
import json
import subprocess
import sys


def run_of(map_folder):
    with open(map_folder + ".json") as file:
        return json.load(file)


def is_checked(run):
    closures = run["evaluation"].get("closures")
    return closures is not None and closures["checked"] > 0 and closures["false"] == 0


def main():
    program, output, maps = sys.argv[1], sys.argv[2], sys.argv[3:]
    checked = [folder for folder in maps if is_checked(run_of(folder))]
    errors = {}
    for folder in maps if checked else []:
        text = subprocess.run([program, "evaluate", folder, "--json", "--checked", *checked],
                              check=True, stdout=subprocess.PIPE, text=True).stdout
        errors[folder + ".json"] = json.loads(text)["path_length"]
    with open(output, "w") as file:
        json.dump({"checked": [folder + ".json" for folder in checked], "errors": errors}, file,
                  indent=1)


if __name__ == "__main__":
    main()
