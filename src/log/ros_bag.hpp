// SPDX-License-Identifier: BSD-3-Clause
// A recording of ROS messages of whatever version, read forward.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "ros_messages.hpp"
#include "ros_point_cloud.hpp"

namespace masked_mapper {

struct BagConnection {
  std::string topic;
  std::string type;    ///< "sensor_msgs/LaserScan", or of ROS 2 "sensor_msgs/msg/LaserScan"
  std::string md5sum;  ///< of the message's definition; ROS 2 has none
};

struct BagMessage {
  std::uint32_t connection = 0;
  double time = 0.0;                    ///< s, when it was recorded
  const unsigned char* data = nullptr;  ///< serialised; valid until the next call
  std::size_t size = 0;
  MessageEncoding encoding = MessageEncoding::kRos1;
  /// Of one that was parsed already: what it says, in place of its data.
  std::shared_ptr<RosPointCloud> cloud = nullptr;
};

class RosBag {
 public:
  virtual ~RosBag() = default;

  /// The next message in the order of recording; its connection is known. Empty at the end.
  virtual std::optional<BagMessage> Next() = 0;
  /// Back to the first message. What is known of connections stays.
  virtual void Rewind() = 0;

  /// By id. Complete from the start when the bag is indexed, else as far as it was read.
  virtual const std::map<std::uint32_t, BagConnection>& Connections() const = 0;
  /// Whether the bag lists its connections: of ROS 1, it was closed properly.
  virtual bool IsIndexed() const = 0;
  /// s, of recording, of the last message, where the bag tells it without being read.
  virtual std::optional<double> EndTime() const { return std::nullopt; }
  /// The recording was not closed properly, or the file ends before its records do.
  virtual bool Truncated() const = 0;
  /// Records and chunks skipped because they make no sense.
  virtual std::uint64_t Damaged() const = 0;
  /// The first of them in words.
  virtual std::string FirstDamage() const { return "a chunk or record of the bag is damaged"; }
  /// Share of the file consumed, 0 to 1.
  virtual double Progress() const = 0;
};

}  // namespace masked_mapper
