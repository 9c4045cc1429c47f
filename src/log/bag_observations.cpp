// SPDX-License-Identifier: BSD-3-Clause
#include "bag_observations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace masked_mapper {
namespace {

constexpr std::size_t kMostOtherTopics = 64;

}  // namespace

BagObservations::BagObservations(const LogOptions& options, const BagPlan& plan, const RosBag& bag,
                                 BagEvidence* evidence, CloudsKept clouds)
    : options_(options),
      plan_(plan),
      bag_(bag),
      evidence_(evidence),
      streams_(plan, bag),
      clouds_(clouds),
      in_order_(plan.scanners) {
  statistics_.max_range = plan.max_range;
  for (const Eigen::Isometry3d& T_robot_lidar : plan.T_robot_lidar) {
    lidars_.emplace_back(options, T_robot_lidar, static_cast<float>(plan.max_range));
  }
}

void BagObservations::Add(const BagMessage& message) {
  ++statistics_.lines;
  const std::optional<std::size_t> stream = streams_.Find(message.connection);
  if (!stream) {
    const BagConnection& connection = bag_.Connections().at(message.connection);
    CountOther(connection.topic + " (" + connection.type + ")");
  } else if (!Take(*stream, message)) {
    if (statistics_.bad_lines++ == 0) {
      statistics_.first_bad_line = "message " + std::to_string(statistics_.lines) + " on " +
                                   plan_.topics[*stream].name + ": " +
                                   FaultOf(plan_.topics[*stream].kind, message);
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

bool BagObservations::Take(std::size_t stream, const BagMessage& message) {
  auto parsed = ParseMessage(plan_.topics[stream].kind, message, options_);
  if (!parsed) return false;
  if (evidence_ != nullptr) {
    std::visit([&](const auto& read) { evidence_->Add(stream, message.time, read); }, *parsed);
  }
  std::visit([&](auto& read) { TakeMessage(stream, message.time, read); }, *parsed);
  return true;
}

bool BagObservations::IsOfFrame(std::size_t stream, const RosHeader& header) {
  const BagTopic& topic = plan_.topics[stream];
  if (topic.frame.empty() || header.frame_id == topic.frame) return true;
  CountOther(topic.name + " (of `" + header.frame_id + "`)");
  return false;
}

void BagObservations::TakeMessage(std::size_t stream, double time, RosLaserScan& scan) {
  if (!IsOfFrame(stream, scan.header)) return;
  const double stamp = plan_.StampOf(stream, time, scan.header.stamp);
  mender_.Add(Convert(std::move(scan), stamp, plan_.topics[stream].scanner), stream);
}

void BagObservations::TakeMessage(std::size_t stream, double time, RosPointCloud& cloud) {
  if (!IsOfFrame(stream, cloud.header)) return;
  const double stamp = plan_.StampOf(stream, time, cloud.header.stamp);
  CloudScanner& lidar = lidars_[plan_.topics[stream].scanner];
  std::vector<StampedCloud>* const keep = clouds_ == CloudsKept::kNone ? nullptr : &kept_clouds_;
  mender_.Add(lidar.Cut(std::move(cloud), stamp, motion_, keep), stream);
}

void BagObservations::AddOdometry(std::size_t stream, const OdometryReading& reading) {
  motion_.Add(reading);
  mender_.Add(reading, stream);
}

void BagObservations::TakeMessage(std::size_t stream, double time, const RosOdometry& odometry) {
  AddOdometry(stream, plan_.ReadingOf(stream, time, odometry));
}

void BagObservations::TakeMessage(std::size_t stream, double time, const RosImu& imu) {
  const AccelerationReading reading = plan_.ReadingOf(stream, time, imu);
  motion_.Add(reading);
  mender_.Add(reading, stream);
}

void BagObservations::TakeMessage(std::size_t stream, double time,
                                  const RosFluidPressure& pressure) {
  mender_.Add(
      PressureReading{plan_.StampOf(stream, time, pressure.header.stamp), pressure.pressure_pa},
      stream);
}

void BagObservations::TakeMessage(std::size_t stream, double time,
                                  const std::vector<RosTransform>& transforms) {
  for (const RosTransform& transform : transforms) {
    const std::optional<OdometryReading> reading = plan_.ReadingOf(stream, time, transform);
    if (reading) AddOdometry(stream, *reading);
  }
}

LaserScan BagObservations::Convert(RosLaserScan ros_scan, double stamp, std::size_t scanner) {
  const PlanarMount& mount = plan_.mounts[scanner];
  const ScannerRanges& judged = plan_.ranges[scanner];
  LaserScan scan;
  scan.stamp = stamp;
  scan.log_stamp = ros_scan.header.stamp > 0.0 ? ros_scan.header.stamp : stamp;
  scan.T_robot_laser = mount.T_robot_laser;
  const double sense = mount.upside_down != options_.upside_down ? -1.0 : 1.0;
  scan.first_angle = sense * ros_scan.angle_min;
  scan.angle_step = sense * ros_scan.angle_increment;
  // Of several scanners' beams merged into one scan, each has a time of its own.
  const bool has_times = plan_.scanners == 1 && std::isfinite(ros_scan.time_increment);
  scan.beam_time = has_times ? ros_scan.time_increment : 0.0;
  const bool own_limit = plan_.no_return == 0.0F && IsRangeLimit(ros_scan.range_max);
  scan.max_range = static_cast<float>(own_limit ? ros_scan.range_max : plan_.max_range);
  const float no_return = plan_.no_return > 0.0F ? plan_.no_return : scan.max_range;
  if (!options_.read_ranges) return scan;
  scan.ranges = std::move(ros_scan.ranges);
  if (judged.scale != 1.0) {
    for (float& range : scan.ranges) range *= static_cast<float>(judged.scale);
  }
  const double least = judged.believes_range_min && ros_scan.range_min > options_.min_range &&
                               ros_scan.range_min < scan.max_range
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

void BagObservations::CountOther(const std::string& name) {
  auto& others = statistics_.other_messages;
  const bool has_room = others.size() < kMostOtherTopics || others.count(name) > 0;
  ++others[has_room ? name : "(others)"];
}

}  // namespace masked_mapper
