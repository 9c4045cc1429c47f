// SPDX-License-Identifier: BSD-3-Clause
// What people wrote into a map: places with a name, and areas.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

struct NamedPlace {
  std::string name;  ///< unique in its map; letters, digits, `_`, `.` and `-`
  FloorId floor = 0;
  Eigen::Vector2d at_in_world = Eigen::Vector2d::Zero();
};

enum class AreaKind {
  kKeepOut,  ///< nothing in it counts as free
  kErased,   ///< no wall in it counts
};
constexpr std::array<const char*, 2> NamesOf(AreaKind /*any*/) { return {"keep_out", "erase"}; }

struct Area {
  AreaKind kind = AreaKind::kKeepOut;
  FloorId floor = 0;
  std::vector<Eigen::Vector2d> corners_in_world;  ///< three or more
};

}  // namespace masked_mapper
