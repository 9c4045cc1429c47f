// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_tracker.hpp"

#include <algorithm>
#include <variant>

namespace masked_mapper {

void FloorTracker::UseLabels(const std::vector<FloorLabel>& labels) {
  for (const FloorLabel& label : labels) CheckFloorLabel(label);
  labels_ = labels;
  labels_are_given_ = true;
}

void FloorTracker::Observe(const Observation& observation) {
  if (const auto* odometry = std::get_if<OdometryReading>(&observation)) {
    track_.Observe(*odometry);
  } else if (const auto* scan = std::get_if<LaserScan>(&observation)) {
    if (scan->T_odom_robot) track_.Observe({scan->stamp, *scan->T_odom_robot});
  } else if (const auto* pressure = std::get_if<PressureReading>(&observation)) {
    pressure_.push_back(*pressure);
  } else if (const auto* label = std::get_if<FloorLabel>(&observation)) {
    if (labels_are_given_ || !Uses(FloorSource::kLabels)) return;
    CheckFloorLabel(*label);
    labels_.push_back(*label);
  }
}

FloorTimeline FloorTracker::Finish() {
  warnings_.clear();
  source_ = FloorSource::kNone;
  if (options_.source == FloorSource::kNone) return {};
  const bool has_labels = Uses(FloorSource::kLabels) &&
                          std::any_of(labels_.begin(), labels_.end(),
                                      [](const FloorLabel& label) { return label.label != "-"; });
  if (options_.source == FloorSource::kLabels && !has_labels) {
    warnings_.push_back("floors are to be told by labels, and there is none: one floor");
    return {};
  }

  // Labels that are alone in charge take their heights from the barometer all the same.
  const PressureHeights heights = HeightsOfPressure(pressure_, options_.pressure.heights);
  warnings_ = heights.warnings;
  const bool has_pressure = !heights.samples.empty();
  std::vector<FloorTransit> transits;
  if (has_pressure) {
    transits = TransitsOfPressure(heights, track_, options_.pressure, options_.storeys);
  }

  if (has_labels) {
    source_ = FloorSource::kLabels;
    LabelledTimeline labelled = TimelineOfLabels(labels_, transits, has_pressure ? "pressure" : "",
                                                 track_, options_.labels, options_.storeys);
    warnings_.insert(warnings_.end(), labelled.warnings.begin(), labelled.warnings.end());
    return labelled.timeline;
  }
  if (has_pressure) {
    source_ = FloorSource::kPressure;
    return TimelineOfTransits(transits, options_.storeys);
  }
  if (options_.source == FloorSource::kPressure) {
    warnings_.push_back("floors are to be told by pressure, and there is none of use: one floor");
  }
  return {};
}

}  // namespace masked_mapper
