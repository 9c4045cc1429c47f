// SPDX-License-Identifier: BSD-3-Clause
// Poses as lines `t x y z qx qy qz qw` (TUM), T_world_robot, z the elevation of the floor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// One line, with its end.
std::string TumLine(double stamp, const Pose2& T_world_robot, double elevation);

/// One line per scan of the log. Throws std::runtime_error when the file cannot be written.
void WriteTrajectory(const std::vector<TrajectoryPose>& trajectory,
                     const std::vector<Floor>& floors, const std::filesystem::path& path);

/// One line per node, in order of ids: line i holds the stamp of vertex i of the g2o files. Throws
/// as above.
void WriteNodes(const PoseGraph& graph, const std::filesystem::path& path);

}  // namespace masked_mapper
