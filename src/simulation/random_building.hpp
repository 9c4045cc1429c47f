// SPDX-License-Identifier: BSD-3-Clause
// Buildings by the seed: rings, combs, ladders, wings, polygons and twins, of one to five floors,
// with corridors of every width, rooms of every size, halls, elevators and stairs.
#pragma once

#include <cstdint>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

/// Another building for every seed: plan, size, floors, elevators and stairs, order of visiting.
/// Labels count from the floor of the start, which is `0`.
Building RandomBuilding(std::uint64_t seed);

}  // namespace masked_mapper
