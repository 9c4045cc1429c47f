#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints what Debian's own rosbag finds in a bag: one line per topic, then the first scan.

usage: read_bag.py IN.bag
"""
import sys

import rosbag


def main():
    with rosbag.Bag(sys.argv[1]) as bag:
        info = bag.get_type_and_topic_info()
        for topic in sorted(info.topics):
            of_topic = info.topics[topic]
            print(topic, of_topic.msg_type, of_topic.message_count)
            assert bag.get_message_count(topic) == of_topic.message_count
        read = 0
        first = None
        # With the definition that stands in the bag, whose sum rosbag holds against the stated one.
        for topic, message, _ in bag.read_messages():
            read += 1
            if topic == "/scan" and first is None:
                first = message
        assert read == bag.get_message_count()
        print(f"{first.header.stamp.to_sec():.6f} {first.header.frame_id} {len(first.ranges)} "
              f"{first.angle_min:.6f} {first.angle_max:.6f} {first.range_max:.3f} "
              f"{first.ranges[0]:.3f} {first.ranges[1]:.3f}")


if __name__ == "__main__":
    main()
