// SPDX-License-Identifier: BSD-3-Clause
// What a spinning lidar sees of a room made of boxes.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/sensor/lidar_cloud.hpp"

namespace masked_mapper {

inline Eigen::Isometry3d Tilted(double roll_deg, double pitch_deg, double height) {
  Eigen::Isometry3d T(Eigen::AngleAxisd(DegToRad(pitch_deg), Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(DegToRad(roll_deg), Eigen::Vector3d::UnitX()));
  T.translation().z() = height;
  return T;
}

/// 12 m by 8 m about the lidar, 2.7 m high, with whatever boxes stand in it.
struct RoomCloud {
  Eigen::Isometry3d T_world_lidar = Tilted(0.0, 0.0, 0.6);
  Eigen::AlignedBox3d room{Eigen::Vector3d(-6.0, -4.0, 0.0), Eigen::Vector3d(6.0, 4.0, 2.7)};
  std::vector<Eigen::AlignedBox3d> boxes;
  int rings = 16;
  int columns = 900;
  double lowest_deg = -15.0;
  double highest_deg = 15.0;

  /// In the lidar's frame.
  CloudPoints Seen() const {
    CloudPoints points;
    for (int column = 0; column < columns; ++column) {
      for (int ring = 0; ring < rings; ++ring) {
        const double up = DegToRad(lowest_deg + (highest_deg - lowest_deg) * ring / (rings - 1));
        const double turn = 2.0 * kPi * column / columns;
        const Eigen::Vector3d ray(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn),
                                  std::sin(up));
        CloudPoint point;
        point.position = (Range(ray) * ray).cast<float>();
        points.push_back(point);
      }
    }
    return points;
  }

 private:
  double Range(const Eigen::Vector3d& ray_in_lidar) const {
    const Eigen::Vector3d origin = T_world_lidar.translation();
    const Eigen::Vector3d ray = T_world_lidar.linear() * ray_in_lidar;
    double range = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double wall = ray(axis) > 0.0 ? room.max()(axis) : room.min()(axis);
      if (ray(axis) != 0.0) range = std::min(range, (wall - origin(axis)) / ray(axis));
    }
    for (const Eigen::AlignedBox3d& box : boxes) {
      double enter = 0.0;
      double leave = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min()(axis) - origin(axis)) / ray(axis);
        const double b = (box.max()(axis) - origin(axis)) / ray(axis);
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      if (enter < leave) range = std::min(range, enter);
    }
    return range;
  }
};

}  // namespace masked_mapper
