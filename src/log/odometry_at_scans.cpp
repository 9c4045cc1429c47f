// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_at_scans.hpp"

#include <algorithm>

namespace masked_mapper {
namespace {

// Ours: odometry farther from a scan than this says nothing about it. Slow odometry comes at 1 Hz.
constexpr double kLongestGap = 2.0;  // s
// Beyond the last reading the robot is taken to go on as it did for as long before it, since
// silence is no rest; before the first, to stand.
constexpr double kLongestHold = 0.5;  // s
constexpr std::size_t kMostWaiting = 1000;

Pose2 GoneOn(const OdometryReading& before, const OdometryReading& last, double stamp) {
  const double elapsed = last.stamp - before.stamp;
  if (!(elapsed > 0.0)) return last.T_odom_robot;
  const double ratio = (stamp - last.stamp) / elapsed;
  const Pose2 step = Between(before.T_odom_robot, last.T_odom_robot);
  return last.T_odom_robot * Pose2{ratio * step.x, ratio * step.y, ratio * step.theta};
}

}  // namespace

void OdometryAtScans::Add(Observation observation, std::size_t stream) {
  newest_ = Stamp(observation);
  if (const auto* reading = std::get_if<OdometryReading>(&observation)) {
    if (scans_waiting_ == 0) Forget(reading->stamp);
    readings_.push_back(*reading);
  }
  scans_waiting_ += std::holds_alternative<LaserScan>(observation) ? 1 : 0;
  waiting_.emplace_back(std::move(observation), stream);
}

std::optional<std::pair<Observation, std::size_t>> OdometryAtScans::Next() {
  if (waiting_.empty()) return std::nullopt;
  auto* scan = std::get_if<LaserScan>(&waiting_.front().first);
  if (scan != nullptr && !scan->T_odom_robot && !Complete(scan)) return std::nullopt;
  if (scan != nullptr) --scans_waiting_;
  std::pair<Observation, std::size_t> next = std::move(waiting_.front());
  waiting_.pop_front();
  return next;
}

// Of what came before, a scan needs the last, and how the robot went up to there.
void OdometryAtScans::Forget(double stamp) {
  const double needed = stamp - 2.0 * kLongestHold;
  while (readings_.size() > 1 && readings_[1].stamp <= needed) readings_.pop_front();
}

/// False while the odometry behind the scan may still come.
bool OdometryAtScans::Complete(LaserScan* scan) {
  const double stamp = scan->stamp;
  Forget(stamp);
  const auto after = std::find_if(readings_.begin(), readings_.end(),
                                  [stamp](const auto& reading) { return reading.stamp >= stamp; });
  const bool may_come =
      !finished_ && newest_ <= stamp + kLongestGap && waiting_.size() < kMostWaiting;
  if (after == readings_.end() && may_come) return false;
  const auto before = after == readings_.begin() ? after : std::prev(after);
  const bool has_before = before != after;
  if (after != readings_.end() && after->stamp == stamp) {
    scan->T_odom_robot = after->T_odom_robot;
  } else if (has_before && after != readings_.end() &&
             after->stamp - before->stamp <= kLongestGap) {
    scan->T_odom_robot = Interpolate(before->T_odom_robot, after->T_odom_robot,
                                     (stamp - before->stamp) / (after->stamp - before->stamp));
  } else if (has_before && stamp - before->stamp <= kLongestHold) {
    const auto earlier =
        std::find_if(readings_.begin(), before, [&](const OdometryReading& reading) {
          return reading.stamp >= before->stamp - kLongestHold;
        });
    scan->T_odom_robot = GoneOn(*earlier, *before, stamp);
  } else if (after != readings_.end() && after->stamp - stamp <= kLongestHold) {
    scan->T_odom_robot = after->T_odom_robot;
  }
  return true;
}

}  // namespace masked_mapper
