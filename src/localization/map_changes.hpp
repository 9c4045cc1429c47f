// SPDX-License-Identifier: BSD-3-Clause
// What has changed since a map was made, as far as a robot that was sure of its place saw it: walls
// that stand where the map saw free space, and walls of the map through which beams went. One drive
// tells no more than that; what only passed by (people) is small or was seen from one place alone.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "masked_mapper/localization/localizer.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/searchable_floor.hpp"

namespace masked_mapper {

class ChangeFinder {
 public:
  /// A scan of a robot that is sure of its place; a few a metre are enough.
  void Observe(const LaserScan& scan, const SearchableFloor& floor, const Pose2& T_world_robot);

  /// By floor, the largest first.
  std::vector<MapChange> Find() const;

 private:
  struct Votes {
    std::uint16_t changed = 0;  ///< scans from places apart that speak for a change
    std::uint16_t as_it_was = 0;
    float last_x = 1e9F;  ///< m, where the robot was at the last vote
    float last_y = 1e9F;
  };
  using Cell = std::pair<std::int32_t, std::int32_t>;
  using Votings = std::map<Cell, Votes>;

  void Vote(ChangeKind kind, FloorId floor, const Eigen::Vector2d& point_in_world, bool changed,
            const Pose2& T_world_robot);

  std::map<std::pair<FloorId, ChangeKind>, Votings> votes_;
};

}  // namespace masked_mapper
