// SPDX-License-Identifier: BSD-3-Clause
// Which floor the robot was on, and when it was between floors (the paper says "when a floor change
// is detected" and leaves the rest open). The whole log is looked at before anything is decided.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/motion_options.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

class FloorTracker {
 public:
  explicit FloorTracker(const FloorOptions& options);
  ~FloorTracker();

  /// These labels stand for those of the log. Throws InputError for a label that may not be one.
  void UseLabels(const std::vector<FloorLabel>& labels);
  /// Observations in order of stamps. Throws InputError for a label that may not be one.
  void Observe(const Observation& observation);

  /// All levels and intervals, once the whole log was observed. Clears warnings of before.
  FloorTimeline Finish();
  /// The best of what Finish() went by; not kAuto.
  FloorSource source() const;
  /// What was wrong, one line each, each said once.
  const std::vector<std::string>& warnings() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// What was measured in some minutes, each in order of stamps.
struct SensorReadings {
  std::deque<OdometryReading> odometry;
  std::deque<PressureReading> pressure;
  std::deque<AccelerationReading> acceleration;
};

/// The changes of floor that a barometer and an accelerometer tell together, as FloorTracker takes
/// them.
std::vector<FloorTransit> MeasuredTransits(const SensorReadings& readings,
                                           const FloorOptions& options);

}  // namespace masked_mapper
