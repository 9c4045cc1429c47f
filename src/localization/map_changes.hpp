// SPDX-License-Identifier: BSD-3-Clause
// What has changed since a map was made, as far as a robot that was sure of its place saw it: walls
// that stand where the map saw free space, and walls of the map through which beams went. One drive
// tells no more than that; what only passed by (people) is small or was seen from one place alone.
// What the map's own scans hold against it just as well is no change: glass, and walls seen askew.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "masked_mapper/localization/localizer.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/searchable_floor.hpp"

namespace masked_mapper {

using ScansOfFloor = std::function<const std::vector<PosedScan>&(FloorId)>;

class ChangeFinder {
 public:
  /// A scan of a robot that is sure of its place; a few a metre are enough.
  void Observe(const LaserScan& scan, const SearchableFloor& floor, const Pose2& T_world_robot);

  /// By floor, the largest first. `scans` are those that the map is made of.
  std::vector<MapChange> Find(const ScansOfFloor& scans) const;

 private:
  struct Votes {
    std::uint16_t changed = 0;  ///< scans from places apart that speak for a change
    std::uint16_t as_it_was = 0;
    float last_x = 1e9F;  ///< m, where the robot was at the last vote
    float last_y = 1e9F;
  };
  using Cell = std::pair<std::int32_t, std::int32_t>;
  using Votings = std::map<Cell, Votes>;

  using Where = std::pair<FloorId, ChangeKind>;

  void Vote(ChangeKind kind, FloorId floor, const Eigen::Vector2d& point_in_world, bool changed,
            const Pose2& T_world_robot);
  std::map<Where, std::set<Cell>> ChangedCells() const;
  void AskMap(const ScansOfFloor& scans);
  void Forget(std::map<Where, std::set<Cell>>& changed) const;

  std::map<Where, Votings> votes_;
  std::map<FloorId, const SearchableFloor*> floors_;
  bool asks_of_known_cells_ = false;  ///< alone
};

}  // namespace masked_mapper
