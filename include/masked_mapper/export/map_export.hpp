// SPDX-License-Identifier: BSD-3-Clause
// Everything that a finished map is written as, except the saved map itself:
//
//   building.bt  building.pcd  building.ply  graph.g2o  trajectory.tum  nodes.tum  closures.csv
//   summary.json  report.html  floors/<label>.{pcd,pgm,yaml,g2o}
//   drives/<n>.tum, of a map of several logs
//
// And a map in one format, on request: a file, with the same bytes that a whole map's folder holds,
// or a folder that Nav2 or Open-RMF opens as it is.
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
#include "masked_mapper/routing/lanes.hpp"
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

enum class ExportFormat { kOctomap, kPcd, kPly, kGrid, kTum, kG2o, kGeojson, kSvg };

/// octomap, pcd, ply, grid, tum, g2o, geojson, svg; by enumeration value.
const std::vector<std::string>& ExportFormatNames();

struct SingleExport {
  ExportFormat format = ExportFormat::kOctomap;
  std::optional<FloorId> floor;  ///< empty: all
  HeightBand heights;            ///< of octomap, pcd and ply: what lies outside is left out
};

/// The floor of a label. Throws InputError that names those there are.
FloorId FloorOfLabel(const std::vector<Floor>& floors, const std::string& label);

/// Throws InputError when the format cannot be had so: heights of what has none; a grid of several
/// floors at once.
void CheckSingleExport(const SingleExport& wanted, const std::vector<Floor>& floors);

/// Writes the file; a grid becomes `path` with .pgm and .yaml, in place of either if it ends in it.
/// Returns the names of what was written. Throws as above, and std::runtime_error when a file
/// cannot be written.
std::vector<std::filesystem::path> WriteSingleExport(const BuildingMap& result,
                                                     const ExportOptions& options,
                                                     const SingleExport& wanted,
                                                     const std::filesystem::path& path);

/// A map for those who drive on it. Squared with the walls, so that pictures and costmaps are; all
/// floors of one origin and size.
struct HandoverOptions {
  ExportOptions drawing;
  ClearanceOptions clearance;
  bool keep_frame = false;  ///< not squared: of a map that has a site's frame
  std::string name = "building";
};

/// Into `folder`, which exists:
///
///   floors/<label>/map.yaml .pgm      a floor's grid (map_server)
///   floors/<label>/keepout.yaml .pgm  its keep-out mask
///   floors/<label>/graph.geojson      its lanes (route server); none where nothing was driven
///   frame.yaml                        the frame of all these, and what ties the floors
///
/// Throws InputError for a label that cannot name a file or a building too large for such cells,
/// and std::runtime_error when a file cannot be written.
void WriteNav2(const BuildingMap& map, const HandoverOptions& options,
               const std::filesystem::path& folder);

/// Into `folder`, which exists: <name>.building.yaml and its pictures <label>.png as
/// rmf_traffic_editor has them, nav_graphs/0.yaml, and frame.yaml. Throws as WriteNav2.
void WriteRmf(const BuildingMap& map, const HandoverOptions& options,
              const std::filesystem::path& folder);

}  // namespace masked_mapper
