// SPDX-License-Identifier: BSD-3-Clause
// Hand-drawn scenes for the tests of masks: walls as polylines, and a perfect laser that looks at
// them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

using Polyline = std::vector<Eigen::Vector2d>;
using Scene = std::vector<Polyline>;

struct Scanner {
  double span_deg = 180.0;
  std::size_t beams = 181;
  float max_range = 30.0F;
};

inline Scanner HalfCircle() { return {180.0, 361, 30.0F}; }
inline Scanner FullCircle() { return {360.0, 720, 30.0F}; }

/// Distance along a ray to the nearest wall; infinite when it meets none.
inline double CastRay(const Scene& scene, const Eigen::Vector2d& from, double angle) {
  const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (const Polyline& wall : scene) {
    for (std::size_t i = 0; i + 1 < wall.size(); ++i) {
      const Eigen::Vector2d edge = wall[i + 1] - wall[i];
      const double denominator = cross(ray, edge);
      if (std::abs(denominator) < 1e-12) continue;
      const double range = cross(wall[i] - from, edge) / denominator;
      const double place = cross(wall[i] - from, ray) / denominator;
      if (range > 0.0 && place >= 0.0 && place <= 1.0) nearest = std::min(nearest, range);
    }
  }
  return nearest;
}

/// What a laser sees from the robot's place; half circles end at exactly -90 and 90 degrees, full
/// circles begin at -180.
inline LaserScan Look(const Scene& scene, const Pose2& T_world_robot, const Scanner& scanner,
                      const Pose2& T_robot_laser = {}) {
  LaserScan scan;
  scan.T_robot_laser = T_robot_laser;
  scan.max_range = scanner.max_range;
  const bool is_full = scanner.span_deg >= 360.0;
  scan.first_angle = -DegToRad(scanner.span_deg) / 2.0;
  scan.angle_step =
      DegToRad(scanner.span_deg) / static_cast<double>(is_full ? scanner.beams : scanner.beams - 1);
  const Pose2 T_world_laser = T_world_robot * T_robot_laser;
  for (std::size_t beam = 0; beam < scanner.beams; ++beam) {
    const double range =
        CastRay(scene, T_world_laser.Translation(), T_world_laser.theta + scan.Angle(beam));
    scan.ranges.push_back(range < scanner.max_range ? static_cast<float>(range) : kNoReturn);
  }
  return scan;
}

/// A corridor 2 m wide along x from `x_begin` to `x_end`, open at both ends, with gaps in its
/// walls.
struct Gap {
  double begin = 0.0;  ///< m along x
  double end = 0.0;
};
inline void AddWall(double x_begin, double x_end, double y, const std::vector<Gap>& gaps,
                    double depth, Scene& scene) {
  double x = x_begin;
  for (const Gap& gap : gaps) {
    // Behind each gap lies a side corridor as wide as the gap.
    scene.push_back({{x, y}, {gap.begin, y}, {gap.begin, y + std::copysign(depth, y)}});
    scene.push_back({{gap.end, y + std::copysign(depth, y)}, {gap.end, y}});
    x = gap.end;
  }
  scene.push_back({{x, y}, {x_end, y}});
}
inline Scene Corridor(double x_begin, double x_end, const std::vector<Gap>& left = {},
                      const std::vector<Gap>& right = {}, double depth = 20.0) {
  Scene scene;
  AddWall(x_begin, x_end, 1.0, left, depth, scene);
  AddWall(x_begin, x_end, -1.0, right, depth, scene);
  return scene;
}

/// The same scene with a wall across.
inline Scene Closed(Scene scene, double x) {
  scene.push_back({{x, -1.0}, {x, 1.0}});
  return scene;
}

}  // namespace masked_mapper
