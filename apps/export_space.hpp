// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper export --clouds: what a 3D lidar saw, as the map keeps it, or read from the log
// once more.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/export/space_export.hpp"
#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

struct SpaceRequest {
  std::string format;
  std::string file;
  std::vector<std::string>
      logs;               ///< bags of one recording, in its order; none: the map's own clouds
  double voxel_m = 0.05;  ///< of points
  bool keeps_passers_by = false;  ///< points where later rays saw through
  std::optional<FloorId> floor;   ///< empty: all
  HeightBand heights;             ///< in world
  RobotHeights robot;             ///< of grids
  double memory_mib = 1280.0;     ///< of voxels that rays pass
  bool quiet = false;
};

/// Throws InputError for what needs no map to be wrong.
void CheckSpaceRequest(const SpaceRequest& request);

/// Exit code. Range and resolution are the map's.
int ExportSpace(const SavedMap& map, const SpaceRequest& wanted);

}  // namespace masked_mapper
