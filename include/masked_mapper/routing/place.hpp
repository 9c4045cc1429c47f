// SPDX-License-Identifier: BSD-3-Clause
// A place in a building, as people write it.
#pragma once

#include <Eigen/Core>
#include <string>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

struct Place {
  FloorId floor = 0;
  Eigen::Vector2d at_in_world = Eigen::Vector2d::Zero();
};

/// `floor,x,y` (label, metres in world), `t=STAMP` (s, of the map's trajectory: where the robot was
/// then, within half a second), or the name of a place. Throws InputError, one line.
Place PlaceOf(const std::string& text, const BuildingMap& map);

}  // namespace masked_mapper
