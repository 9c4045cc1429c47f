// SPDX-License-Identifier: BSD-3-Clause
#include "bag_observations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace masked_mapper {
namespace {

constexpr double kClocksApart = 5.0;  // s
constexpr std::size_t kMostOtherTopics = 64;

}  // namespace

BagObservations::BagObservations(const LogOptions& options, const BagPlan& plan, const RosBag& bag)
    : options_(options), plan_(plan), bag_(bag), streams_(plan, bag), in_order_(plan.scanners) {
  statistics_.max_range = plan.max_range;
}

void BagObservations::Add(const BagMessage& message) {
  ++statistics_.lines;
  const std::optional<std::size_t> stream = streams_.Find(message.connection);
  if (!stream) {
    CountOther(bag_.Connections().at(message.connection));
  } else if (!Take(*stream, message)) {
    if (statistics_.bad_lines++ == 0) {
      statistics_.first_bad_line = "message " + std::to_string(statistics_.lines) + " on " +
                                   plan_.topics[*stream].name + ": malformed";
    }
  }
}

void BagObservations::Finish() {
  mender_.Finish();
  finished_ = true;
}

std::optional<Observation> BagObservations::Next() {
  MoveOn();
  std::optional<Observation> observation = in_order_.Next();
  if (observation) Count(*observation);
  return observation;
}

LogStatistics BagObservations::Statistics() const {
  LogStatistics statistics = statistics_;
  statistics.stamp_jumps = mender_.jumps();
  statistics.reordered = mender_.reordered();
  statistics.truncated = bag_.Truncated();
  statistics.bad_lines += bag_.Damaged();
  if (statistics.first_bad_line.empty() && bag_.Damaged() > 0) {
    statistics.first_bad_line = bag_.FirstDamage();
  }
  return statistics;
}

void BagObservations::MoveOn() {
  while (std::optional<Observation> mended = mender_.Next()) {
    at_scans_.Add(std::move(*mended), mender_.last_stream());
  }
  if (finished_) at_scans_.Finish();
  while (auto next = at_scans_.Next()) {
    in_order_.Add(std::move(next->first), plan_.topics[next->second].scanner);
  }
  if (finished_) in_order_.Finish();
}

double BagObservations::StampOf(std::size_t stream, const BagMessage& message,
                                const RosHeader& header) const {
  const double offset = plan_.clock_offsets[stream].value_or(plan_.clock_offset);
  const bool same_clock = std::abs(offset - plan_.clock_offset) <= kClocksApart;
  return header.stamp > 0.0 && same_clock ? header.stamp : message.time + plan_.clock_offset;
}

bool BagObservations::Take(std::size_t stream, const BagMessage& message) {
  const BagTopic& topic = plan_.topics[stream];
  switch (topic.kind) {
    case TopicKind::kScan:
    case TopicKind::kMultiEcho: {
      auto scan = ParseScan(topic.kind, message, options_);
      if (!scan) return false;
      const double stamp = StampOf(stream, message, scan->header);
      mender_.Add(Convert(std::move(*scan), stamp, plan_.mounts[topic.scanner]), stream);
      return true;
    }
    case TopicKind::kOdometry: {
      const auto odometry = ParseOdometry(message.data, message.size, message.encoding);
      if (!odometry) return false;
      mender_.Add(OdometryReading{StampOf(stream, message, odometry->header),
                                  SeenFromAbove(odometry->T_frame_child).T_robot_laser},
                  stream);
      return true;
    }
    case TopicKind::kTransforms:
      return TakeTransforms(stream, message);
    case TopicKind::kImu: {
      const auto imu = ParseImu(message.data, message.size, message.encoding);
      if (!imu) return false;
      mender_.Add(AccelerationReading{StampOf(stream, message, imu->header),
                                      plan_.R_robot_imu * imu->acceleration},
                  stream);
      return true;
    }
    case TopicKind::kPressure: {
      const auto pressure = ParseFluidPressure(message.data, message.size, message.encoding);
      if (!pressure) return false;
      mender_.Add(
          PressureReading{StampOf(stream, message, pressure->header), pressure->pressure_pa},
          stream);
      return true;
    }
  }
  return false;
}

bool BagObservations::TakeTransforms(std::size_t stream, const BagMessage& message) {
  const auto transforms = ParseTransforms(message.data, message.size, message.encoding);
  if (!transforms) return false;
  if (plan_.odometry_frame.empty()) return true;
  for (const RosTransform& transform : *transforms) {
    if (transform.header.frame_id != plan_.odometry_frame ||
        transform.child_frame_id != plan_.robot_frame) {
      continue;
    }
    mender_.Add(OdometryReading{StampOf(stream, message, transform.header),
                                SeenFromAbove(transform.T_frame_child).T_robot_laser},
                stream);
  }
  return true;
}

LaserScan BagObservations::Convert(RosLaserScan ros_scan, double stamp, const PlanarMount& mount) {
  LaserScan scan;
  scan.stamp = stamp;
  scan.T_robot_laser = mount.T_robot_laser;
  const double sense = mount.upside_down != options_.upside_down ? -1.0 : 1.0;
  scan.first_angle = sense * ros_scan.angle_min;
  scan.angle_step = sense * ros_scan.angle_increment;
  const bool own_limit = plan_.no_return == 0.0F && IsRangeLimit(ros_scan.range_max);
  scan.max_range = static_cast<float>(own_limit ? ros_scan.range_max : plan_.max_range);
  const float no_return = plan_.no_return > 0.0F ? plan_.no_return : scan.max_range;
  if (!options_.read_ranges) return scan;
  scan.ranges = std::move(ros_scan.ranges);
  const double least =
      ros_scan.range_min > options_.min_range && ros_scan.range_min < scan.max_range
          ? ros_scan.range_min
          : options_.min_range;
  const auto min_range = static_cast<float>(least);
  for (float& range : scan.ranges) {
    if (range >= min_range && range < no_return) continue;
    if (!(range >= 0.0F)) ++statistics_.invalid_ranges;
    range = range >= no_return ? kNoReturn : kInvalidRange;
  }
  return scan;
}

void BagObservations::Count(const Observation& observation) {
  const double stamp = Stamp(observation);
  if (!has_first_stamp_) statistics_.first_stamp = stamp;
  has_first_stamp_ = true;
  statistics_.last_stamp = stamp;
  if (std::holds_alternative<OdometryReading>(observation)) ++statistics_.odometry;
  if (std::holds_alternative<PressureReading>(observation)) ++statistics_.pressure;
  if (std::holds_alternative<AccelerationReading>(observation)) ++statistics_.acceleration;
  const auto* scan = std::get_if<LaserScan>(&observation);
  if (scan == nullptr) return;
  ++statistics_.scans;
  const auto is_hit = [scan](float range) { return range < scan->max_range; };
  if (options_.read_ranges && std::none_of(scan->ranges.begin(), scan->ranges.end(), is_hit)) {
    ++statistics_.empty_scans;
  }
}

void BagObservations::CountOther(const BagConnection& connection) {
  auto& others = statistics_.other_messages;
  const std::string name = connection.topic + " (" + connection.type + ")";
  const bool has_room = others.size() < kMostOtherTopics || others.count(name) > 0;
  ++others[has_room ? name : "(others)"];
}

}  // namespace masked_mapper
