// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_tracker.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace masked_mapper {

FloorTracker::FloorTracker(const FloorOptions& options)
    : options_(options), acceleration_(options.acceleration), lidar_(options.lidar) {}

void FloorTracker::UseLabels(const std::vector<FloorLabel>& labels) {
  for (const FloorLabel& label : labels) CheckFloorLabel(label);
  labels_ = labels;
  labels_are_given_ = true;
}

void FloorTracker::Observe(const Observation& observation) {
  if (const auto* odometry = std::get_if<OdometryReading>(&observation)) {
    track_.Observe(*odometry);
    if (Uses(FloorSource::kLidar)) lidar_.Observe(*odometry);
  } else if (const auto* scan = std::get_if<LaserScan>(&observation)) {
    has_scans_ = true;
    if (scan->T_odom_robot) track_.Observe({scan->stamp, *scan->T_odom_robot});
    if (Uses(FloorSource::kLidar)) lidar_.Observe(*scan);
  } else if (const auto* pressure = std::get_if<PressureReading>(&observation)) {
    pressure_.Observe(*pressure);
  } else if (const auto* acceleration = std::get_if<AccelerationReading>(&observation)) {
    acceleration_.Observe(*acceleration);
  } else if (const auto* label = std::get_if<FloorLabel>(&observation)) {
    if (labels_are_given_ || !Uses(FloorSource::kLabels)) return;
    CheckFloorLabel(*label);
    labels_.push_back(*label);
  }
}

bool FloorTracker::HasLabels() const {
  return Uses(FloorSource::kLabels) &&
         std::any_of(labels_.begin(), labels_.end(),
                     [](const FloorLabel& label) { return label.label != "-"; });
}

bool FloorTracker::NeedsRanges() const {
  if (!Uses(FloorSource::kLidar) || !has_scans_ || lidar_.HasRanges()) return false;
  if (track_.Travels() &&
      track_.Stays(options_.lidar.cab_radius, options_.lidar.closed_s).empty()) {
    return false;
  }
  if (options_.source == FloorSource::kLidar) return true;
  return !HasLabels() && pressure_.Heights(options_.pressure.heights).samples.empty() &&
         !acceleration_.FindRides(track_, options_.storeys).usable;
}

FloorTimeline FloorTracker::FinishByClimbs(FloorSource source,
                                           const std::vector<FloorTransit>& transits) {
  source_ = source;
  return TimelineOfTransits(transits, options_.storeys);
}

FloorTimeline FloorTracker::Finish() {
  warnings_.clear();
  source_ = FloorSource::kNone;
  if (options_.source == FloorSource::kNone) return {};

  // What sensors say of climbs also gives labels their heights.
  std::vector<FloorTransit> transits;
  std::string sensor;
  const bool takes_any = Uses(FloorSource::kLabels);
  if (takes_any || options_.source == FloorSource::kPressure) {
    const PressureHeights heights = pressure_.Heights(options_.pressure.heights);
    warnings_.insert(warnings_.end(), heights.warnings.begin(), heights.warnings.end());
    if (!heights.samples.empty()) {
      sensor = "pressure";
      transits = TransitsOfPressure(heights, track_, options_.pressure, options_.storeys);
    }
  }
  if (sensor.empty() && (takes_any || options_.source == FloorSource::kAcceleration)) {
    AccelerationTrack::Rides rides = acceleration_.FindRides(track_, options_.storeys);
    warnings_.insert(warnings_.end(), rides.warnings.begin(), rides.warnings.end());
    if (rides.usable) {
      sensor = "acceleration";
      transits = std::move(rides.transits);
    }
  }

  if (HasLabels()) {
    source_ = FloorSource::kLabels;
    LabelledTimeline labelled =
        TimelineOfLabels(labels_, transits, sensor, track_, options_.labels, options_.storeys);
    warnings_.insert(warnings_.end(), labelled.warnings.begin(), labelled.warnings.end());
    return std::move(labelled.timeline);
  }
  if (options_.source != FloorSource::kLabels && sensor == "pressure") {
    return FinishByClimbs(FloorSource::kPressure, transits);
  }
  if (options_.source != FloorSource::kLabels && sensor == "acceleration") {
    return FinishByClimbs(FloorSource::kAcceleration, transits);
  }
  if (Uses(FloorSource::kLidar) && lidar_.HasRanges()) {
    return FinishByClimbs(FloorSource::kLidar, lidar_.FindRides(track_));
  }
  if (options_.source != FloorSource::kAuto) {
    warnings_.emplace_back(
        "the log has nothing of use of what floors are to be told by: one floor");
  }
  return {};
}

}  // namespace masked_mapper
