// SPDX-License-Identifier: BSD-3-Clause
// One sweep of a 3D lidar: returns as measured.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

/// A return, in a frame that its holder names.
struct CloudPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< m
  float intensity = 0.0F;                              ///< as the sensor gives it
  float time = 0.0F;  ///< s after the stamp of the cloud, or before
};
using CloudPoints = std::vector<CloudPoint>;

/// One sweep, straightened and levelled.
struct LevelledCloud {
  double log_stamp = 0.0;  ///< s, as TrajectoryPose has it
  CloudPoints points;      ///< about the robot, whose heading is ahead; z above the floor below it
  std::optional<double> ceiling_m;                  ///< above that floor, where one is seen
  Eigen::Vector3d lidar = Eigen::Vector3d::Zero();  ///< m, where the rays come from, same frame
};

/// Moves every point of a frame b to a.
void Move(const Eigen::Isometry3d& T_a_b, CloudPoints* points);

/// Each point moved to where it would have been seen at the stamp of the cloud, in the robot frame
/// of then: `motion(t)` is T_robot(0)_robot(t), t in s after the stamp.
void Straighten(const std::function<Pose2(double)>& motion, CloudPoints* points_in_robot);

}  // namespace masked_mapper
