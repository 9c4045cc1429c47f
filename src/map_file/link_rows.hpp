// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "masked_mapper/map/building_map.hpp"

namespace masked_mapper {

/// What names another row must name one that there is, and that fits: a node its scan, an edge its
/// closure. Of a file before version 3 they are found. Throws DatabaseError.
void LinkRows(std::int64_t version, BuildingMap& map);

/// Of several drives each must keep to itself. Throws DatabaseError.
void CheckDrives(const BuildingMap& map);

}  // namespace masked_mapper
