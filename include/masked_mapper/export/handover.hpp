// SPDX-License-Identifier: BSD-3-Clause
// A map for those who drive on it: folders that Nav2 and Open-RMF open as they are. Squared with
// the walls, so that pictures and costmaps are; all floors of one origin and size.
#pragma once

#include <filesystem>
#include <string>

#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/routing/lanes.hpp"

namespace masked_mapper {

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
