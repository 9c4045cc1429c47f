// SPDX-License-Identifier: BSD-3-Clause
// Dead reckoning: the path that the wheels tell, and how uncertain it has become since the last
// node.
#pragma once

#include <optional>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// Motion between two odometry readings, with its covariance in the frame of the first.
UncertainPose2 OdometryStep(const OdometryReading& from, const OdometryReading& to,
                            const DeadReckoningOptions& options);

class DeadReckoning {
 public:
  explicit DeadReckoning(const DeadReckoningOptions& options) : options_(options) {}

  /// Readings in order of stamps. The first defines the origin: the path starts at the identity.
  void Observe(const OdometryReading& reading);
  /// How uncertain steps are from now on.
  void SetOptions(const DeadReckoningOptions& options) { options_ = options; }
  /// A node was made here: motion and uncertainty are counted from now on.
  void StartNode();

  /// Pose along the path; frame `odom` is the robot's first pose.
  const Pose2& T_odom_robot() const { return T_odom_robot_; }
  /// Motion since the last node (or the start), with covariance in the node's frame.
  const UncertainPose2& T_node_robot() const { return T_node_robot_; }
  bool HasStarted() const { return last_.has_value(); }

  /// The state, for a checkpoint (sensor/state_archive.hpp).
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(last_, T_odom_robot_, T_node_robot_, options_);
  }

 private:
  DeadReckoningOptions options_;
  std::optional<OdometryReading> last_;
  Pose2 T_odom_robot_;
  UncertainPose2 T_node_robot_;
};

}  // namespace masked_mapper
