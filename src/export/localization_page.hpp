// SPDX-License-Identifier: BSD-3-Clause
// A drive drawn into the map that it was found in: one page, one drawing per floor.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/localization/localizer.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// `words` stand above the drawings.
std::string LocalizationPage(const BuildingMap& map, const Localization& drive,
                             const std::vector<MapChange>& changes, const std::string& words);

}  // namespace masked_mapper
