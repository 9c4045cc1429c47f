// SPDX-License-Identifier: BSD-3-Clause
// One format of a map, on request: the same bytes that a whole map's folder holds.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/export/map_export.hpp"
#include "masked_mapper/map/building_map.hpp"

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

}  // namespace masked_mapper
