// SPDX-License-Identifier: BSD-3-Clause
// What a 3D lidar saw, as the report draws it.
#pragma once

#include <nlohmann/json.hpp>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// Points of the clouds that the map keeps, by floor, z above it; thinned so that they take less
/// than 6 MB of page. Throws InputError at a cloud that is damaged.
nlohmann::ordered_json SpaceJson(const BuildingMap& map);

}  // namespace masked_mapper
