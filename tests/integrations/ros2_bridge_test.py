# SPDX-License-Identifier: BSD-3-Clause
"""The ROS 2 bridge against a stand-in of rclpy and the messages, and of the program: what it writes is
read by the real one (`info`), what it publishes is checked against the answers it was given.

    ros2_bridge_test.py PROGRAM
"""
import importlib.util
import json
import math
import os
import stat
import subprocess
import sys
import tempfile
import types

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
FAKE_PROGRAM = """#!/usr/bin/env python3
import json, sys
log = open(sys.argv[sys.argv.index('-o') + 1] + '.log', 'w')
scans = 0
for line in sys.stdin:
    log.write(line)
    if not line.startswith('ROBOTLASER1'):
        continue
    scans += 1
    sure = scans > 2
    floor = ('ground' if scans < 5 else 'first') if sure else None
    print(json.dumps({'t': float(line.split()[-3]), 'floor': floor, 'x': 5.0 if sure else None,
                      'y': 1.0 if sure else None, 'theta': 1.0 if sure else None, 'sure': sure}),
          flush=True)
"""


def bag(**values):
    return types.SimpleNamespace(**values)


def module(name, **members):
    made = types.ModuleType(name)
    made.__dict__.update(members)
    sys.modules[name] = made


class Message:
    def __init__(self, **values):
        self.__dict__.update(values)


class Transform:
    def __init__(self):
        self.header = bag(stamp=None, frame_id="")
        self.child_frame_id = ""
        self.transform = bag(translation=bag(x=0.0, y=0.0, z=0.0),
                             rotation=bag(x=0.0, y=0.0, z=0.0, w=1.0))


class LoadMap:
    Request = Message


class StandInNode:
    parameters = {}

    def __init__(self, name):
        self.subscribed, self.published, self.called = {}, [], []

    def declare_parameter(self, name, value):
        return bag(value=self.parameters.get(name, value))

    def create_publisher(self, kind, topic, qos):
        return bag(publish=lambda message: self.published.append((topic, message)))

    def create_client(self, kind, service):
        return bag(call_async=lambda request: self.called.append((service, request.map_url)))

    def create_subscription(self, kind, topic, callback, qos):
        self.subscribed[topic] = callback

    def get_logger(self):
        return bag(error=lambda text: sys.exit("the bridge said: " + text))


class Broadcaster:
    sent = []

    def __init__(self, node):
        pass

    def sendTransform(self, transform):
        self.sent.append(transform)


def stand_in():
    module("rclpy", init=lambda: None, spin=lambda node: None, shutdown=lambda: None)
    module("rclpy.node", Node=StandInNode)
    module("rclpy.qos", QoSProfile=Message, qos_profile_sensor_data=None,
           DurabilityPolicy=bag(TRANSIENT_LOCAL=1))
    for package in ("geometry_msgs", "nav_msgs", "nav2_msgs", "sensor_msgs", "std_msgs"):
        module(package)
    module("geometry_msgs.msg", TransformStamped=Transform)
    module("nav_msgs.msg", Odometry=Message)
    module("nav2_msgs.srv", LoadMap=LoadMap)
    module("sensor_msgs.msg", FluidPressure=Message, Imu=Message, LaserScan=Message)
    module("std_msgs.msg", String=Message)
    module("tf2_ros", TransformBroadcaster=Broadcaster)


def header(t, frame="odom"):
    return bag(stamp=bag(sec=int(t), nanosec=int(round((t - int(t)) * 1e9))), frame_id=frame)


def drive(node):
    """Six scans on a circle; wheels, pressure and acceleration between them."""
    for i in range(6):
        t = 1700000000.0 + 0.25 * i
        heading = 0.1 * i
        node.subscribed["odom"](bag(header=header(t), pose=bag(pose=bag(
            position=bag(x=0.2 * i, y=0.1 * i),
            orientation=bag(x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))))))
        node.subscribed["pressure"](bag(header=header(t), fluid_pressure=101325.0 - i))
        node.subscribed["imu"](bag(header=header(t), linear_acceleration=bag(x=0.1, y=0.0, z=9.81)))
        ranges = [2.0 + 0.01 * k for k in range(181)]
        ranges[7], ranges[9] = math.inf, math.nan
        node.subscribed["scan"](bag(header=header(t, "laser"), angle_min=-math.pi / 2,
                                    angle_increment=math.pi / 180, range_max=30.0, ranges=ranges))


def main():
    program = sys.argv[1]
    stand_in()
    spec = importlib.util.spec_from_file_location(
        "localize_bridge", os.path.join(ROOT, "integrations", "ros2", "localize_bridge.py"))
    bridge = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(bridge)
    with tempfile.TemporaryDirectory() as folder:
        fake = os.path.join(folder, "fake")
        with open(fake, "w") as file:
            file.write(FAKE_PROGRAM)
        os.chmod(fake, os.stat(fake).st_mode | stat.S_IXUSR)
        StandInNode.parameters = {"program": fake, "output": os.path.join(folder, "drive"),
                                  "map": folder, "laser_x": 0.2}
        node = bridge.LocalizeBridge()
        drive(node)
        node.close()
        said = [message.data for topic, message in node.published if topic == "floor"]
        assert said == ["?", "ground", "first"], said
        asked = [os.path.basename(url) for _, url in node.called]
        assert asked == ["ground.yaml", "first.yaml"], asked
        assert len(Broadcaster.sent) == 4, len(Broadcaster.sent)
        for i, sent in enumerate(Broadcaster.sent, start=2):
            q = sent.transform.rotation
            T_map_odom = (sent.transform.translation.x, sent.transform.translation.y,
                          2.0 * math.atan2(q.z, q.w))
            there = bridge.compose(T_map_odom, (0.2 * i, 0.1 * i, 0.1 * i))
            assert max(abs(a - b) for a, b in zip(there, (5.0, 1.0, 1.0))) < 1e-6, there
            assert (sent.header.frame_id, sent.child_frame_id) == ("map", "odom")
        info = json.loads(subprocess.run([program, "info", os.path.join(folder, "drive.log"), "--json"],
                                         check=True, capture_output=True, text=True).stdout)
        counts = {kind: info["counts"][kind] for kind in
                  ("scans", "odometry", "pressure", "acceleration", "bad_lines")}
        assert counts == {"scans": 6, "odometry": 6, "pressure": 6, "acceleration": 6,
                          "bad_lines": 0}, counts
        assert abs(info["T_robot_laser"]["x_m"] - 0.2) < 1e-3, info["T_robot_laser"]
    print("the bridge says what it was answered")


if __name__ == "__main__":
    main()
