// SPDX-License-Identifier: BSD-3-Clause
// Everything that a finished map is written as, except the saved map itself:
//
//   building.bt  building.pcd  building.ply  graph.g2o  trajectory.tum  nodes.tum  closures.csv
//   summary.json  report.html  floors/<label>.{pcd,pgm,yaml,g2o}
//   drives/<n>.tum, of a map of several logs
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "masked_mapper/export/summary_file.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/rendering/occupancy_grid.hpp"
#include "masked_mapper/rendering/octree.hpp"
#include "masked_mapper/routing/route.hpp"

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
std::vector<FloorGrid> RenderGrids(const BuildingMap& result, const GridOptions& options,
                                   const std::optional<FloorId>& floor);

/// The grid of each floor, by FloorId.
std::vector<OccupancyGrid> RenderFloors(const BuildingMap& result, const GridOptions& options);

/// Files that could not be written; all others are there and whole.
class ExportError : public std::runtime_error {
 public:
  ExportError(const std::string& message, bool too_large)
      : std::runtime_error(message), is_too_large(too_large) {}
  bool is_too_large;  ///< the building, for cells of this size: coarser ones mend it
};

/// What WriteMap() writes of this map: names below its folder.
std::vector<std::filesystem::path> ExportedFiles(const BuildingMap& result);

/// Writes all files into `folder`, which exists (OutputFolder). To the seconds of the result those
/// of rendering and export are added, in the returned summary as in the file. A file that cannot be
/// written holds up no other, and leaves nothing behind: ExportError in the end names all of them,
/// as does a warning in the summary. Throws InputError for a label that cannot name a file.
Summary WriteMap(const BuildingMap& result, const RunDescription& run, const ExportOptions& options,
                 const std::filesystem::path& folder);

/// One self-contained page: the map's report, the way drawn into it. `grids` by FloorId. Points of
/// scans are drawn up to `max_range_m`. Throws std::runtime_error when it cannot be written.
void WriteRouteReport(const BuildingMap& map, const RunDescription& run,
                      const std::vector<OccupancyGrid>& grids, double max_range_m,
                      const Route& route, const std::filesystem::path& path);

}  // namespace masked_mapper
