// SPDX-License-Identifier: BSD-3-Clause
// A map in another frame of the plane.
#pragma once

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Everything that has a place in the plane: nodes, trajectory, the motion path, named places and
/// areas. What was measured stays, and so does what the map says.
void MoveMap(const Pose2& T_new_world, BuildingMap& map);

}  // namespace masked_mapper
