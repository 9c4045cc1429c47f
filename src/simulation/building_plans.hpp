// SPDX-License-Identifier: BSD-3-Clause
// The buildings that have names. They are the same for every seed, except `random`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

/// Two small floors and an elevator: quick, for a demo and for tests.
Building OfficeBuilding();
/// Blank, parallel, equally spaced corridors on one floor: the aliasing trap.
Building CorridorsBuilding();
/// Ten floors of the same plan, furniture included: every floor looks like every other.
Building TowerBuilding();
/// The size of the paper's: three buildings, four floors, about 34 000 m^2 of bounding area.
Building CampusBuilding();
/// One of those above by its name in lower case, or `random` (random_building.hpp). Empty when
/// there is no building of that name.
std::optional<Building> NamedBuilding(const std::string& name, std::uint64_t seed);

}  // namespace masked_mapper
