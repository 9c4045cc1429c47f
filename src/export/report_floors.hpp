// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "masked_mapper/pose_graph/pose_graph.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"

namespace masked_mapper {

/// Label, colour, walls and free space of every floor, for the page of the report.
nlohmann::ordered_json FloorsJson(const PoseGraph& graph, const std::vector<OccupancyGrid>& grids);

}  // namespace masked_mapper
