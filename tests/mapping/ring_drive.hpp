// SPDX-License-Identifier: BSD-3-Clause
// A drive round a ring of corridors with niches, wheels that drift, for tests of mapping as a
// whole.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"
#include "scan_matching/box_scene.hpp"

namespace masked_mapper {

struct RingDrive {
  BoxScene scene;
  std::vector<LaserScan> scans;
  std::vector<Pose2> truth;  ///< T_start_robot, one for each scan

  /// `rounds` of a 24 m by 16 m ring; the wheels turn `drift_deg_per_m` too far.
  RingDrive(double rounds, double drift_deg_per_m, unsigned seed = 1, std::size_t beams = 181,
            double field_of_view_deg = 270.0) {
    scene.AddBox(0.0, 0.0, 26.0, 18.0);
    scene.AddBox(2.0, 2.0, 24.0, 16.0);
    // Niches, no two alike, so that places can be told apart.
    scene.AddBox(5.0, -0.6, 6.1, 0.0);
    scene.AddBox(14.0, 0.0, 14.5, 0.4);
    scene.AddBox(26.0, 7.0, 26.8, 8.7);
    scene.AddBox(23.5, 12.0, 24.0, 12.6);
    scene.AddBox(17.0, 17.5, 18.7, 18.0);
    scene.AddBox(8.0, 16.0, 8.3, 16.5);
    scene.AddBox(0.0, 11.0, 0.5, 11.8);
    scene.AddBox(0.0, 4.0, 0.3, 5.7);
    std::mt19937 random(seed);
    const std::vector<Eigen::Vector2d> corners = {{25, 1}, {25, 17}, {1, 17}, {1, 1}};
    Pose2 T_world_robot{1.0, 1.0, 0.0};
    const Pose2 start = T_world_robot;
    Pose2 T_odom_robot;
    double stamp = 0.0;
    const auto step = [&](const Pose2& motion) {
      const double way = std::hypot(motion.x, motion.y);
      T_world_robot = T_world_robot * motion;
      Pose2 wheels = motion;
      wheels.x *= 1.01;
      wheels.theta += DegToRad(drift_deg_per_m) * way;
      T_odom_robot = T_odom_robot * wheels;
      LaserScan scan = scene.Scan(T_world_robot, beams, field_of_view_deg, &random, 0.01);
      scan.stamp = stamp += 0.25;
      scan.T_odom_robot = T_odom_robot;
      scans.push_back(scan);
      truth.push_back(Between(start, T_world_robot));
    };
    step({});
    const auto legs = static_cast<int>(std::lround(4.0 * rounds));
    for (int leg = 0; leg < legs; ++leg) {
      const Eigen::Vector2d goal = corners[static_cast<std::size_t>(leg % 4)];
      while ((goal - T_world_robot.Translation()).norm() > 0.1) step({0.2, 0.0, 0.0});
      for (int i = 0; i < 9; ++i) step({0.0, 0.0, DegToRad(10.0)});
    }
  }
};

/// Of a map of the whole drive, m.
inline double LargestError(const RingDrive& drive, const BuildingMap& map) {
  double worst = 0.0;
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    worst = std::max(worst, Distance(drive.truth[i], map.trajectory[i].T_world_robot));
  }
  return worst;
}

}  // namespace masked_mapper
