# SPDX-License-Identifier: BSD-3-Clause
"""The beginning of a CARMEN log, up to so many metres of driving by its odometry.

usage: cut_log.py LOG.gz METRES SHORTER.gz
"""
import gzip
import math
import sys


def main():
    source, metres, target = sys.argv[1], float(sys.argv[2]), sys.argv[3]
    driven, last = 0.0, None
    with gzip.open(source, "rt") as log, gzip.open(target, "wt", compresslevel=1) as shorter:
        for line in log:
            if line.startswith(("ODOM ", "FLASER ")):
                words = line.split()
                at = 1 if words[0] == "ODOM" else 2 + int(words[1]) + 3
                x, y = float(words[at]), float(words[at + 1])
                if last is not None:
                    driven += math.hypot(x - last[0], y - last[1])
                last = (x, y)
                if driven > metres:
                    break
            shorter.write(line)


if __name__ == "__main__":
    main()
