// SPDX-License-Identifier: BSD-3-Clause
// Tables `places` and `areas`: what people wrote into the map.
#pragma once

#include "database.hpp"
#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

void WriteAnnotations(const BuildingMap& result, const Database& database);

/// Once the map's floors are read. Throws DatabaseError when rows do not hold together.
void ReadAnnotations(const Database& database, BuildingMap& map);

}  // namespace masked_mapper
