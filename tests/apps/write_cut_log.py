#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Cuts a real log in two and puts a ride to another floor, a second real log, and the ride back in between.

usage: write_cut_log.py FIRST.clf.gz FIRST.relations SECOND.clf.gz SECOND.reference.txt FOLDER \\
           pressure|accel|floor cab|still|silent

FOLDER/cut.log       first half, ride up, the second log until it is back where it began, ride down, second half
FOLDER/*.relations   of the first log: before.relations and after.relations within a half, across.relations
On a ride the scanner sees a closed cab, or still what it saw last, or there are no scans at all.
The second log's scanner may have another number of beams. Odometry goes on through all of it, as of one robot.
"""
import gzip
import math
import sys

CLIMB = 4.0  # m
PASCAL_PER_METRE = 12.0
DOORS, RIDE = 5.0, 12.0  # s


def wrap(angle):
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def compose(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], wrap(a[2] + b[2]))


def inverse(a):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (-c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2])


def read_log(path):
    """Scans as (stamp, ranges as text, odometry), in order of stamps."""
    scans = []
    with gzip.open(path, "rt") as lines:
        for line in lines:
            if not line.startswith("FLASER"):
                continue
            words = line.split()
            beams = int(words[1])
            if len(words) < beams + 11:
                continue
            tail = words[beams + 2:]
            scans.append((float(tail[6]), words[2:beams + 2], tuple(float(v) for v in tail[3:6])))
    return sorted(scans, key=lambda scan: scan[0])


def read_poses(path):
    with open(path) as lines:
        return [tuple(float(v) for v in line.split()) for line in lines if line[0] != "#"]


def back_at_the_start(poses, after):
    """The stamp at which the robot is nearest to where it began, and its pose seen from there."""
    far = [p for p in poses if p[0] - poses[0][0] > after]
    there = min(far, key=lambda p: math.hypot(p[1] - poses[0][1], p[2] - poses[0][2]))
    return there[0], compose(inverse(poses[0][1:]), there[1:])


class Writer:
    def __init__(self, out, source, view):
        self.out, self.source, self.view, self.begin = out, source, view, None
        self.height, self.pressure_at, self.acceleration_at = 0.0, 0.0, 0.0

    def sense(self, t, vertical=0.0):
        """Pressure at 2 Hz, or acceleration at 25 Hz, up to t."""
        while self.source == "pressure" and self.pressure_at <= t:
            pascal = 101325.0 - PASCAL_PER_METRE * self.height + 1.5 * math.sin(1.7 * self.pressure_at)
            self.out.write("PRESSURE %.2f %.6f robot 0\n" % (pascal, self.pressure_at))
            self.pressure_at += 0.5
        while self.source == "accel" and self.acceleration_at <= t:
            noise = 0.05 * math.sin(40.0 * self.acceleration_at)
            self.out.write(
                "ACCEL %.3f 0 %.3f %.6f robot 0\n" % (noise, 9.81 + noise + vertical, self.acceleration_at))
            self.acceleration_at += 0.04

    def scan(self, t, ranges, pose, vertical=0.0):
        if self.begin is None:
            self.begin = self.pressure_at = self.acceleration_at = t
        self.sense(t, vertical)
        where = "%.6f %.6f %.6f" % pose
        self.out.write("FLASER %d %s %s %s %.6f robot 0\n" % (len(ranges), " ".join(ranges), where, where, t))

    def label(self, t, label):
        if self.source == "floor":
            self.out.write("FLOOR %s %.6f robot 0\n" % (label, t))

    def ride(self, t, pose, last_ranges, turn, climb):
        """In a closed cab of 2 m by 2 m, turning round in it. Returns time and pose on the way out."""
        speed = climb / (RIDE - 2.0)
        end = t + RIDE + 2.0 * DOORS
        begin, t0, base = self.height, t, pose
        self.label(t + 0.1, "-")
        while t < end:
            t += 0.2
            done = min(1.0, max(0.0, (t - t0 - DOORS) / RIDE))
            now = compose(base, (turn[0] * done, turn[1] * done, turn[2] * done))
            heading = now[2] - base[2]
            ranges = []
            for beam in range(180):
                angle = heading + math.radians(beam - 90.0)
                ranges.append("%.2f" % (1.0 / max(abs(math.cos(angle)), abs(math.sin(angle)))))
            since = t - t0 - DOORS  # speeds up for 2 s, goes on, slows down for 2 s
            up = 0.0
            if 0.0 <= since < RIDE:
                up = speed / 2.0 if since < 2.0 else (-speed / 2.0 if since >= RIDE - 2.0 else 0.0)
                self.height = begin + speed * (
                    since * since / 4.0 if since < 2.0 else since - 1.0 if since < RIDE - 2.0 else
                    RIDE - 2.0 - (RIDE - since)**2 / 4.0)
            elif since >= RIDE:
                self.height = begin + climb
            if self.view == "silent":
                self.sense(t, up)
            else:
                self.scan(t, ranges if self.view == "cab" else last_ranges, now, up)
        return t, compose(base, turn)


def main():
    first_path, relations_path, second_path, reference_path, folder, source, view = sys.argv[1:]
    first = read_log(first_path)
    cut = len(first) // 2
    second = read_log(second_path)
    back, seen_from_start = back_at_the_start(read_poses(reference_path), 500.0)
    second = [scan for scan in second if scan[0] <= back]
    with open(folder + "/cut.log", "w") as out:
        writer = Writer(out, source, view)
        writer.label(first[0][0], "0")
        for t, ranges, pose in first[:cut]:
            writer.scan(t, ranges, pose)
        t, pose = first[cut - 1][0], first[cut - 1][2]
        t, pose = writer.ride(t, pose, ranges, (0.0, 0.0, 0.0), CLIMB)
        writer.label(t + 0.1, "1")
        begin, T_here_odom = t + 0.2 - second[0][0], compose(pose, inverse(second[0][2]))
        for stamp, ranges, odometry in second:
            t, pose = begin + stamp, compose(T_here_odom, odometry)
            writer.scan(t, ranges, pose)
        # No ride moves anybody sideways: in the cab the robot gets back to the very pose it came with.
        t, pose = writer.ride(t, pose, ranges, inverse(seen_from_start), -CLIMB)
        writer.label(t + 0.1, "0")
        shift, T_here_odom = t + 0.2 - first[cut - 1][0], compose(pose, inverse(first[cut - 1][2]))
        for stamp, ranges, odometry in first[cut:]:
            writer.scan(shift + stamp, ranges, compose(T_here_odom, odometry))

    stamp_of_cut = first[cut - 1][0]
    files = {name: open("%s/%s.relations" % (folder, name), "w") for name in ("before", "across", "after")}
    with open(relations_path) as lines:
        for line in lines:
            words = line.split()
            if not words or words[0][0] == "#":
                continue
            stamps = [float(v) for v in words[:2]]
            late = [stamp > stamp_of_cut for stamp in stamps]
            name = "after" if all(late) else "across" if any(late) else "before"
            stamps = [stamp + shift if is_late else stamp for stamp, is_late in zip(stamps, late)]
            files[name].write("%.6f %.6f %s\n" % (*stamps, " ".join(words[2:])))
    for file in files.values():
        file.close()


if __name__ == "__main__":
    main()
