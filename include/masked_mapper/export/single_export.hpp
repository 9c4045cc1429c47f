// SPDX-License-Identifier: BSD-3-Clause
// A map in one format, on request: a file, with the same bytes that a whole map's folder holds, or
// a folder that Nav2 or Open-RMF opens as it is.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {

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
