// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_at_scans.hpp"

#include <algorithm>

namespace masked_mapper {
namespace {

// Ours: odometry farther from a scan than this says nothing about it. Slow odometry comes at 1 Hz.
constexpr double kLongestGap = 2.0;  // s
// Beyond the last reading the robot is taken to stand where it was, for as long as this.
constexpr double kLongestHold = 0.5;  // s
constexpr std::size_t kMostWaiting = 1000;

}  // namespace

void OdometryAtScans::Add(Observation observation, std::size_t stream) {
  newest_ = Stamp(observation);
  if (const auto* reading = std::get_if<OdometryReading>(&observation)) {
    // Of what came before, a scan that still comes needs the last alone.
    if (scans_waiting_ == 0) readings_.clear();
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

/// False while the odometry behind the scan may still come.
bool OdometryAtScans::Complete(LaserScan* scan) {
  const double stamp = scan->stamp;
  while (readings_.size() > 1 && readings_[1].stamp <= stamp) readings_.pop_front();
  const auto after = std::find_if(readings_.begin(), readings_.end(),
                                  [stamp](const auto& reading) { return reading.stamp >= stamp; });
  const bool may_come =
      !finished_ && newest_ <= stamp + kLongestGap && waiting_.size() < kMostWaiting;
  if (after == readings_.end() && may_come) return false;
  const bool has_before = !readings_.empty() && readings_.front().stamp <= stamp;
  if (after != readings_.end() && after->stamp == stamp) {
    scan->T_odom_robot = after->T_odom_robot;
  } else if (has_before && after != readings_.end() &&
             after->stamp - readings_.front().stamp <= kLongestGap) {
    const OdometryReading& before = readings_.front();
    scan->T_odom_robot = Interpolate(before.T_odom_robot, after->T_odom_robot,
                                     (stamp - before.stamp) / (after->stamp - before.stamp));
  } else if (has_before && stamp - readings_.front().stamp <= kLongestHold) {
    scan->T_odom_robot = readings_.front().T_odom_robot;
  } else if (after != readings_.end() && after->stamp - stamp <= kLongestHold) {
    scan->T_odom_robot = after->T_odom_robot;
  }
  return true;
}

}  // namespace masked_mapper
