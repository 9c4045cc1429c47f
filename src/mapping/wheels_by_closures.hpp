// SPDX-License-Identifier: BSD-3-Clause
// How good the wheels are, as the closures of a finished drive tell. Ours: the paper's authors knew
// their robot, and the defaults of dead reckoning have to cover the worst of public logs. Where
// scans do not correct the wheels on the way (motion/wheel_noise.hpp), closures of a node and those
// shortly before it are the first to tell of their noise and of their scale.
#pragma once

#include <optional>
#include <vector>

#include "masked_mapper/map/building_map.hpp"
#include "masked_mapper/motion/motion_options.hpp"

namespace masked_mapper {

/// A short way along the drive whose ends a closure ties directly. (Ways driven twice would tell
/// more, but wheels that pull to one side do so both times.)
struct WheelTie {
  double counted_m = 0.0;       ///< from end to end by wheels
  double matched_m = 0.0;       ///< and by the closure
  double travelled_m = 0.0;     ///< by wheels
  double turned_rad = 0.0;      ///< by wheels, all turns taken positive
  double turn_error_rad = 0.0;  ///< by wheels less by the closure
};

struct LearntWheels {
  DeadReckoningOptions noise;
  double travel_factor = 1.0;  ///< true travel over what wheels count
};

/// Of a map's validated closures.
std::vector<WheelTie> WheelTies(const BuildingMap& map);

/// None where closures tell nothing that would make another map: sigmas at most half of those of
/// `wheels`, or a factor that is surely not 1. Sigmas never grow, since what does not fit may be
/// wrong closures; and what the matches err is put down to the wheels, too, which keeps them on the
/// safe side.
std::optional<LearntWheels> WheelsByClosures(const std::vector<WheelTie>& ties,
                                             const DeadReckoningOptions& wheels);

}  // namespace masked_mapper
