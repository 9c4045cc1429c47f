// SPDX-License-Identifier: BSD-3-Clause
// A scene of wall segments and its exact, or noisy, scans, for tests of whatever matches scans.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

struct BoxScene {
  struct Wall {
    Eigen::Vector2d from, to;
  };
  std::vector<Wall> walls;

  void AddBox(double x0, double y0, double x1, double y1) {
    walls.push_back({{x0, y0}, {x1, y0}});
    walls.push_back({{x1, y0}, {x1, y1}});
    walls.push_back({{x1, y1}, {x0, y1}});
    walls.push_back({{x0, y1}, {x0, y0}});
  }

  /// By brute force over all walls. `random` null: no noise.
  LaserScan Scan(const Pose2& T_world_robot, std::size_t beams, double field_of_view_deg,
                 std::mt19937* random = nullptr, double sigma_m = 0.02) const {
    LaserScan scan;
    scan.max_range = 30.0F;
    scan.first_angle = -0.5 * DegToRad(field_of_view_deg);
    scan.angle_step = DegToRad(field_of_view_deg) / static_cast<double>(beams - 1);
    std::normal_distribution<double> noise(0.0, sigma_m);
    for (std::size_t beam = 0; beam < beams; ++beam) {
      const double angle = T_world_robot.theta + scan.Angle(beam);
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      double nearest = std::numeric_limits<double>::infinity();
      for (const Wall& wall : walls) {
        Eigen::Matrix2d system;
        system << direction, wall.from - wall.to;
        if (std::abs(system.determinant()) < 1e-12) continue;
        const Eigen::Vector2d solution =
            system.inverse() * (wall.from - T_world_robot.Translation());
        if (solution.x() > 0.0 && solution.y() >= 0.0 && solution.y() <= 1.0) {
          nearest = std::min(nearest, solution.x());
        }
      }
      if (random != nullptr) nearest += noise(*random);
      scan.ranges.push_back(nearest < 30.0 ? static_cast<float>(nearest) : kNoReturn);
    }
    return scan;
  }
};

/// 8 m by 6 m with a cupboard, a table and a slanted screen.
inline BoxScene FurnishedRoom() {
  BoxScene room;
  room.AddBox(0.0, 0.0, 8.0, 6.0);
  room.AddBox(7.0, 0.0, 8.0, 1.5);
  room.AddBox(0.0, 5.2, 2.0, 6.0);
  room.walls.push_back({{5.5, 5.0}, {7.0, 4.2}});
  return room;
}

/// Two blank walls 2 m apart that go on beyond what a lidar sees.
inline BoxScene BlankCorridor() {
  BoxScene corridor;
  corridor.walls.push_back({{-200.0, -1.0}, {200.0, -1.0}});
  corridor.walls.push_back({{-200.0, 1.0}, {200.0, 1.0}});
  return corridor;
}

}  // namespace masked_mapper
