// SPDX-License-Identifier: BSD-3-Clause
// A map as it is handed over: turned so that its walls stand along the axes, its floors' grids of
// one origin and size, and the lanes on them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/rendering/wall_lines.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {

struct SquaredMap {
  Pose2 T_squared_world;  ///< of the map that was given
  BuildingMap map;
  std::vector<OccupancyGrid> grids;          ///< by FloorId, same origin and size
  std::vector<std::vector<WallLine>> walls;  ///< by FloorId
  LaneGraph lanes;
};

SquaredMap Squared(const BuildingMap& map, const HandoverOptions& options);

/// How coordinates of the files beside it come from those of the map, and what ties the floors.
void WriteFrame(const SquaredMap& squared, const Eigen::Vector2d& shift,
                const std::filesystem::path& path);

/// elevator_1, stairs_1 and so on, by place in LaneGraph::crossings.
std::vector<std::string> CrossingNames(const std::vector<Crossing>& crossings);

}  // namespace masked_mapper
