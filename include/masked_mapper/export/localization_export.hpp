// SPDX-License-Identifier: BSD-3-Clause
// What is written of a drive that was found in a map: trajectory.tum (in the map's frame, the log's
// stamps, placed scans only), floors.csv (`t,label`; `?` while the robot was not sure),
// summary.json, and page.html with the drive drawn into the map.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "masked_mapper/localization/localizer.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// What the run was asked to do, and what it took.
struct LocalizationRun {
  std::vector<std::string> logs;  ///< paths as given
  std::string map;                ///< path as given
  double seconds = 0.0;
  std::vector<std::string> warnings;
  std::string doubt;  ///< Localizer::Doubt() at the end
};

/// As summary.json and `--json` have it.
std::string LocalizationSummaryText(const BuildingMap& map, const Localization& drive,
                                    const std::vector<MapChange>& changes,
                                    const LocalizationRun& run);

/// One line of JSON for the answer to one scan; what is not known is null.
std::string PoseLine(const BuildingMap& map, const LocatedScan& scan);

/// Writes all files into `folder`, which exists. Throws std::runtime_error when one cannot be
/// written.
void WriteLocalization(const BuildingMap& map, const Localization& drive,
                       const std::vector<MapChange>& changes, const LocalizationRun& run,
                       const std::filesystem::path& folder);

}  // namespace masked_mapper
