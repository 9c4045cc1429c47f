// SPDX-License-Identifier: BSD-3-Clause
#include "evidence.hpp"

#include <algorithm>
#include <cmath>

namespace masked_mapper {
namespace {

bool IsWall(const OccupancyGrid& grid, const Eigen::Vector2d& point_in_world) {
  const double column = std::floor((point_in_world.x() - grid.origin_x) / grid.resolution_m);
  const double row = std::floor((point_in_world.y() - grid.origin_y) / grid.resolution_m);
  if (!(column >= 0.0 && row >= 0.0 && column < grid.width && row < grid.height)) return false;
  return grid.at(static_cast<int>(column), static_cast<int>(row)) == Cell::kOccupied;
}

constexpr PatchFit kFits = 50;   // percent, from which on a patch agrees: within 0.18 m of a wall
constexpr PatchFit kClear = 20;  // percent, by which a patch speaks for one of two places
constexpr double kKnownShare = 0.6;  // of a patch's points, of which the map must say something

// Beams went where the map has a wall. That they went where it has none tells next to nothing
// alone, but tells two places apart.
PatchFit FitOfFree(const Patch& patch, const SearchableFloor& floor, const Pose2& T_world_odom) {
  constexpr double kWallShare =
      0.2;  // of the lattice's points of a square metre that a wall crosses
  int walls = 0;
  int seen = 0;
  for (const Eigen::Vector2d& point : patch.points_in_odom) {
    const Eigen::Vector2d in_world = T_world_odom * point;
    seen += floor.IsSeen(in_world) ? 1 : 0;
    walls += IsWall(floor.seen(), in_world) ? 1 : 0;
  }
  const auto count = static_cast<double>(patch.points_in_odom.size());
  if (walls >= kWallShare * count) return 0;
  return seen >= kKnownShare * count && walls == 0 ? 100 : kMapSaysNothing;
}

}  // namespace

PatchFit FitOf(const Patch& patch, const SearchableFloor& floor, const Pose2& T_world_odom) {
  if (patch.is_free) return FitOfFree(patch, floor, T_world_odom);
  double sum = 0.0;
  int known = 0;
  for (const Eigen::Vector2d& point : patch.points_in_odom) {
    const Eigen::Vector2d in_world = T_world_odom * point;
    const double value = floor.fine().ValueAt(in_world);
    if (value == 0.0 && !floor.IsSeen(in_world)) continue;
    sum += value;
    ++known;
  }
  if (known < kKnownShare * static_cast<double>(patch.points_in_odom.size())) {
    return kMapSaysNothing;
  }
  return static_cast<PatchFit>(100.0 * sum / known);
}

void Tally::Add(const Patch& patch, PatchFit fit) {
  if (fit == kMapSaysNothing) return;
  if (fit < kFits) {
    ++contradicting;
  } else if (!patch.is_free) {
    ++agreeing;
  }
}

double NatsOf(const Tally& tally, double agrees_wrong, const EvidenceOptions& options) {
  const double right = options.agrees_in_place;
  return tally.agreeing * std::log(right / agrees_wrong) +
         tally.contradicting * std::log((1.0 - right) / (1.0 - agrees_wrong));
}

double LeadOf(const std::vector<PatchFit>& one, const std::vector<PatchFit>& other,
              const EvidenceOptions& options) {
  int ahead = 0;
  int behind = 0;
  const std::size_t count = std::min(one.size(), other.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (one[i] == kMapSaysNothing || other[i] == kMapSaysNothing) continue;
    if (one[i] >= other[i] + kClear) ++ahead;
    if (other[i] >= one[i] + kClear) ++behind;
  }
  constexpr double kOfCopies = 0.5;
  const double right = options.speaks_for_right;
  return ahead * std::log(right / kOfCopies) + behind * std::log((1.0 - right) / kOfCopies);
}

}  // namespace masked_mapper
