// SPDX-License-Identifier: BSD-3-Clause
// Dead reckoning: the path that the wheels tell, and how uncertain it has become since the last
// node.
#pragma once

#include <optional>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

/// Noise of wheel odometry as a random walk. The paper leaves its covariance open; these values
/// cover the robots of public logs, whose headings drift by 7 to 42 degrees over 50 m.
struct DeadReckoningOptions {
  double sigma_position_per_sqrt_m = 0.05;      ///< m of position error after one metre of travel
  double sigma_heading_deg_per_sqrt_m = 2.0;    ///< deg of heading error after one metre of travel
  double sigma_heading_deg_per_sqrt_rad = 3.0;  ///< deg of heading error after turning by a radian
  double sigma_heading_deg_per_sqrt_s = 0.03;  ///< deg of heading error after a second (gyro drift)
  double sigma_position_per_step = 0.002;      ///< m, of every step with motion: no edge is perfect

  /// For a checkpoint (mapping/state_archive.hpp): what was learnt of them on the way.
  template <class Archive>
  void Serialize(Archive& archive) {
    archive(sigma_position_per_sqrt_m, sigma_heading_deg_per_sqrt_m, sigma_heading_deg_per_sqrt_rad,
            sigma_heading_deg_per_sqrt_s, sigma_position_per_step);
  }
};

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

  /// The state, for a checkpoint (mapping/state_archive.hpp).
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
