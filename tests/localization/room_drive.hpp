// SPDX-License-Identifier: BSD-3-Clause
// Scans of a robot that drives round a furnished room, to be found in a map of it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "mapping/masked_mapper.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/rendering/searchable_floor.hpp"
#include "masked_mapper/sensor/laser_scan.hpp"

namespace masked_mapper {

/// Walls of a room that is like itself from nowhere else: 14 m x 9 m, with things in it.
struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};
using Walls = std::vector<Wall>;

inline Walls Room(double width, double depth) {
  Walls walls{{{0, 0}, {width, 0}},
              {{width, 0}, {width, depth}},
              {{width, depth}, {0, depth}},
              {{0, depth}, {0, 0}}};
  for (const auto& [x, y, size] : {std::tuple{2.0, 6.5, 0.8},
                                   {5.5, 7.5, 1.5},
                                   {9.0, 6.0, 0.5},
                                   {12.0, 7.0, 1.1},
                                   {7.0, 1.0, 0.6}}) {
    walls.push_back({{x, y}, {x + size, y}});
    walls.push_back({{x + size, y}, {x + size, y + 0.5 * size}});
    walls.push_back({{x + size, y + 0.5 * size}, {x, y + 0.5 * size}});
    walls.push_back({{x, y + 0.5 * size}, {x, y}});
  }
  return walls;
}

inline double RangeTo(const Walls& walls, const Eigen::Vector2d& origin, double angle) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  double nearest = 1e9;
  for (const Wall& wall : walls) {
    const Eigen::Vector2d along = wall.to - wall.from;
    const double cross = direction.x() * along.y() - direction.y() * along.x();
    if (std::abs(cross) < 1e-12) continue;
    const Eigen::Vector2d off = wall.from - origin;
    const double range = (off.x() * along.y() - off.y() * along.x()) / cross;
    const double share = (off.x() * direction.y() - off.y() * direction.x()) / cross;
    if (range > 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// In the room, of scan `i` of a drive.
inline Pose2 DrivenPose(int i) {
  const double turn = 0.02 * i;
  return {7.0 + 4.5 * std::cos(turn), 4.0 + 1.6 * std::sin(turn),
          std::atan2(1.6 * std::cos(turn), -4.5 * std::sin(turn))};
}

/// Round and round through the room, from a corner of the way on; odometry begins at zero.
inline std::vector<LaserScan> Drive(const Walls& walls, int first, int scans, double stamp) {
  const Pose2 T_room_odom = DrivenPose(first);
  std::vector<LaserScan> log;
  for (int i = first; i < first + scans; ++i) {
    LaserScan scan;
    scan.stamp = scan.log_stamp = stamp + 0.2 * (i - first);
    scan.first_angle = -0.75 * M_PI;
    scan.angle_step = 1.5 * M_PI / 360.0;
    scan.max_range = 30.0F;
    const Pose2 T_room_robot = DrivenPose(i);
    scan.T_odom_robot = Between(T_room_odom, T_room_robot);
    for (int beam = 0; beam <= 360; ++beam) {
      const double angle = T_room_robot.theta + scan.Angle(static_cast<std::size_t>(beam));
      const double noise = 0.01 * std::sin(37.0 * beam + 11.0 * i);
      scan.ranges.push_back(
          static_cast<float>(RangeTo(walls, T_room_robot.Translation(), angle) + noise));
    }
    log.push_back(std::move(scan));
  }
  return log;
}

/// Of the drive, on the floors that are given.
inline BuildingMap MapOf(const std::vector<LaserScan>& log, const FloorTimeline& floors = {}) {
  MappingOptions options;
  options.motion.source = MotionSource::kFused;
  MaskedMapper mapper("always", options, floors);
  for (const LaserScan& scan : log) mapper.Observe(scan);
  return mapper.Finish();
}

/// Floors made ready for a search as the program does it.
inline SearchableFloorOptions UsualFloorSearch() {
  SearchableFloorOptions options;
  options.fine = FineSearchOptions();
  options.seen.resolution_m = 0.2;
  options.seen.min_hits = 1;
  return options;
}

}  // namespace masked_mapper
