// SPDX-License-Identifier: BSD-3-Clause
// Changes of floor from a barometer. The weather moves its heights by metres, but over hours; a
// ride or a flight of stairs takes seconds to a few minutes. So steps are looked for over short
// times, quick ones first, and slower ones in what is left when those are taken out. The wheels
// then say what a step was: an elevator (they rest, and the robot is in the cab from when it last
// travelled until it travels again), stairs or a ramp (they turn), or nothing of the kind.
#pragma once

#include <optional>
#include <vector>

#include "masked_mapper/motion/floor_transit.hpp"
#include "masked_mapper/motion/pressure_heights.hpp"
#include "masked_mapper/motion/wheel_track.hpp"

namespace masked_mapper {

struct FloorPressureOptions {
  PressureHeightOptions heights;
  std::vector<double> windows_s = {4.0, 12.0, 40.0};  ///< s, on either side of a step
  double step_height = 1.5;    ///< m between the means of both windows: a step
  double moving_height = 0.5;  ///< m: the step is still going on
  double landing_s = 15.0;     ///< s between flights of the same stairs at most
  /// The weather around a transit: a steady drift (sigma, m/s), and a wandering part.
  double drift_m_per_s = 0.002;
  double wander_m_per_sqrt_s = 0.012;  ///< 0.15 m that are forgotten over 300 s do this
  double drift_window_s = 300.0;       ///< s on either side of a transit that show the drift
  double cab_radius = 0.25;         ///< m within which a robot stays while it turns round in a cab
  double least_stay_s = 6.0;        ///< s that wheels rest for a ride and its doors at least
  double least_travel_per_m = 0.8;  ///< m driven per m climbed on the steepest stairs
};

/// In order of stamps. Transits that come back to the floor they left are among them. Without
/// wheels (a track that does not travel) every step counts, and lasts as long as the heights move.
std::vector<FloorTransit> TransitsOfPressure(const PressureHeights& heights,
                                             const WheelTrack& track,
                                             const FloorPressureOptions& options,
                                             const StoreyOptions& storeys);

}  // namespace masked_mapper
