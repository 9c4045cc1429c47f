// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper export --clouds LOG: what a 3D lidar saw, read from the log once more.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/export/space_export.hpp"
#include "masked_mapper/map_file/saved_map.hpp"

namespace masked_mapper {

struct SpaceRequest {
  std::string format;
  std::string file;
  std::vector<std::string> logs;  ///< bags of one recording, in its order
  SpaceExportOptions options;     ///< the range apart, which is the map's
  bool quiet = false;
};

/// Throws InputError for what needs no map to be wrong.
void CheckSpaceRequest(const SpaceRequest& request);

/// Exit code.
int ExportSpace(const SavedMap& map, SpaceRequest request);

}  // namespace masked_mapper
