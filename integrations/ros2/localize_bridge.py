#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A ROS 2 node that says where a robot is in a map that `masked_mapper map` made, floor included.

    python3 localize_bridge.py --ros-args -p map:=OUT -p output:=DRIVE

Subscribes `scan`, `odom`, `imu` and `pressure`, hands them to `masked_mapper localize - --poses`, and
publishes the transform from `map` to the frame of the odometry while the place is sure, the floor's
name on `floor` (latched; `?`: not sure), and asks `map_server/load_map` for the floor's map when it
changes. Where the robot is not sure nothing is published: navigation sees a transform that grows old.

The scanner's mount on the robot is given by the parameters laser_x, laser_y (m), laser_theta (rad).
Tested against a stand-in of the interfaces (tests/integrations), not on a robot.
"""
import collections
import json
import math
import os
import subprocess
import threading

import rclpy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from nav2_msgs.srv import LoadMap
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import FluidPressure, Imu, LaserScan
from std_msgs.msg import String
from tf2_ros import TransformBroadcaster

KEPT_SCANS = 1000  # that wait for their answer


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


def yaw(q):
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def compose(a, b):
    """T_a_c of T_a_b and T_b_c, each (x, y, theta)."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])


def inverse(a):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (-c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2])


def carmen(words, stamp):
    return " ".join(words) + " %.6f ros %.6f\n" % (stamp, stamp)


def scan_line(scan, T_odom_robot, T_robot_laser):
    """ROBOTLASER1; what did not return is written as the scanner's longest range."""
    ranges = ["%.3f" % (r if math.isfinite(r) and r < scan.range_max else scan.range_max)
              for r in scan.ranges]
    step = scan.angle_increment
    words = ["ROBOTLASER1", "0", "%.9f" % scan.angle_min, "%.9f" % (step * (len(ranges) - 1)),
             "%.12f" % step, "%.3f" % scan.range_max, "0.01", "0", str(len(ranges))]
    words += ranges + ["0"]
    for pose in (compose(T_odom_robot, T_robot_laser), T_odom_robot):
        words += ["%.6f" % value for value in pose]
    return carmen(words + ["0", "0", "0", "0", "0"], seconds(scan.header.stamp))


class LocalizeBridge(Node):
    def __init__(self):
        super().__init__("masked_mapper_localize")
        parameter = lambda name, value: self.declare_parameter(name, value).value
        self.map_folder = parameter("map", "out")
        self.map_frame = parameter("map_frame", "map")
        self.T_robot_laser = tuple(parameter(n, 0.0) for n in ("laser_x", "laser_y", "laser_theta"))
        self.T_odom_robot = None
        self.odom_frame = "odom"
        self.floor = None
        self.poses_of_scans = collections.OrderedDict()
        self.lock = threading.Lock()
        self.program = subprocess.Popen(
            [parameter("program", "masked_mapper"), "localize", "-", "--in", self.map_folder,
             "-o", parameter("output", "drive"), "--poses", "--quiet"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
        self.tf = TransformBroadcaster(self)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.floor_publisher = self.create_publisher(String, "floor", latched)
        self.load_map = self.create_client(LoadMap, "map_server/load_map")
        self.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)
        self.create_subscription(Odometry, "odom", self.on_odometry, 50)
        self.create_subscription(Imu, "imu", self.on_imu, qos_profile_sensor_data)
        self.create_subscription(FluidPressure, "pressure", self.on_pressure, 10)
        self.reader = threading.Thread(target=self.read_answers, daemon=True)
        self.reader.start()

    def tell(self, line):
        try:
            self.program.stdin.write(line)
            self.program.stdin.flush()
        except (BrokenPipeError, ValueError):
            self.get_logger().error("masked_mapper has ended; see what it said")
            rclpy.shutdown()

    def on_odometry(self, message):
        pose = message.pose.pose
        self.odom_frame = message.header.frame_id or self.odom_frame
        self.T_odom_robot = (pose.position.x, pose.position.y, yaw(pose.orientation))
        words = ["ODOM"] + ["%.6f" % value for value in self.T_odom_robot] + ["0", "0", "0"]
        self.tell(carmen(words, seconds(message.header.stamp)))

    def on_scan(self, scan):
        if self.T_odom_robot is None:
            return
        stamp = seconds(scan.header.stamp)
        with self.lock:
            self.poses_of_scans["%.6f" % stamp] = (self.T_odom_robot, scan.header.stamp)
            while len(self.poses_of_scans) > KEPT_SCANS:
                self.poses_of_scans.popitem(last=False)
        self.tell(scan_line(scan, self.T_odom_robot, self.T_robot_laser))

    def on_imu(self, message):
        a = message.linear_acceleration
        self.tell(carmen(["ACCEL", "%.6f" % a.x, "%.6f" % a.y, "%.6f" % a.z],
                         seconds(message.header.stamp)))

    def on_pressure(self, message):
        self.tell(carmen(["PRESSURE", "%.3f" % message.fluid_pressure],
                         seconds(message.header.stamp)))

    def read_answers(self):
        for line in self.program.stdout:
            self.on_answer(json.loads(line))

    def on_answer(self, answer):
        with self.lock:
            known = self.poses_of_scans.pop("%.6f" % answer["t"], None)
        self.tell_floor(answer["floor"] if answer["sure"] else "?")
        if not answer["sure"] or known is None:
            return
        T_odom_robot, stamp = known
        T_map_robot = (answer["x"], answer["y"], answer["theta"])
        x, y, theta = compose(T_map_robot, inverse(T_odom_robot))
        transform = TransformStamped()
        transform.header.stamp = stamp
        transform.header.frame_id = self.map_frame
        transform.child_frame_id = self.odom_frame
        transform.transform.translation.x = x
        transform.transform.translation.y = y
        transform.transform.rotation.z = math.sin(0.5 * theta)
        transform.transform.rotation.w = math.cos(0.5 * theta)
        self.tf.sendTransform(transform)

    def tell_floor(self, floor):
        if floor == self.floor:
            return
        self.floor = floor
        self.floor_publisher.publish(String(data=floor))
        if floor == "?":
            return
        request = LoadMap.Request()
        request.map_url = os.path.join(os.path.abspath(self.map_folder), "floors", floor + ".yaml")
        self.load_map.call_async(request)

    def close(self):
        self.program.stdin.close()
        self.program.wait()
        self.reader.join()


def main():
    rclpy.init()
    node = LocalizeBridge()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.close()


if __name__ == "__main__":
    main()
