// SPDX-License-Identifier: BSD-3-Clause
// Which floor the robot was on, and when it was between floors (the paper says "when a floor change
// is detected" and leaves the rest open). The whole log is looked at before anything is decided.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "masked_mapper/motion/floor_acceleration.hpp"
#include "masked_mapper/motion/floor_evidence.hpp"
#include "masked_mapper/motion/floor_labels.hpp"
#include "masked_mapper/motion/floor_lidar.hpp"
#include "masked_mapper/motion/floor_pressure.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "masked_mapper/motion/floor_transit.hpp"
#include "masked_mapper/motion/pressure_heights.hpp"
#include "masked_mapper/motion/wheel_track.hpp"
#include "masked_mapper/sensor/observation.hpp"

namespace masked_mapper {

struct FloorOptions {
  FloorSource source = FloorSource::kAuto;
  std::string file;  ///< lines `t,label` that stand for the log's labels; empty: none
  StoreyOptions storeys;
  FloorLabelOptions labels;
  FloorPressureOptions pressure;
  FloorAccelerationOptions acceleration;
  FloorLidarOptions lidar;
};

class FloorTracker {
 public:
  explicit FloorTracker(const FloorOptions& options);

  /// These labels stand for those of the log. Throws InputError for a label that may not be one.
  void UseLabels(const std::vector<FloorLabel>& labels);
  /// Observations in order of stamps. Throws InputError for a label that may not be one.
  void Observe(const Observation& observation);

  /// All levels and intervals, once the whole log was observed. Clears warnings of before.
  FloorTimeline Finish();
  /// The best of what Finish() went by; not kAuto.
  FloorSource source() const { return source_; }
  /// What was wrong, one line each, each said once.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  bool Uses(FloorSource source) const {
    return options_.source == FloorSource::kAuto || options_.source == source;
  }

  void NoteStamp(double stamp);
  struct Evidence {
    std::vector<FloorEvidence> sensors;  ///< the best first
    std::vector<FloorSource> sources;    ///< of them
    std::vector<std::string> warnings;
  };
  Evidence Gather() const;
  void AddPressure(Evidence& evidence) const;
  void AddAcceleration(Evidence& evidence) const;
  bool IsHeard(const Evidence& evidence, const TimeSpan& stay) const;
  bool HasLabels() const;
  /// Whether scans may tell of a ride that nothing else would have noticed: the robot stood still
  /// long enough where no better sensor listened.
  bool ScansMayTell(const Evidence& evidence) const;

  FloorOptions options_;
  bool labels_are_given_ = false;
  std::vector<FloorLabel> labels_;
  PressureTrack pressure_;
  AccelerationTrack acceleration_;
  LidarTrack lidar_;
  TimeSpan log_{0.0, 0.0};  ///< first and last stamp
  bool has_stamps_ = false;
  WheelTrack track_;
  FloorSource source_ = FloorSource::kNone;
  std::vector<std::string> warnings_;
};

}  // namespace masked_mapper
