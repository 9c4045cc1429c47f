// SPDX-License-Identifier: BSD-3-Clause
// The clouds that a log kept, at the poses of its map.
#pragma once

#include <vector>

#include "masked_mapper/log/packed_cloud.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// In order of the trajectory, which is one log's. One of a stamp that no pose has, one taken
/// between floors, and one before which the robot did not go on, as poor wheels may say, is left
/// out.
std::vector<KeptCloud> CloudsAtPoses(const std::vector<StampedCloud>& clouds,
                                     const std::vector<TrajectoryPose>& trajectory);

}  // namespace masked_mapper
