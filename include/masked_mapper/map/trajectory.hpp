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

}  // namespace masked_mapper
