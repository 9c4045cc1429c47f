// SPDX-License-Identifier: BSD-3-Clause
#include "lift_cab.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace masked_mapper {
namespace {

constexpr double kFarthestWall = 2.5;  // m, of a cab from its middle
constexpr double kUsualHalf = 1.0;     // m

bool IsWall(const OccupancyGrid& grid, const Eigen::Vector2d& point) {
  const int column = static_cast<int>(std::floor((point.x() - grid.origin_x) / grid.resolution_m));
  const int row = static_cast<int>(std::floor((point.y() - grid.origin_y) / grid.resolution_m));
  return column >= 0 && row >= 0 && column < grid.width && row < grid.height &&
         grid.at(column, row) == Cell::kOccupied;
}

std::optional<double> WallAlong(const OccupancyGrid& grid, const Eigen::Vector2d& from,
                                const Eigen::Vector2d& direction) {
  for (double off = 0.0; off <= kFarthestWall; off += 0.5 * grid.resolution_m) {
    if (IsWall(grid, from + off * direction)) return off;
  }
  return std::nullopt;
}

/// The middle one of those that parallel looks meet.
double WallBeside(const OccupancyGrid& grid, const Eigen::Vector2d& from,
                  const Eigen::Vector2d& direction, const std::vector<double>& asides) {
  const Eigen::Vector2d aside(-direction.y(), direction.x());
  std::vector<double> met;
  for (const double off : asides) {
    if (const auto wall = WallAlong(grid, from + off * aside, direction)) met.push_back(*wall);
  }
  if (met.empty()) return kUsualHalf;
  std::sort(met.begin(), met.end());
  return met[met.size() / 2];
}

/// From the middle of a door to what ends it on one side.
double DoorPost(const OccupancyGrid& grid, const Eigen::Vector2d& middle,
                const Eigen::Vector2d& out, const Eigen::Vector2d& side, double half_width) {
  for (double off = 0.0; off < half_width; off += 0.5 * grid.resolution_m) {
    for (const double through : {-0.1, -0.05, 0.0, 0.05, 0.1}) {
      if (IsWall(grid, middle + off * side + through * out)) return off;
    }
  }
  return 0.9 * half_width;
}

}  // namespace

LiftCab CabAround(const Stop& stop, const OccupancyGrid& grid) {
  const Eigen::Vector2d at = stop.T_world_robot.Translation();
  const Eigen::Vector2d way = stop.outside_in_world - at;
  const double turn = std::round(std::atan2(way.y(), way.x()) / (M_PI / 2)) * (M_PI / 2);
  const Eigen::Vector2d out(std::round(std::cos(turn)), std::round(std::sin(turn)));
  const Eigen::Vector2d right(out.y(), -out.x());
  const std::vector<double> near = {-0.3, -0.15, 0.0, 0.15, 0.3};
  const double to_right = WallBeside(grid, at, right, near);
  const double to_left = WallBeside(grid, at, -right, near);
  const double to_back = WallBeside(grid, at, -out, near);
  // The front stands beside the door only: looks along both sides, clear of the sides themselves.
  // (WallBeside counts asides to the left of its direction.)
  const double to_front =
      WallBeside(grid, at, out, {to_left - 0.15, to_left - 0.2, 0.2 - to_right, 0.15 - to_right});
  LiftCab cab;
  cab.width_m = to_right + to_left;
  cab.depth_m = to_back + to_front;
  const Eigen::Vector2d centre =
      at + 0.5 * (to_right - to_left) * right + 0.5 * (to_front - to_back) * out;
  cab.T_world_cab = {centre.x(), centre.y(), WrapAngle(turn - M_PI / 2)};
  const Eigen::Vector2d door = centre + 0.5 * cab.depth_m * out;
  cab.door_width_m = DoorPost(grid, door, out, right, 0.5 * cab.width_m) +
                     DoorPost(grid, door, out, -right, 0.5 * cab.width_m);
  // A door that other scans saw shut ends nowhere: then it is as wide as doors are.
  if (cab.door_width_m < 0.6) cab.door_width_m = std::min(1.0, 0.9 * cab.width_m);
  return cab;
}

}  // namespace masked_mapper
