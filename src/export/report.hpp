// SPDX-License-Identifier: BSD-3-Clause
// report.html: one self-contained page that opens from disk without a network. The page itself
// (viewer/) is part of the library; what is written here is its data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "masked_mapper/export/summary_file.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/routing/route.hpp"

namespace masked_mapper {

/// What the page draws, as JSON: floors with their walls and free space (`grids`, by FloorId), some
/// points of the kept scans up to `max_range_m`, points of the kept clouds, the trajectory, nodes,
/// edges and closures, each pose before (the motion path, placed so that it starts where the map
/// does) and after optimisation. Long columns are base64 of little-endian numbers;
/// viewer/src/data.js reads them. However large the building, walls, free space, scans, clouds and
/// trajectory are thinned so that the page stays below 20 MB. Nothing in it depends on time or
/// threads. A `route` is drawn into the map; null: none.
std::string ReportData(const BuildingMap& result, const std::vector<OccupancyGrid>& grids,
                       double max_range_m, const Route* route = nullptr);

/// The page of `data` (of ReportData) and the summary, which holds all that differs between two
/// runs: `summary.seconds` and `summary.peak_memory_mib`.
std::string ReportPage(const std::string& data, const Summary& summary);

/// Throws std::runtime_error when the file cannot be written.
void WriteReport(const std::string& data, const Summary& summary,
                 const std::filesystem::path& path);

}  // namespace masked_mapper
