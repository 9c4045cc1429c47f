// SPDX-License-Identifier: BSD-3-Clause
// How floors hang together for who goes about them: elevators and stairs, as driven.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

enum class CrossingKind { kElevator, kStairs };
constexpr std::array<const char*, 2> NamesOf(CrossingKind /*any*/) {
  return {"elevator", "stairs"};
}

/// Where the robot stood when it left a floor, or came to one: in the cab, or where stairs begin.
struct Stop {
  FloorId floor = 0;
  Pose2 T_world_robot;
  /// Where it had come from, or went then: on the floor, out of the door.
  Eigen::Vector2d outside_in_world = Eigen::Vector2d::Zero();
};

struct Crossing {
  CrossingKind kind = CrossingKind::kElevator;
  std::vector<Stop> stops;           ///< of different floors, in order of elevations; stairs: two
  std::vector<Eigen::Vector2d> way;  ///< of stairs: in world, from the first stop to the second
};

/// In order of first use. Rides whose cabs stood at one place of a floor are rides of one cab, and
/// any two of its floors are one ride apart.
std::vector<Crossing> CrossingsOf(const BuildingMap& map);

}  // namespace masked_mapper
