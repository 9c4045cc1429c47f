#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Faults planted in finished maps: does `doubts` of summary.json list them where they are?

usage: planted_faults.py --program FILE -o FAULTS.csv [--seed N] [--each N] MAP...
                         [--labelled LOG...]

MAP is a folder that `map` wrote, of a map that is right. Into a copy of each goes, one at a time,
  bend     an edge of the way, turned by 3 to 15 degrees
  wrong    a closure that is off by 0.5 to 3 m and up to 15 degrees
  missing  no closure between what was driven before and after some moment
  merged   two floors made one
and the program solves and judges the map again (`export --edits`). Of each LOG, which has FLOOR
lines, a visit is given another floor's label (`label`), and it is mapped.

A fault is listed when a doubt lies within 5 m of its place. What leaves every pose of the map
within 0.3 m and 3 degrees of where it was (a missing closure often does) is no fault: `harmless`.
The map as it is goes through first (`none`): each of its doubts is a false one.
"""
import argparse
import bisect
import csv
import gzip
import json
import math
import pathlib
import random
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import zlib

NEAR_M = 5.0
HARMLESS_M, HARMLESS_DEG = 0.3, 3.0


def between(a, b):
    """T_a_b of two poses in one frame."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    c, s = math.cos(a[2]), math.sin(a[2])
    turn = math.remainder(b[2] - a[2], math.tau)
    return c * dx + s * dy, c * dy - s * dx, turn


def checksum(database, table):
    """As docs/map_file.md says."""
    columns = [row[1] for row in database.execute(f"pragma table_info({table})")]
    crc = 0
    for row in database.execute(f"select {','.join(columns)} from {table} order by id"):
        for value in row:
            if value is None:
                packed = b"\0"
            elif isinstance(value, int):
                packed = b"\1" + struct.pack("<q", value)
            elif isinstance(value, float):
                packed = b"\2" + struct.pack("<d", value)
            else:
                kind, content = (b"\3", value.encode()) if isinstance(value, str) else (b"\4", value)
                packed = kind + struct.pack("<q", len(content)) + content
            crc = zlib.crc32(packed, crc)
    return crc


class Map:
    def __init__(self, folder):
        self.file = pathlib.Path(folder) / "building.mmap"
        database = sqlite3.connect(f"file:{self.file}?mode=ro", uri=True)
        self.nodes = database.execute(
            "select stamp, floor, world_x, world_y, world_theta from nodes order by id").fetchall()
        self.edges = database.execute(
            "select id, from_node, to_node, kind from edges order by id").fetchall()
        self.labels = [row[0] for row in database.execute("select label from floors order by id")]
        database.close()

    def pose(self, node):
        return self.nodes[node][2:5]

    def closures(self):
        return [(a, b) for _, a, b, kind in self.edges if kind == "closure"]


def stamp(value):
    return repr(value)


def forbid(model, pairs):
    return "".join(f"- forbid_closure: {{from: {stamp(model.nodes[b][0])}, "
                   f"to: {stamp(model.nodes[a][0])}}}\n" for a, b in pairs)


class Fault:
    """`edits`, what else to do to the copy of the map, and the places where it may be listed."""

    def __init__(self, kind, edits, places, bent=None):
        self.kind, self.edits, self.places, self.bent = kind, edits, places, bent


def bend(model, chance):
    way = [(i, a, b) for i, a, b, kind in model.edges
           if kind == "odometry" and model.nodes[a][1] == model.nodes[b][1]
           and math.dist(model.pose(a)[:2], model.pose(b)[:2]) > 0.5]
    closures = model.closures()
    if not way or not closures:
        return None
    edge, a, b = chance.choice(way)
    turn = math.radians(chance.choice((-1, 1)) * chance.uniform(3.0, 15.0))
    # An edit that pulls at the graph, so that it is solved again: the closure farthest from here.
    far = max(closures, key=lambda pair: math.dist(model.pose(pair[0])[:2], model.pose(a)[:2]))
    places = [model.nodes[n][0] for n in (a, b)]
    return Fault("bend", forbid(model, [far]), places, (edge, turn))


def wrong(model, chance):
    for _ in range(1000):
        a, b = sorted(chance.sample(range(len(model.nodes)), 2))
        if model.nodes[a][1] == model.nodes[b][1] and b - a > 10 and \
                math.dist(model.pose(a)[:2], model.pose(b)[:2]) < 6.0:
            break
    else:
        return None
    x, y, turn = between(model.pose(b), model.pose(a))
    off, way = chance.uniform(0.5, 3.0), chance.uniform(0.0, math.tau)
    turned = math.degrees(turn) + chance.uniform(-15.0, 15.0)
    edit = (f"- add_closure: {{from: {stamp(model.nodes[b][0])}, to: {stamp(model.nodes[a][0])}, "
            f"transform: [{x + off * math.cos(way):.4f}, {y + off * math.sin(way):.4f}, "
            f"{turned:.3f}]}}\n")
    return Fault("wrong", edit, [model.nodes[n][0] for n in (a, b)])


def missing(model, chance):
    closures = model.closures()
    if not closures:
        return None
    cut = chance.choice(closures)[1]
    gone = dict.fromkeys((a, b) for a, b in closures if min(a, b) < cut <= max(a, b))
    return Fault("missing", forbid(model, gone),
                 [model.nodes[n][0] for pair in gone for n in pair])


def merged(model, chance):
    if len(model.labels) < 2:
        return None
    gone, stays = chance.sample(range(len(model.labels)), 2)
    edit = f'- same_floor: {{floor: "{model.labels[gone]}", as: "{model.labels[stays]}"}}\n'
    return Fault("merged", edit, [node[0] for node in model.nodes if node[1] == gone])


def run(command):
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}")


def trajectory(folder):
    """Stamps, and x, y, heading at each."""
    stamps, poses = [], []
    with open(folder / "trajectory.tum") as file:
        for line in file:
            words = [float(word) for word in line.split()]
            stamps.append(words[0])
            poses.append((words[1], words[2], 2.0 * math.atan2(words[6], words[7])))
    return stamps, poses


def doubts(folder):
    with open(folder / "summary.json") as file:
        return json.load(file)["doubts"]


def is_listed(found, places, where):
    stamps, poses = where
    at = [poses[min(bisect.bisect_left(stamps, place), len(poses) - 1)] for place in places]
    return any(math.dist((doubt["x"], doubt["y"]), pose[:2]) <= NEAR_M
               for doubt in found for pose in at)


def is_harmless(kind, before, after):
    if kind == "merged":
        return False
    def moved(a, b):
        return math.dist(a[:2], b[:2]), abs(math.degrees(math.remainder(a[2] - b[2], math.tau)))
    # A map may turn about its first pose without being wrong: what counts is how neighbours lie.
    span = 50
    worst_m = worst_deg = 0.0
    for step in (span, len(before[1]) // 3 + 1, 2 * (len(before[1]) // 3) + 1):
        for i in range(0, len(before[1]) - step, 10):
            metres, degrees = moved(between(before[1][i], before[1][i + step]),
                                    between(after[1][i], after[1][i + step]))
            near = math.dist(before[1][i][:2], before[1][i + step][:2]) < 10.0
            if near:
                worst_m, worst_deg = max(worst_m, metres), max(worst_deg, degrees)
    return worst_m <= HARMLESS_M and worst_deg <= HARMLESS_DEG


def judge_map(program, folder, each, chance, scratch, report):
    model, copy, out = Map(folder), scratch / "copy.mmap", scratch / "out"
    export = [program, "export", str(copy), "--format", "all", "-o", str(out), "--force", "--quiet",
              "--set", "grid.resolution_m=0.3"]
    shutil.copy(model.file, copy)
    run(export)
    right = trajectory(out)
    report(folder, "none", bool(doubts(out)), False, len(doubts(out)))
    for plant in (bend, wrong, missing, merged):
        for _ in range(each):
            fault = plant(model, chance)
            if fault is None:
                continue
            shutil.copy(model.file, copy)
            if fault.bent:
                database = sqlite3.connect(copy)
                edge, turn = fault.bent
                database.execute("update edges set theta = theta + ? where id = ?", (turn, edge))
                database.execute("update content set checksum = ? where name = 'edges'",
                                 (checksum(database, "edges"),))
                database.commit()
                database.close()
            (scratch / "edits.yaml").write_text(fault.edits)
            run(export + ["--edits", str(scratch / "edits.yaml")])
            found, now = doubts(out), trajectory(out)
            report(folder, fault.kind, is_listed(found, fault.places, now),
                   is_harmless(fault.kind, right, now), len(found))


def judge_labels(program, log, each, chance, scratch, report):
    opened = gzip.open if log.endswith(".gz") else open
    with opened(log, "rt") as file:
        lines = file.readlines()
    at = [i for i, line in enumerate(lines) if line.startswith("FLOOR ")]
    said = [i for i in at if lines[i].split()[1] != "-"]
    names = sorted({lines[i].split()[1] for i in said})
    if len(names) < 2 or len(said) < 2:
        return
    for _ in range(each):
        line = chance.choice(said[1:])
        words = lines[line].split()
        other = chance.choice([name for name in names if name != words[1]])
        mislabelled = scratch / "mislabelled.log"
        mislabelled.write_text("".join(lines[:line]) + " ".join(["FLOOR", other] + words[2:]) +
                               "\n" + "".join(lines[line + 1:]))
        out = scratch / "out"
        run([program, "map", str(mislabelled), "-o", str(out), "--force", "--quiet", "--set",
             "grid.resolution_m=0.3"])
        begin = float(words[2])
        end = next((float(lines[i].split()[2]) for i in at if i > line), math.inf)
        where = trajectory(out)
        places = [s for s in where[0] if begin <= s <= end]
        report(log, "label", is_listed(doubts(out), places, where), False, len(doubts(out)))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=1, help="faults of a kind in each map")
    parser.add_argument("--labelled", nargs="*", default=[])
    parser.add_argument("maps", nargs="*")
    arguments = parser.parse_args()
    counts = {}
    with open(arguments.output, "w", newline="") as file, tempfile.TemporaryDirectory() as scratch:
        table = csv.writer(file)
        table.writerow(["map", "fault", "listed", "harmless", "doubts"])

        def report(name, kind, listed, harmless, number):
            table.writerow([name, kind, int(listed), int(harmless), number])
            file.flush()
            count = counts.setdefault(kind, [0, 0])
            count[0] += not harmless
            count[1] += listed and not harmless

        for number, folder in enumerate(arguments.maps):
            chance = random.Random(1000 * arguments.seed + number)
            judge_map(arguments.program, folder, arguments.each, chance, pathlib.Path(scratch),
                      report)
        for number, log in enumerate(arguments.labelled):
            chance = random.Random(1000 * arguments.seed + number)
            judge_labels(arguments.program, log, arguments.each, chance, pathlib.Path(scratch),
                         report)
    for kind, (planted, listed) in counts.items():
        print(f"{kind:8s} {listed} of {planted}" +
              (" right maps have doubts" if kind == "none" else " listed within 5 m"))


if __name__ == "__main__":
    main()
