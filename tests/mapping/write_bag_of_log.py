#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the ROBOTLASER1 lines of a log as a bag of LaserScan, Odometry and a static mount.

usage: write_bag_of_log.py LOG OUT.bag
"""
import math
import sys

import genpy
import rosbag
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage


def main():
    with open(sys.argv[1]) as lines, rosbag.Bag(sys.argv[2], "w", compression="bz2") as bag:
        mount = TransformStamped()
        mount.header.frame_id, mount.child_frame_id = "base_link", "laser"
        mount.transform.rotation.w = 1.0
        has_mount = False
        for line in lines:
            words = line.split()
            if not words or words[0] != "ROBOTLASER1":
                continue
            beams = int(words[8])
            tail = words[9 + beams:]
            tail = [float(word) for word in tail[1 + int(tail[0]):-2]] + [float(tail[-3])]
            stamp = genpy.Time.from_sec(tail[-1])
            if not has_mount:
                mount.header.stamp = stamp
                bag.write("/tf_static", TFMessage([mount]), stamp)
                has_mount = True

            odometry = Odometry()
            odometry.header.stamp = stamp
            odometry.header.frame_id, odometry.child_frame_id = "odom", "base_link"
            odometry.pose.pose.position.x, odometry.pose.pose.position.y = tail[3:5]
            odometry.pose.pose.orientation.z = math.sin(tail[5] / 2)
            odometry.pose.pose.orientation.w = math.cos(tail[5] / 2)
            bag.write("/odom", odometry, stamp)

            scan = LaserScan()
            scan.header.stamp, scan.header.frame_id = stamp, "laser"
            scan.angle_min, scan.angle_increment = float(words[2]), float(words[4])
            scan.angle_max = scan.angle_min + (beams - 1) * scan.angle_increment
            scan.range_min, scan.range_max = 0.05, float(words[5])
            ranges = [float(word) for word in words[9:9 + beams]]
            scan.ranges = [r if r < scan.range_max else float("inf") for r in ranges]
            bag.write("/scan", scan, stamp)


if __name__ == "__main__":
    main()
