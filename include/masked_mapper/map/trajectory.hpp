// SPDX-License-Identifier: BSD-3-Clause
// Every scan's pose from the few optimised ones.
#pragma once

#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Sets T_world_robot along the trajectory: the motion path between two nodes, bent so that it
/// meets both optimised nodes, the correction spread by travelled distance and turned angle. At a
/// node the pose is the node's; after the last node the motion path goes on from it.
void BendTrajectory(const PoseGraph& graph, std::vector<TrajectoryPose>& trajectory);

/// Everything that has a place in the plane: nodes, trajectory, the motion path, named places and
/// areas. What was measured stays, and so does what the map says.
void MoveMap(const Pose2& T_new_world, BuildingMap& map);

}  // namespace masked_mapper
