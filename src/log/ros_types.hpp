// SPDX-License-Identifier: BSD-3-Clause
// The types of ROS messages that a map is made of: what they are called, and how they are defined.
#pragma once

#include <optional>
#include <string>

#include "ros_bag.hpp"

namespace masked_mapper {

enum class TopicKind { kScan, kMultiEcho, kCloud, kOdometry, kTransforms, kImu, kPressure };

struct RosType {
  const char* package;
  const char* name;
  const char* md5sum;  ///< of ROS 1
  TopicKind kind;

  /// "sensor_msgs/LaserScan".
  std::string Ros1Name() const { return std::string(package) + "/" + name; }
  /// "sensor_msgs/msg/LaserScan".
  std::string Ros2Name() const { return std::string(package) + "/msg/" + name; }
};

/// Empty: of a type that is not read.
std::optional<TopicKind> KindOf(const BagConnection& connection);

/// The first type of a kind.
const RosType& TypeOfKind(TopicKind kind);

/// The definition of a type and of all types in it, as bags carry it.
std::string DefinitionOf(const RosType& type, MessageEncoding encoding);

}  // namespace masked_mapper
