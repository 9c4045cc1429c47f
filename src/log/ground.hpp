// SPDX-License-Identifier: BSD-3-Clause
// Which way is up on the robot, how high it stands, and how high the ceiling is, from a 3D lidar's
// clouds: a floor is a plane with hardly anything below it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "masked_mapper/sensor/lidar_cloud.hpp"

namespace masked_mapper {

struct Ground {
  Eigen::Vector3d up_in_robot = Eigen::Vector3d::UnitZ();
  double floor_m = 0.0;             ///< along up, where it passes under the robot's origin
  std::optional<double> ceiling_m;  ///< along up, the lowest large one above the lidar
  bool is_seen = false;             ///< false: no floor in the cloud; as it was, or as is usual

  /// Robot frame to a level one: same origin and heading, z above the floor.
  Eigen::Isometry3d T_level_robot() const;
};

/// One robot's, from cloud to cloud: the last ground is where the next is looked for.
class GroundFinder {
 public:
  /// `lidar_in_robot`: where the rays come from; a floor lies below it. `gravity_up`: up in the
  /// robot frame as an accelerometer tells it. A floor that leans from it is a ramp: then gravity
  /// is up.
  Ground Find(const CloudPoints& points_in_robot, const Eigen::Vector3d& lidar_in_robot,
              const std::optional<Eigen::Vector3d>& gravity_up);

 private:
  std::optional<Ground> last_;
};

}  // namespace masked_mapper
