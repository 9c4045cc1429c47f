#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a small bag with Debian's own rosbag: a robot drives a circle in a box of 10 x 6 m.

usage: write_bag.py OUT.bag [none|bz2|lz4] [full|two|two_odometries|tf|multi_echo|no_scan]
"""
import math
import sys

import genpy
import rosbag
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import FluidPressure, Imu, LaserEcho, LaserScan, MultiEchoLaserScan
from tf2_msgs.msg import TFMessage

HALF_X, HALF_Y = 5.0, 3.0
BEGIN = 1600000000.0


def pose(t):
    """T_world_robot on a circle of 1 m, 0.1 m/s."""
    angle = 0.1 * t
    return math.sin(angle), 1.0 - math.cos(angle), angle


def box_range(x, y, angle):
    c, s = math.cos(angle), math.sin(angle)
    along_x = ((HALF_X if c > 0 else -HALF_X) - x) / c if abs(c) > 1e-12 else 1e9
    along_y = ((HALF_Y if s > 0 else -HALF_Y) - y) / s if abs(s) > 1e-12 else 1e9
    return min(along_x, along_y)


def scan(t, frame, mount, first, step, beams, upside_down=False):
    x, y, theta = pose(t)
    mx, my, mtheta = mount
    lx = x + math.cos(theta) * mx - math.sin(theta) * my
    ly = y + math.sin(theta) * mx + math.cos(theta) * my
    message = LaserScan()
    message.header.stamp = genpy.Time.from_sec(BEGIN + t)
    message.header.frame_id = frame
    message.angle_min, message.angle_increment = first, step
    message.angle_max = first + step * (beams - 1)
    message.range_min, message.range_max = 0.1, 30.0
    sense = -1.0 if upside_down else 1.0
    message.ranges = [
        box_range(lx, ly, theta + mtheta + sense * (first + i * step)) for i in range(beams)
    ]
    message.ranges[0] = float("inf")
    message.ranges[1] = float("nan")
    return message


def transform(parent, child, x, y, yaw, t=0.0, roll_pi=False):
    message = TransformStamped()
    message.header.stamp = genpy.Time.from_sec(BEGIN + t)
    message.header.frame_id, message.child_frame_id = parent, child
    message.transform.translation.x, message.transform.translation.y = x, y
    rotation = message.transform.rotation
    if roll_pi:  # Rz(yaw) Rx(pi)
        rotation.x, rotation.y = math.cos(yaw / 2), math.sin(yaw / 2)
    else:
        rotation.z, rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return message


def odometry(t):
    x, y, theta = pose(t)
    message = Odometry()
    message.header.stamp = genpy.Time.from_sec(BEGIN + t)
    message.header.frame_id, message.child_frame_id = "odom", "base_link"
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation.z = math.sin(theta / 2)
    message.pose.pose.orientation.w = math.cos(theta / 2)
    return message


def multi_echo(single):
    message = MultiEchoLaserScan()
    for field in ("header", "angle_min", "angle_max", "angle_increment", "range_min", "range_max"):
        setattr(message, field, getattr(single, field))
    message.ranges = [LaserEcho([r, r + 1.0]) if r == r else LaserEcho([]) for r in single.ranges]
    message.intensities = [
        LaserEcho([1.0, 2.0]) if r == r else LaserEcho([]) for r in single.ranges
    ]
    return message


def main():
    out = sys.argv[1]
    compression = sys.argv[2] if len(sys.argv) > 2 else "none"
    mode = sys.argv[3] if len(sys.argv) > 3 else "full"
    degree = math.radians(1.0)
    with rosbag.Bag(out, "w", compression=compression, chunk_threshold=40000) as bag:

        def write(topic, message, t):
            bag.write(topic, message, genpy.Time.from_sec(BEGIN + t))

        write(
            "/tf_static",
            TFMessage([
                transform("base_link", "front", 0.3, 0.1, 0.2),
                transform("base_link", "rear", -0.4, 0.0, math.pi, roll_pi=True),
                transform("base_link", "imu", 0.0, 0.0, math.pi / 2),
            ]), 0.0)
        for i in range(200):
            t = 0.05 * i
            if mode == "tf":
                write("/tf", TFMessage([transform("odom", "base_link", *pose(t), t=t)]), t)
            else:
                write("/odom", odometry(t), t)
            if mode == "two_odometries":
                write("/odom/filtered", odometry(t), t)
            if i % 4 == 0:
                pressure = FluidPressure(fluid_pressure=101325.0 - i)
                pressure.header.stamp = genpy.Time.from_sec(BEGIN + t)
                write("/pressure", pressure, t)
                imu = Imu()
                imu.header.stamp = genpy.Time.from_sec(BEGIN + t)
                imu.header.frame_id = "imu"
                imu.linear_acceleration.x, imu.linear_acceleration.z = 1.0, 9.81
                write("/imu", imu, t)
            if i % 2 or mode == "no_scan":
                continue
            t += 0.01  # between two messages of odometry
            if mode == "two":
                front = scan(t, "front", (0.3, 0.1, 0.2), -math.pi / 2, degree, 181)
                rear = scan(t + 0.005, "rear", (-0.4, 0.0, math.pi), -math.pi / 2, degree, 181, True)
                write("/front", front, t)
                write("/rear", rear, t + 0.005)
            elif mode == "multi_echo":
                write("/scan", multi_echo(scan(t, "front", (0.3, 0.1, 0.2), -math.pi, degree, 360)), t)
            else:
                write("/scan", scan(t, "front", (0.3, 0.1, 0.2), -math.pi, degree, 360), t + 0.03)


if __name__ == "__main__":
    main()
