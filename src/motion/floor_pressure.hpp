// SPDX-License-Identifier: BSD-3-Clause
// Changes of floor from a barometer. The weather moves its heights by metres, but over hours; a
// ride or a flight of stairs takes seconds to a few minutes. So steps are looked for over short
// times, quick ones first, and slower ones in what is left when those are taken out. The wheels
// then say what a step was: an elevator (they rest, and the robot is in the cab from when it last
// travelled until it travels again), stairs or a ramp (they turn), or nothing of the kind.
#pragma once

#include <optional>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "pressure_heights.hpp"
#include "wheel_track.hpp"

namespace masked_mapper {

/// In order of stamps. Transits that come back to the floor they left are among them. Without
/// wheels (a track that does not travel) every step counts, and lasts as long as the heights move.
std::vector<FloorTransit> TransitsOfPressure(const PressureHeights& heights,
                                             const WheelTrack& track,
                                             const FloorPressureOptions& options,
                                             const StoreyOptions& storeys);

}  // namespace masked_mapper
