// SPDX-License-Identifier: BSD-3-Clause
// sensor_msgs/PointCloud2 from its serialised form: numbers of any type at any place of a point, as
// the message itself lays them out. Every offset and stride is held against the bytes that are
// there before one point is read.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "masked_mapper/sensor/lidar_cloud.hpp"
#include "ros_messages.hpp"

namespace masked_mapper {

/// x, y and z may be of any type and anywhere, the cloud organised or not. A point that is no
/// number, or lies at the origin, is no return and is left out.
struct RosPointCloud {
  RosHeader header;
  CloudPoints points;  ///< in the frame of the header
  /// Whether the points tell their times: `t`, `time`, `timestamp` and the like, in whatever unit
  /// makes a sweep last milliseconds, after the stamp of the header or by its clock.
  bool has_times = false;
};

/// Empty when the bytes are no such message.
std::optional<RosPointCloud> ParsePointCloud(const unsigned char* data, std::size_t size,
                                             MessageEncoding encoding = MessageEncoding::kRos1);
/// What is wrong with bytes of which ParsePointCloud makes nothing.
std::string FaultOfPointCloud(const unsigned char* data, std::size_t size,
                              MessageEncoding encoding = MessageEncoding::kRos1);

}  // namespace masked_mapper
