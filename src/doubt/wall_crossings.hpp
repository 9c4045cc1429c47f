// SPDX-License-Identifier: BSD-3-Clause
// Where a robot drove through what it saw as a wall on another visit. Floors of one plan agree in
// nearly all that is seen of them, and a visit that lies wrong may agree in much: a wall that was
// driven through is no matter of shares.
#pragma once

#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "visit_agreement.hpp"

namespace masked_mapper {

struct WallCrossing {
  std::size_t driven = 0;  ///< the visit that drove there, in `visits`
  std::size_t seen = 0;    ///< the one that saw a wall
};

/// Of every pass through a wall one, in the order of driving, but for the doors of cabs, which open
/// and close. `visits`: of the whole map.
std::vector<WallCrossing> FindWallCrossings(const BuildingMap& map,
                                            const std::vector<Visit>& visits);

}  // namespace masked_mapper
