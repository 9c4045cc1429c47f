// SPDX-License-Identifier: BSD-3-Clause
// A drive mapped right, and the same with a wall that came between its visits.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping/ring_logs.hpp"

namespace masked_mapper {

/// Twice and more round a ring of corridors, mapped right.
inline BuildingMap RightMap() {
  static const BuildingMap map = MapOf(First(), "doubt.log");
  return map;
}

/// A right map, but that on the first visit screens stood across the way of a later one.
struct MapWithScreens {
  BuildingMap map = RightMap();
  std::size_t last_seen = 0;  ///< kept scan that may see a screen
  std::size_t crossed = 0;    ///< kept scan where the first screen stood
  Pose2 T_world_screen;       ///< of that one

  explicit MapWithScreens(std::size_t count = 1) {
    crossed = map.kept_scans.size() - 1;
    while (!WasPassed(crossed) || !WasPassed(crossed - 90)) --crossed;
    crossed -= 50;
    T_world_screen = PoseOf(crossed);
    for (std::size_t i = 0; i < count; ++i) PutScreenAt(PoseOf(crossed + 40 * i));
  }

  double StampOf(std::size_t kept) const { return map.kept_scans[kept].scan.stamp; }

  /// From kept scan `first` on the robot goes 4 m up a flight and down another, `beside_m` beside
  /// it, among near walls. The kept scan after the last.
  std::size_t DriveUpAndBack(std::size_t first, double beside_m) {
    const double driven = 8.0 + beside_m;
    std::vector<TrajectoryPose>& poses = map.trajectory;
    std::size_t pose = map.kept_scans[first].trajectory_index;
    const Pose2 T_odom_foot = poses[pose].T_odom_robot;
    Pose2 T_odom_last = T_odom_foot;
    for (double way = 0.0; way <= driven; ++pose) {
      const Pose2 T_foot_robot = way < 4.0              ? Pose2{way, 0.0, 0.0}
                                 : way < 4.0 + beside_m ? Pose2{4.0, way - 4.0, kPi / 2.0}
                                                        : Pose2{driven - way, beside_m, kPi};
      const Pose2 T_odom_next = poses[pose + 1].T_odom_robot;
      poses[pose].T_odom_robot = T_odom_foot * T_foot_robot;
      way += Distance(T_odom_last, T_odom_next);
      T_odom_last = T_odom_next;
    }
    std::size_t kept = first;
    for (; map.kept_scans[kept].trajectory_index < pose; ++kept) SeeWallsAt(1.0F, kept);
    SeeWallsAt(8.0F, first - 1);
    SeeWallsAt(8.0F, kept);
    return kept;
  }

  /// From kept scan `first` on the robot stands for some seconds, among near walls. The kept scan
  /// after the last.
  std::size_t StandAsInACab(std::size_t first, double seconds) {
    std::vector<TrajectoryPose>& poses = map.trajectory;
    std::size_t pose = map.kept_scans[first].trajectory_index;
    const TrajectoryPose foot = poses[pose];
    while (poses[pose].stamp - foot.stamp <= seconds)
      poses[pose++].T_odom_robot = foot.T_odom_robot;
    std::size_t kept = first;
    for (; map.kept_scans[kept].trajectory_index < pose; ++kept) SeeWallsAt(1.0F, kept);
    return kept;
  }

 private:
  const Pose2& PoseOf(std::size_t kept) const {
    return map.trajectory[map.kept_scans[kept].trajectory_index].T_world_robot;
  }

  bool WasPassed(std::size_t kept) const {
    for (std::size_t k = 0; k < map.kept_scans.size() / 2; ++k) {
      if (Distance(PoseOf(k), PoseOf(kept)) < 0.5) return true;
    }
    return false;
  }

  void PutScreenAt(const Pose2& T_world_new) {
    for (std::size_t i = 0; i < map.kept_scans.size() / 2; ++i) {
      LaserScan& scan = map.kept_scans[i].scan;
      const Pose2 T_laser_screen = Inverse(PoseOf(i) * scan.T_robot_laser) * T_world_new;
      if (T_laser_screen.Translation().norm() > 4.0) continue;
      last_seen = std::max(last_seen, i);
      for (std::size_t beam = 0; beam < scan.size(); ++beam) {
        const Eigen::Vector2d direction(std::cos(scan.Angle(beam)), std::sin(scan.Angle(beam)));
        const Pose2 T_screen_laser = Inverse(T_laser_screen);
        const Eigen::Vector2d ray = T_screen_laser * direction - T_screen_laser.Translation();
        const double range = -T_screen_laser.x / ray.x();
        const double across = T_screen_laser.y + range * ray.y();
        if (range > 0.0 && std::abs(across) < 0.8) {
          scan.ranges[beam] = std::min(scan.ranges[beam], static_cast<float>(range));
        }
      }
    }
  }

  /// Rough ones, which nobody takes for a wall across the way.
  void SeeWallsAt(float range, std::size_t kept) {
    std::vector<float>& ranges = map.kept_scans[kept].scan.ranges;
    for (std::size_t i = 0; i < ranges.size(); ++i) ranges[i] = range * (i % 2 == 0 ? 1.2F : 0.8F);
  }
};

}  // namespace masked_mapper
