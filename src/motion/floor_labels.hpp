// SPDX-License-Identifier: BSD-3-Clause
// Floors as a person or an elevator's interface named them. Labels say which floor it is, and they
// win over every sensor. Between floors they are often silent or late; the sensors say when the
// robot really was in transit, and how high it climbed.
#pragma once

#include <string>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/sensor/observation.hpp"
#include "wheel_track.hpp"

namespace masked_mapper {

/// A label that cannot be a file's name is the user's fault: throws InputError.
void CheckFloorLabel(const FloorLabel& label);

struct LabelledTimeline {
  FloorTimeline timeline;
  std::vector<std::string> warnings;
};

/// `labels` in order of stamps, at least one that is not `-`. `transits` are those that a sensor
/// found (`sensor` is its name, for what is said when it contradicts), none if there is no sensor.
/// Throws InputError when there are more labels than any building has floors.
LabelledTimeline TimelineOfLabels(const std::vector<FloorLabel>& labels,
                                  const std::vector<FloorTransit>& transits,
                                  const std::string& sensor, const WheelTrack& track,
                                  const FloorLabelOptions& options, const StoreyOptions& storeys);

}  // namespace masked_mapper
