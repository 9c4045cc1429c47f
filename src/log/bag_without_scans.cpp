// SPDX-License-Identifier: BSD-3-Clause
#include "bag_without_scans.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace masked_mapper {
namespace {

constexpr std::size_t kMostListed = 64;

struct Remedy {
  const char* type;  ///< its end
  const char* text;
};
constexpr Remedy kRemedies[] = {
    {"velodyne_msgs/VelodyneScan",
     "packets of a Velodyne, which its driver unpacks: `roslaunch velodyne_pointcloud "
     "VLP16_points.launch` while the bag is played"},
    {"velodyne_msgs/msg/VelodyneScan",
     "packets of a Velodyne, which its driver unpacks: `ros2 launch velodyne_pointcloud "
     "velodyne_transform_node-VLP16-launch.py` while the bag is played"},
    {"ouster_ros/PacketMsg",
     "packets of an Ouster, which its driver unpacks: `roslaunch ouster_ros replay.launch "
     "bag_file:=...`"},
    {"/msg/PacketMsg",
     "packets of an Ouster, which its driver unpacks: `ros2 launch ouster_ros replay.launch.xml "
     "bag_file:=...`"},
};

bool HasEnding(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// "json" of "sensor_msgs/LaserScan as json".
std::string OtherEncoding(const std::string& type) {
  const std::size_t as = type.rfind(" as ");
  return as == std::string::npos ? "" : type.substr(as + 4);
}

std::string RemedyFor(const std::map<std::uint32_t, BagConnection>& connections) {
  std::set<std::string> encodings;
  for (const auto& [id, connection] : connections) {
    for (const Remedy& remedy : kRemedies) {
      if (HasEnding(connection.type, remedy.type)) {
        return "; on " + connection.topic + " are " + remedy.text;
      }
    }
    encodings.insert(OtherEncoding(connection.type));
  }
  if (encodings.empty() || encodings.count("") > 0) return "";
  std::string list;
  for (const std::string& encoding : encodings) list += (list.empty() ? "" : ", ") + encoding;
  return "; its messages are serialised as " + list +
         ", where cdr or ros1 is read: publish them in ROS and record with `ros2 bag record`";
}

}  // namespace

std::string DamageOf(const RosBag& bag) {
  std::string text;
  if (bag.Truncated()) text += "; the file is cut off in the middle";
  if (bag.Damaged() > 0) {
    text += "; " + std::to_string(bag.Damaged()) + " damaged, the first: " + bag.FirstDamage();
  }
  return text;
}

std::string WhatIsThereInsteadOfScans(RosBag* bag) {
  std::map<std::uint32_t, std::uint64_t> counts;
  while (const std::optional<BagMessage> message = bag->Next()) ++counts[message->connection];
  std::map<std::pair<std::string, std::string>, std::uint64_t> topics;
  for (const auto& [id, connection] : bag->Connections()) {
    topics[{connection.topic, connection.type}] += counts[id];
  }
  std::string list;
  std::size_t listed = 0;
  for (const auto& [topic, count] : topics) {
    if (listed++ == kMostListed) break;
    list += (list.empty() ? "" : ", ") + std::to_string(count) + " on " + topic.first + " (" +
            topic.second + ")";
  }
  if (topics.size() > kMostListed) {
    list += ", and " + std::to_string(topics.size() - kMostListed) + " more topics";
  }
  return "holds no sensor_msgs/LaserScan and no PointCloud2 (topics: " +
         (list.empty() ? "none" : list) + ")" + RemedyFor(bag->Connections()) + DamageOf(*bag);
}

}  // namespace masked_mapper
