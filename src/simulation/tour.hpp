// SPDX-License-Identifier: BSD-3-Clause
// The order in which a robot goes about a building: it visits every corridor of every floor, closes
// loops, changes floors by all elevators and stairs in turn, and comes back to where it began.
#pragma once

#include <cstdint>
#include <vector>

#include "masked_mapper/simulation/building.hpp"

namespace masked_mapper {

struct TourOptions {
  std::uint64_t seed = 1;
  double length = 0.0;              ///< m; the tour goes on until it is at least this long
  std::vector<std::size_t> visits;  ///< floors in order; empty: as is usual in the building
};

/// Way-points of one floor in the order of driving; neighbours are joined by a passage.
struct TourLeg {
  std::size_t floor = 0;
  std::vector<std::size_t> way_points;  ///< at least one
};

struct Transit {
  enum class Kind { kElevator, kStairs };
  Kind kind = Kind::kElevator;
  std::size_t index = 0;  ///< of the building's elevators or stairs
};

struct Tour {
  std::vector<TourLeg> legs;  ///< at least one
  std::vector<Transit>
      transits;  ///< transit i leads from the end of leg i to the start of leg i + 1
};

/// The building must have passed CheckBuilding.
/// Throws InputError when `visits` names a floor that is not there.
Tour PlanTour(const Building& building, const TourOptions& options);

/// Where another drive through the same building starts, and in which order it visits the floors:
/// tour 1 is the building's usual one; any other starts elsewhere, on another floor when there is
/// one, or on the first of `visits`. Drawn from `seed` and `tour`.
UsualTour OtherTour(const Building& building, std::uint64_t seed, std::uint64_t tour,
                    const std::vector<std::size_t>& visits);

/// Metres along the passages of all legs; transits are not counted.
double TourLength(const Building& building, const Tour& tour);

}  // namespace masked_mapper
