// SPDX-License-Identifier: BSD-3-Clause
// Everything that a finished map is written as, except the saved map itself:
//
//   building.bt  building.pcd  building.ply  graph.g2o  trajectory.tum  nodes.tum  closures.csv
//   summary.json  report.html  floors/<label>.{pcd,pgm,yaml,g2o}
//   drives/<n>.tum, of a map of several logs
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "masked_mapper/export/summary_file.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/rendering/octree.hpp"

namespace masked_mapper {

struct ExportOptions {
  GridOptions grid;  ///< its `threads` are used for writing, too
  OctreeOptions octree;
};

struct FloorGrid {
  FloorId floor = 0;
  OccupancyGrid grid;
};

/// The grid of one floor, or of all, from all kept scans but those in transit.
std::vector<FloorGrid> RenderGrids(const MappingResult& result, const GridOptions& options,
                                   const std::optional<FloorId>& floor);

/// The grid of each floor, by FloorId.
std::vector<OccupancyGrid> RenderFloors(const MappingResult& result, const GridOptions& options);

/// Writes all files into `folder`, which exists (OutputFolder). To the seconds of the result those
/// of rendering and export are added, in the returned summary as in the file. Throws InputError for
/// a label that cannot name a file and for a building too large for its cells, std::runtime_error
/// when a file cannot be written.
Summary WriteMap(const MappingResult& result, const RunDescription& run,
                 const ExportOptions& options, const std::filesystem::path& folder);

}  // namespace masked_mapper
