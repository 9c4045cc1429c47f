// SPDX-License-Identifier: BSD-3-Clause
// A scanner on a robot that moves in a room of straight walls while each sweep lasts, for tests of
// what straightens its scans.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// 8 m by 6 m with a niche and a pillar, so that no two views of it are alike.
class RoomWithNiche {
 public:
  /// Of a ray, m; infinite where there is no wall.
  double Range(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : walls_) {
      const Eigen::Vector2d along = b - a;
      const double across = Cross(direction, along);
      if (std::abs(across) < 1e-12) continue;
      const double range = Cross(a - origin, along) / across;
      const double share = Cross(a - origin, direction) / across;
      if (range > 0.01 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, range);
    }
    return nearest;
  }
  /// To the nearest wall, m.
  double Distance(const Eigen::Vector2d& point) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : walls_) {
      const Eigen::Vector2d along = b - a;
      const double share = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + share * along - point).norm());
    }
    return nearest;
  }

 private:
  using Point = Eigen::Vector2d;
  static double Cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

  std::vector<std::pair<Point, Point>> walls_ = {
      {{-4.0, -3.0}, {4.0, -3.0}}, {{4.0, -3.0}, {4.0, 3.0}},   {{4.0, 3.0}, {1.5, 3.0}},
      {{1.5, 3.0}, {1.5, 4.2}},    {{1.5, 4.2}, {-0.5, 4.2}},   {{-0.5, 4.2}, {-0.5, 3.0}},
      {{-0.5, 3.0}, {-4.0, 3.0}},  {{-4.0, 3.0}, {-4.0, -3.0}}, {{2.0, -1.5}, {2.4, -1.5}},
      {{2.4, -1.5}, {2.4, -1.1}},  {{2.4, -1.1}, {2.0, -1.1}},  {{2.0, -1.1}, {2.0, -1.5}}};
};

struct SweepingScanner {
  std::function<Pose2(double)> T_room_robot;  ///< at a time, s
  std::size_t beams = 720;
  double span_deg = 360.0;
  double sweep_s = 0.18;  ///< of all beams; negative: the last first
  double noise_m = 0.0;   ///< sigma
  Pose2 T_robot_laser = {0.2, 0.05, 0.1};
  std::mt19937 random{7};

  LaserScan Scan(double stamp) {
    LaserScan scan;
    scan.stamp = scan.log_stamp = stamp;
    scan.T_robot_laser = T_robot_laser;
    scan.first_angle = -0.5 * DegToRad(span_deg);
    scan.angle_step = DegToRad(span_deg) / static_cast<double>(beams);
    scan.max_range = 25.0F;
    scan.beam_time = sweep_s / static_cast<double>(beams);
    scan.ranges.resize(beams);
    for (std::size_t beam = 0; beam < beams; ++beam) {
      const Pose2 T_room_laser = T_room_robot(stamp + scan.TimeOf(beam)) * T_robot_laser;
      const double angle = T_room_laser.theta + scan.Angle(beam);
      const double range =
          room.Range(T_room_laser.Translation(), Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      scan.ranges[beam] = static_cast<float>(range + noise_m * Normal());
    }
    return scan;
  }

  RoomWithNiche room;

 private:
  double Normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random()) / 4294967295.0;
    return sum;
  }
};

/// Of the hits of scans from where each was taken: how far off the walls the middle one is, m.
inline double MedianThickness(const SweepingScanner& scanner, const std::vector<LaserScan>& scans) {
  std::vector<double> off;
  for (const LaserScan& scan : scans) {
    const ScanPoints::ConstPtr points_in_robot = PointsInRobot(scan);
    for (const pcl::PointXY& point : *points_in_robot) {
      off.push_back(scanner.room.Distance(scanner.T_room_robot(scan.stamp) *
                                          Eigen::Vector2d(point.x, point.y)));
    }
  }
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle;
}

}  // namespace masked_mapper
