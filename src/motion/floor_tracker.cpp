// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "floor_acceleration.hpp"
#include "floor_evidence.hpp"
#include "floor_labels.hpp"
#include "floor_lidar.hpp"
#include "floor_pressure.hpp"
#include "masked_mapper/motion/floor_timeline.hpp"
#include "pressure_heights.hpp"
#include "wheel_track.hpp"

namespace masked_mapper {
namespace {

constexpr double kLongGap = 15.0;  // s without a reading: a ride may have been in between
constexpr double kLate = 5.0;      // s by which a sensor may begin after a stay, or end before it

std::vector<double> StampsOf(const PressureHeights& heights) {
  std::vector<double> stamps;
  for (const HeightSample& sample : heights.samples) stamps.push_back(sample.stamp);
  return stamps;
}

}  // namespace

std::vector<FloorTransit> MeasuredTransits(const SensorReadings& readings,
                                           const FloorOptions& options) {
  PressureTrack pressure;
  AccelerationTrack acceleration(options.acceleration);
  WheelTrack wheels;
  for (const OdometryReading& reading : readings.odometry) wheels.Observe(reading);
  for (const PressureReading& reading : readings.pressure) pressure.Observe(reading);
  for (const AccelerationReading& reading : readings.acceleration) acceleration.Observe(reading);
  std::vector<FloorEvidence> sensors;
  const PressureHeights heights = pressure.Heights(options.pressure.heights);
  if (!heights.samples.empty()) {
    sensors.push_back({TransitsOfPressure(heights, wheels, options.pressure, options.storeys),
                       SpansOf(StampsOf(heights), kLongGap)});
  }
  AccelerationTrack::Rides rides = acceleration.FindRides(wheels, options.storeys);
  if (rides.usable) {
    sensors.push_back({std::move(rides.transits), SpansOf(acceleration.Stamps(), kLongGap)});
  }
  return Fused(sensors);
}

class FloorTracker::Impl {
 public:
  explicit Impl(const FloorOptions& options);

  void UseLabels(const std::vector<FloorLabel>& labels);
  void Observe(const Observation& observation);
  FloorTimeline Finish();
  FloorSource source() const { return source_; }
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

FloorTracker::Impl::Impl(const FloorOptions& options)
    : options_(options), acceleration_(options.acceleration), lidar_(options.lidar) {}

void FloorTracker::Impl::UseLabels(const std::vector<FloorLabel>& labels) {
  for (const FloorLabel& label : labels) CheckFloorLabel(label);
  labels_ = labels;
  labels_are_given_ = true;
}

void FloorTracker::Impl::Observe(const Observation& observation) {
  NoteStamp(Stamp(observation));
  if (const auto* odometry = std::get_if<OdometryReading>(&observation)) {
    track_.Observe(*odometry);
    if (Uses(FloorSource::kLidar)) lidar_.Observe(*odometry);
  } else if (const auto* scan = std::get_if<LaserScan>(&observation)) {
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

bool FloorTracker::Impl::HasLabels() const {
  return Uses(FloorSource::kLabels) &&
         std::any_of(labels_.begin(), labels_.end(),
                     [](const FloorLabel& label) { return label.label != "-"; });
}

void FloorTracker::Impl::NoteStamp(double stamp) {
  if (!std::isfinite(stamp)) return;
  log_ = has_stamps_ ? TimeSpan{std::min(log_.start, stamp), std::max(log_.end, stamp)}
                     : TimeSpan{stamp, stamp};
  has_stamps_ = true;
}

bool FloorTracker::Impl::ScansMayTell(const Evidence& evidence) const {
  if (!Uses(FloorSource::kLidar) || !lidar_.HasRanges()) return false;
  if (!track_.Travels()) return evidence.sensors.empty();
  const std::vector<TimeSpan> stays =
      track_.Stays(options_.lidar.cab_radius, options_.lidar.closed_s);
  return std::any_of(stays.begin(), stays.end(),
                     [&](const TimeSpan& stay) { return !IsHeard(evidence, stay); });
}

bool FloorTracker::Impl::IsHeard(const Evidence& evidence, const TimeSpan& stay) const {
  const double start = std::max(stay.start, log_.start);
  const double end = std::min(stay.end, log_.end);
  return std::any_of(
      evidence.sensors.begin(), evidence.sensors.end(), [&](const FloorEvidence& sensor) {
        return std::any_of(sensor.heard.begin(), sensor.heard.end(), [&](const TimeSpan& span) {
          return span.start <= start + kLate && end <= span.end + kLate;
        });
      });
}

// A barometer needs both sides of a ride. One that stops in a ride, or begins in one, does not end
// the log: the ride ends with the robot's stay, and nobody knows how high it went.
void FloorTracker::Impl::AddPressure(Evidence& evidence) const {
  const PressureHeights heights = pressure_.Heights(options_.pressure.heights);
  evidence.warnings.insert(evidence.warnings.end(), heights.warnings.begin(),
                           heights.warnings.end());
  if (heights.samples.empty()) return;
  FloorEvidence pressure;
  pressure.transits = TransitsOfPressure(heights, track_, options_.pressure, options_.storeys);
  const std::vector<double> stamps = StampsOf(heights);
  for (FloorTransit& transit : pressure.transits) {
    transit.by.Add(FloorSource::kPressure);
    const bool is_cut_early = std::isinf(transit.start) && stamps.front() > log_.start + kLongGap;
    const bool is_cut_late = std::isinf(transit.end) && stamps.back() < log_.end - kLongGap;
    if (!is_cut_early && !is_cut_late) continue;
    const double stamp = is_cut_early ? stamps.front() : stamps.back();
    const TimeSpan stay = track_.StayAround(stamp, options_.pressure.cab_radius);
    transit.start = is_cut_early ? std::min(stay.start, stamp) : transit.start;
    transit.end = is_cut_late ? std::max(stay.end, stamp) : transit.end;
    transit.climb.reset();
  }
  pressure.heard = SpansOf(stamps, kLongGap);
  evidence.sensors.push_back(std::move(pressure));
  evidence.sources.push_back(FloorSource::kPressure);
}

void FloorTracker::Impl::AddAcceleration(Evidence& evidence) const {
  AccelerationTrack::Rides rides = acceleration_.FindRides(track_, options_.storeys);
  evidence.warnings.insert(evidence.warnings.end(), rides.warnings.begin(), rides.warnings.end());
  if (!rides.usable) return;
  for (FloorTransit& transit : rides.transits) transit.by.Add(FloorSource::kAcceleration);
  evidence.sensors.push_back(
      {std::move(rides.transits), SpansOf(acceleration_.Stamps(), kLongGap)});
  evidence.sources.push_back(FloorSource::kAcceleration);
}

FloorTracker::Impl::Evidence FloorTracker::Impl::Gather() const {
  Evidence evidence;
  const bool takes_any = Uses(FloorSource::kLabels);  // labels take their heights from sensors
  if (takes_any || options_.source == FloorSource::kPressure) AddPressure(evidence);
  if (takes_any || options_.source == FloorSource::kAcceleration) AddAcceleration(evidence);
  return evidence;
}

FloorTimeline FloorTracker::Impl::Finish() {
  warnings_.clear();
  source_ = FloorSource::kNone;
  if (options_.source == FloorSource::kNone) return {};
  Evidence evidence = Gather();
  warnings_ = evidence.warnings;
  if (HasLabels()) {
    source_ = FloorSource::kLabels;
    const std::string sensor = evidence.sources.empty() ? ""
                               : evidence.sources.front() == FloorSource::kPressure
                                   ? "pressure"
                                   : "acceleration";
    // What they do not say did not happen.
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    LabelledTimeline labelled = TimelineOfLabels(labels_, Fused(evidence.sensors), sensor, track_,
                                                 options_.labels, options_.storeys);
    warnings_.insert(warnings_.end(), labelled.warnings.begin(), labelled.warnings.end());
    labelled.timeline.heard = {{-kInfinity, kInfinity}};
    return std::move(labelled.timeline);
  }
  std::vector<TimeSpan> heard;
  for (const FloorEvidence& sensor : evidence.sensors) {
    heard.insert(heard.end(), sensor.heard.begin(), sensor.heard.end());
  }
  if (options_.source != FloorSource::kLabels) {
    if (ScansMayTell(evidence)) {
      LidarTrack lidar = lidar_;
      FloorEvidence scans{lidar.FindRides(track_), {}};
      for (FloorTransit& transit : scans.transits) transit.by.Add(FloorSource::kLidar);
      evidence.sensors.push_back(std::move(scans));
      evidence.sources.push_back(FloorSource::kLidar);
    }
    if (!evidence.sources.empty()) {
      source_ = evidence.sources.front();
      FloorTimeline timeline = TimelineOfTransits(Fused(evidence.sensors), options_.storeys);
      timeline.heard = std::move(heard);
      return timeline;
    }
  }
  if (options_.source != FloorSource::kAuto) {
    warnings_.emplace_back(
        "the log has nothing of use of what floors are to be told by: one floor");
  }
  return {};
}

FloorTracker::FloorTracker(const FloorOptions& options) : impl_(std::make_unique<Impl>(options)) {}
FloorTracker::~FloorTracker() = default;

void FloorTracker::UseLabels(const std::vector<FloorLabel>& labels) { impl_->UseLabels(labels); }
void FloorTracker::Observe(const Observation& observation) { impl_->Observe(observation); }
FloorTimeline FloorTracker::Finish() { return impl_->Finish(); }
FloorSource FloorTracker::source() const { return impl_->source(); }
const std::vector<std::string>& FloorTracker::warnings() const { return impl_->warnings(); }

}  // namespace masked_mapper
