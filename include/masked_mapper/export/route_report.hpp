// SPDX-License-Identifier: BSD-3-Clause
// The report page of a finished map with a way through it.
#pragma once

#include <filesystem>
#include <vector>

#include "masked_mapper/export/summary_file.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/routing/route.hpp"

namespace masked_mapper {

/// One self-contained page: the map's report, the way drawn into it. `grids` by FloorId. Points of
/// scans are drawn up to `max_range_m`. Throws std::runtime_error when it cannot be written.
void WriteRouteReport(const BuildingMap& map, const RunDescription& run,
                      const std::vector<OccupancyGrid>& grids, double max_range_m,
                      const Route& route, const std::filesystem::path& path);

}  // namespace masked_mapper
