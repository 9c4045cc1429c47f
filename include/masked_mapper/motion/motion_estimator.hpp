// SPDX-License-Identifier: BSD-3-Clause
// How the robot moved: by wheels, by scans, or by both; and how sure that is since the last node.
#pragma once

#include <memory>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "masked_mapper/sensor/state_archive.hpp"

namespace masked_mapper {

struct FacedPoints;

/// A scan straightened for a robot that goes on as in the step before it.
LaserScan StraightenedBySteps(LaserScan scan, const Pose2& T_before_now, double seconds);

class MotionEstimator {
 public:
  explicit MotionEstimator(const MotionOptions& options);
  ~MotionEstimator();
  MotionEstimator(MotionEstimator&&) noexcept;
  MotionEstimator& operator=(MotionEstimator&&) noexcept;

  /// Observations in order of stamps. The path moves at scans; readings between them gather.
  /// A scan that is still bent (`beam_time`) is straightened by the step before.
  /// `must_match`: the scene is about to be left, so that no correction may wait.
  /// `points`: of the scan as it is, where somebody has made them already; a bent one's are not
  /// asked for.
  /// A scan before which the wheels were silent moved as scans say: silence is no rest.
  void Observe(const OdometryReading& reading);
  void Observe(const LaserScan& scan, bool must_match = false, const FacedPoints* points = nullptr);
  /// A node was made at the scan observed last: motion and uncertainty are counted from now on.
  void StartNode();
  /// The robot is in a cab: only what is near stays the same when a door opens.
  void EnterTransit();
  /// It is said to be on a floor again: the next scan is aligned to none before it.
  void LeaveTransit();

  /// Pose at the scan observed last, along the path; frame `odom` is the robot's first pose.
  const Pose2& T_odom_robot() const;
  /// Motion to the scan observed last since the one before, with covariance in that one's frame.
  const UncertainPose2& last_step() const;
  /// Motion since the last node, with covariance in the node's frame.
  const UncertainPose2& T_node_robot() const;

  /// The state, for a checkpoint.
  void Serialize(StateWriter& archive);
  void Serialize(StateReader& archive);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace masked_mapper
