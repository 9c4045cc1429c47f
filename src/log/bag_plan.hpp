// SPDX-License-Identifier: BSD-3-Clause
// What of a bag is read: which topics as what, where their sensors sit, whose clock stamps them.
// Topics are chosen by type and options (bag_plan.cpp); the rest is found by a look at the bag
// (bag_look.hpp), and again by all of it (bag_evidence.hpp).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "clock_evidence.hpp"
#include "frame_tree.hpp"
#include "masked_mapper/log/log_reader.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "ros_bag.hpp"
#include "ros_point_cloud.hpp"
#include "ros_types.hpp"
#include "scanner_evidence.hpp"

namespace masked_mapper {

/// A topic that is read; its place among `BagPlan::topics` is its stream.
struct BagTopic {
  std::string name;
  TopicKind kind = TopicKind::kScan;
  std::size_t scanner = 0;
  std::string frame;  ///< of several scanners that share the topic, the one that is read
};

struct BagPlan {
  std::vector<BagTopic> topics;  ///< those of the scanners first, in their order
  std::size_t scanners = 0;
  bool has_odometry_topic = false;
  std::vector<PlanarMount> mounts;               ///< of the scanners
  std::vector<Eigen::Isometry3d> T_robot_lidar;  ///< of the scanners, those of clouds
  std::string odometry_frame;                    ///< of tf, when there is no Odometry; empty: none
  std::string robot_frame;
  Eigen::Matrix3d R_robot_imu = Eigen::Matrix3d::Identity();
  std::vector<TopicClock> clocks;     ///< of the topics
  double clock_offset = 0.0;          ///< s, header minus recording, of the first scanner
  std::vector<ScannerRanges> ranges;  ///< of the scanners
  bool is_disordered = false;         ///< messages do not stand in the order of their recording
  double max_range = 0.0;             ///< m
  float no_return = 0.0F;             ///< m; 0: each scan's own range_max

  /// s, by the clock that stamps the log, of a message of a stream that was recorded at `time`.
  double StampOf(std::size_t stream, double time, double header) const;
  OdometryReading ReadingOf(std::size_t stream, double time, const RosOdometry& odometry) const;
  /// Empty when it is not the robot's odometry.
  std::optional<OdometryReading> ReadingOf(std::size_t stream, double time,
                                           const RosTransform& transform) const;
  AccelerationReading ReadingOf(std::size_t stream, double time, const RosImu& imu) const;
};

/// Which topics to read, by their types and the user's options; none when there is no scanner among
/// them. Throws InputError, `path` in front: several topics of which one is to be chosen, a topic
/// that is not there or named twice.
BagPlan ChooseTopics(const std::string& path,
                     const std::map<std::uint32_t, BagConnection>& connections,
                     const LogOptions& options);

/// The streams of a bag's connections, so that messages need no names compared. Both the plan and
/// the bag must outlive it.
class BagStreams {
 public:
  BagStreams(const BagPlan& plan, const RosBag& bag) : plan_(plan), bag_(bag) {}

  /// Empty when the connection's messages are not read.
  std::optional<std::size_t> Find(std::uint32_t connection);
  /// Whether they are clouds that are read.
  bool IsCloud(std::uint32_t connection);

 private:
  const BagPlan& plan_;
  const RosBag& bag_;
  std::map<std::uint32_t, std::optional<std::size_t>> streams_;
};

/// Whether a bag gives other observations by one plan than by the other. What the limits of ranges
/// are was settled by the beginning, and is no matter.
bool ReadsOtherwise(const BagPlan& one, const BagPlan& other);

using RosMessage = std::variant<RosLaserScan, RosPointCloud, RosOdometry, std::vector<RosTransform>,
                                RosImu, RosFluidPressure>;

/// Empty when the message is malformed. A cloud that was parsed already is taken.
std::optional<RosMessage> ParseMessage(TopicKind kind, const BagMessage& message,
                                       const LogOptions& options);
/// What is wrong with a message of which ParseMessage made nothing.
std::string FaultOf(TopicKind kind, const BagMessage& message);

/// Whether a scan's range_max says anything.
bool IsRangeLimit(double range_max);

}  // namespace masked_mapper
