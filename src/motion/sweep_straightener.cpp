// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/sweep_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "straightened_scan.hpp"

namespace masked_mapper {
namespace {

// Readings farther apart do not tell when in between the robot turned.
constexpr double kLongestGap = 0.5;  // s
constexpr std::size_t kMostWaiting = 1000;

}  // namespace

LaserScan Timed(LaserScan scan, double seconds_per_rad) {
  scan.beam_time = seconds_per_rad * std::abs(scan.angle_step);
  return scan;
}

void SweepStraightener::Add(Observation observation) {
  newest_ = Stamp(observation);
  if (auto* scan = std::get_if<LaserScan>(&observation)) {
    *scan = Timed(std::move(*scan), timing_.seconds_per_rad);
    if (scan->T_odom_robot) Note({scan->stamp, *scan->T_odom_robot});
  } else if (const auto* reading = std::get_if<OdometryReading>(&observation)) {
    Note(*reading);
  }
  waiting_.push_back(std::move(observation));
}

void SweepStraightener::Note(const OdometryReading& reading) {
  if (timing_.seconds_per_rad == 0.0 || !timing_.by_wheels) return;
  const double oldest = waiting_.empty() ? reading.stamp : Stamp(waiting_.front());
  while (track_.size() > 1 && track_[1].stamp <= oldest) track_.pop_front();
  track_.push_back(reading);
}

std::optional<Observation> SweepStraightener::Next() {
  if (waiting_.empty()) return std::nullopt;
  auto* scan = std::get_if<LaserScan>(&waiting_.front());
  if (scan != nullptr && scan->beam_time != 0.0 && timing_.by_wheels) {
    if (MayComeYet(scan->stamp + scan->SweepDuration())) return std::nullopt;
    StraightenByWheels(*scan);
  }
  std::optional<Observation> next = std::move(waiting_.front());
  waiting_.pop_front();
  return next;
}

/// Whether the odometry at the end of a sweep may still come.
bool SweepStraightener::MayComeYet(double end) const {
  const bool has_come = !track_.empty() && track_.back().stamp >= end;
  return !has_come && !finished_ && newest_ <= end + kLongestGap && waiting_.size() < kMostWaiting;
}

void SweepStraightener::StraightenByWheels(LaserScan& scan) const {
  const std::optional<Pose2> T_odom_stamp = RobotAt(scan.stamp);
  bool is_known = T_odom_stamp.has_value();
  const auto T_stamp_then = [&](double seconds) {
    const std::optional<Pose2> T_odom_then = RobotAt(scan.stamp + seconds);
    is_known = is_known && T_odom_then;
    return is_known ? Between(*T_odom_stamp, *T_odom_then) : Pose2{};
  };
  LaserScan straight = Straightened(scan, T_stamp_then);
  if (is_known) scan = std::move(straight);
}

std::optional<Pose2> SweepStraightener::RobotAt(double stamp) const {
  const auto after = std::find_if(track_.begin(), track_.end(),
                                  [stamp](const auto& reading) { return reading.stamp >= stamp; });
  if (after == track_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->T_odom_robot;
  if (after == track_.begin()) return std::nullopt;
  const OdometryReading& before = *std::prev(after);
  const double gap = after->stamp - before.stamp;
  if (gap > kLongestGap) return std::nullopt;
  return Interpolate(before.T_odom_robot, after->T_odom_robot, (stamp - before.stamp) / gap);
}

}  // namespace masked_mapper
