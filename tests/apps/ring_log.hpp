// SPDX-License-Identifier: BSD-3-Clause
// A small CARMEN log of our own: a robot drives round a ring of corridors, with side doors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {

struct Wall {
  double x0, y0, x1, y1;
};

/// Corridors 2 m wide around a block, with two niches on the outer side that break the symmetry.
inline std::vector<Wall> RingWalls() {
  return {
      {2, 2, 18, 2},  {18, 2, 18, 10}, {18, 10, 2, 10}, {2, 10, 2, 2},  // the block
      {0, 0, 8, 0},   {8, 0, 8, -3},   {8, -3, 10, -3}, {10, -3, 10, 0},
      {10, 0, 20, 0}, {20, 0, 20, 5},  {20, 5, 26, 5},  {26, 5, 26, 7},
      {26, 7, 20, 7}, {20, 7, 20, 12}, {20, 12, 0, 12}, {0, 12, 0, 0},
  };
}

inline double CastRay(const std::vector<Wall>& walls, const Pose2& T_world_laser, double angle) {
  const double dx = std::cos(T_world_laser.theta + angle);
  const double dy = std::sin(T_world_laser.theta + angle);
  double nearest = 81.83;  // what this scanner reports when nothing is hit
  for (const Wall& wall : walls) {
    const double ex = wall.x1 - wall.x0;
    const double ey = wall.y1 - wall.y0;
    const double determinant = dx * ey - dy * ex;
    if (std::abs(determinant) < 1e-12) continue;
    const double wx = wall.x0 - T_world_laser.x;
    const double wy = wall.y0 - T_world_laser.y;
    const double range = (wx * ey - wy * ex) / determinant;
    const double along = (wx * dy - wy * dx) / determinant;
    if (range > 0.0 && along >= 0.0 && along <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// Poses every 0.2 m along the corridors' middle, turning on the spot at the corners.
inline std::vector<Pose2> RingDrive(int rounds) {
  const std::vector<Pose2> corners = {{1, 1, 0}, {19, 1, 0}, {19, 11, 0}, {1, 11, 0}};
  std::vector<Pose2> poses;
  for (int leg = 0; leg < 4 * rounds; ++leg) {
    const Pose2& from = corners[static_cast<std::size_t>(leg % 4)];
    const Pose2& to = corners[static_cast<std::size_t>((leg + 1) % 4)];
    const double heading = std::atan2(to.y - from.y, to.x - from.x);
    const int steps = static_cast<int>(std::lround(Distance(from, to) / 0.2));
    for (int i = 0; i < steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      poses.push_back(
          {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y), heading});
    }
    for (int i = 1; i < 6; ++i) poses.push_back({to.x, to.y, WrapAngle(heading + i * kPi / 12.0)});
  }
  return poses;
}

/// FLASER lines, 181 beams over 180 degrees, 5 Hz; odometry turns too far by `drift_deg_per_m`.
inline std::vector<std::string> RingLog(int rounds, double drift_deg_per_m = 0.1) {
  const std::vector<Wall> walls = RingWalls();
  std::vector<std::string> lines = {"# a ring of corridors"};
  Pose2 T_odom_robot;
  const std::vector<Pose2> drive = RingDrive(rounds);
  for (std::size_t i = 0; i < drive.size(); ++i) {
    if (i > 0) {
      Pose2 step = Between(drive[i - 1], drive[i]);
      step.theta += DegToRad(drift_deg_per_m) * std::hypot(step.x, step.y);
      T_odom_robot = T_odom_robot * step;
    }
    std::string line = "FLASER 181";
    char text[160];
    for (int beam = 0; beam < 181; ++beam) {
      // A few millimetres of roughness, the same in every run.
      const double rough = 0.004 * std::sin(12.9898 * beam + 78.233 * static_cast<double>(i));
      std::snprintf(text, sizeof text, " %.3f",
                    CastRay(walls, drive[i], DegToRad(beam - 90.0)) + rough);
      line += text;
    }
    const double stamp = 100.0 + 0.2 * static_cast<double>(i);
    std::snprintf(text, sizeof text, " %.4f %.4f %.5f %.4f %.4f %.5f %.3f robot %.3f",
                  T_odom_robot.x, T_odom_robot.y, T_odom_robot.theta, T_odom_robot.x,
                  T_odom_robot.y, T_odom_robot.theta, stamp, stamp - 100.0);
    lines.push_back(line + text);
  }
  return lines;
}

inline std::string Joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace masked_mapper
