// SPDX-License-Identifier: BSD-3-Clause
// The few ROS messages that a map is made of, from their serialised form: ROS 1 (little-endian,
// fields in the order of the .msg files, arrays and strings with their length before them) or ROS 2
// (the same fields as CDR). Only what is used is kept. Every length is checked against the bytes
// that are there.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace masked_mapper {

struct RosHeader {
  double stamp = 0.0;    ///< s
  std::string frame_id;  ///< without a leading slash
};

/// sensor_msgs/LaserScan, or one echo per beam of sensor_msgs/MultiEchoLaserScan.
struct RosLaserScan {
  RosHeader header;
  double angle_min = 0.0;        ///< rad
  double angle_increment = 0.0;  ///< rad
  double time_increment = 0.0;   ///< s, between beams, as stated
  double range_min = 0.0;        ///< m
  double range_max = 0.0;        ///< m
  std::vector<float> ranges;     ///< m
};

/// nav_msgs/Odometry.
struct RosOdometry {
  RosHeader header;
  std::string child_frame_id;
  Eigen::Isometry3d T_frame_child = Eigen::Isometry3d::Identity();
};

/// One of a tf2_msgs/TFMessage.
struct RosTransform {
  RosHeader header;
  std::string child_frame_id;
  Eigen::Isometry3d T_frame_child = Eigen::Isometry3d::Identity();
};

/// sensor_msgs/Imu.
struct RosImu {
  RosHeader header;
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s^2, in the frame of the header
};

/// sensor_msgs/FluidPressure.
struct RosFluidPressure {
  RosHeader header;
  double pressure_pa = 0.0;
};

/// How messages are written: by ROS 1, or as CDR (OMG DDS-XTypes 1.3, 7.4; plain, version 1).
enum class MessageEncoding { kRos1, kCdr };

/// Which echo of a beam stands for it.
enum class EchoChoice { kFirst, kStrongest };

/// All are empty when the bytes are not such a message, or hold numbers that are none.
std::optional<RosLaserScan> ParseLaserScan(const unsigned char* data, std::size_t size,
                                           MessageEncoding encoding = MessageEncoding::kRos1);
std::optional<RosLaserScan> ParseMultiEchoLaserScan(
    const unsigned char* data, std::size_t size, EchoChoice choice,
    MessageEncoding encoding = MessageEncoding::kRos1);
std::optional<RosOdometry> ParseOdometry(const unsigned char* data, std::size_t size,
                                         MessageEncoding encoding = MessageEncoding::kRos1);
std::optional<std::vector<RosTransform>> ParseTransforms(
    const unsigned char* data, std::size_t size, MessageEncoding encoding = MessageEncoding::kRos1);
std::optional<RosImu> ParseImu(const unsigned char* data, std::size_t size,
                               MessageEncoding encoding = MessageEncoding::kRos1);
std::optional<RosFluidPressure> ParseFluidPressure(
    const unsigned char* data, std::size_t size, MessageEncoding encoding = MessageEncoding::kRos1);

/// The header that all of them but TFMessage begin with.
std::optional<RosHeader> ParseHeader(const unsigned char* data, std::size_t size,
                                     MessageEncoding encoding = MessageEncoding::kRos1);

}  // namespace masked_mapper
