// SPDX-License-Identifier: BSD-3-Clause
// Rooms drawn as straight walls and seen by a noisy scanner: known truth for the matcher's tests.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

using Room = std::vector<Wall>;

inline void AddLoop(const std::vector<Eigen::Vector2d>& corners, Room* room) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    room->push_back({corners[i], corners[(i + 1) % corners.size()]});
  }
}

/// 12 x 8 m with a niche, two pillars and a slanted wall: no symmetry.
inline Room DrawOffice() {
  Room room;
  AddLoop({{-5, -4}, {7, -4}, {7, 1}, {5, 4}, {-1, 4}, {-1, 5}, {-2.5, 5}, {-2.5, 4}, {-5, 4}},
          &room);
  AddLoop({{2, -1}, {2.6, -1}, {2.6, -0.5}, {2, -0.5}}, &room);
  AddLoop({{-3.5, 1.2}, {-3.1, 1.2}, {-3.1, 2.4}, {-3.5, 2.4}}, &room);
  return room;
}

/// Two parallel walls along x, 2.4 m apart, without an end in sight.
inline Room DrawCorridor() { return {{{-100, -1.2}, {100, -1.2}}, {{-100, 1.2}, {100, 1.2}}}; }

/// Distance from the pose's origin along a direction to the nearest wall; infinite without one.
inline double CastRay(const Room& room, const Pose2& T_room_laser, double angle) {
  const Eigen::Vector2d origin = T_room_laser.Translation();
  const Eigen::Vector2d direction(std::cos(T_room_laser.theta + angle),
                                  std::sin(T_room_laser.theta + angle));
  double nearest = std::numeric_limits<double>::infinity();
  for (const Wall& wall : room) {
    const Eigen::Vector2d along = wall.to - wall.from;
    const Eigen::Vector2d offset = wall.from - origin;
    const double determinant = along.x() * direction.y() - along.y() * direction.x();
    if (std::abs(determinant) < 1e-12) continue;
    const double range = (along.x() * offset.y() - along.y() * offset.x()) / determinant;
    const double place = (direction.x() * offset.y() - direction.y() * offset.x()) / determinant;
    if (range > 0.0 && place >= 0.0 && place <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

struct ScannerModel {
  int beams = 180;
  double field_of_view = kPi;  ///< rad, centred ahead
  double range_sigma = 0.01;   ///< m
  double max_range = 20.0;     ///< m
};

inline ScanPoints::ConstPtr LookAround(const Room& room, const Pose2& T_room_robot,
                                       const ScannerModel& scanner, std::mt19937* random) {
  std::normal_distribution<double> noise(0.0, 1.0);
  ScanPoints::Ptr points(new ScanPoints);
  for (int beam = 0; beam < scanner.beams; ++beam) {
    const double angle = scanner.field_of_view * ((beam + 0.5) / scanner.beams - 0.5);
    const double range = CastRay(room, T_room_robot, angle) + scanner.range_sigma * noise(*random);
    if (!(range < scanner.max_range)) continue;
    pcl::PointXY point;
    point.x = static_cast<float>(range * std::cos(angle));
    point.y = static_cast<float>(range * std::sin(angle));
    points->push_back(point);
  }
  return points;
}

inline double Uniform(double low, double high, std::mt19937* random) {
  return std::uniform_real_distribution<double>(low, high)(*random);
}

inline ScanPoints Points(const std::vector<std::pair<double, double>>& coordinates) {
  ScanPoints points;
  for (const auto& [x, y] : coordinates) {
    pcl::PointXY point;
    point.x = static_cast<float>(x);
    point.y = static_cast<float>(y);
    points.push_back(point);
  }
  return points;
}

}  // namespace masked_mapper
