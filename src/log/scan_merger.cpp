// SPDX-License-Identifier: BSD-3-Clause
#include "scan_merger.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

// Scans farther apart in time are not joined: people walk 0.15 m in that time.
constexpr double kFarthestApart = 0.1;  // s
constexpr double kFinestStep = 2.0 * kPi / 14400.0;
constexpr double kCoarsestStep = 2.0 * kPi / 60.0;

struct VirtualBeams {
  double step = 0.0;
  std::vector<float>* ranges = nullptr;

  /// Beams are centred on multiples of the step, where those of a scanner facing ahead lie.
  std::size_t Index(double x, double y) const {
    const double index = std::round((std::atan2(y, x) + kPi) / step);
    return static_cast<std::size_t>(std::max(0.0, index)) % ranges->size();
  }
};

/// Enters the beams of one scan, whose robot stood at `T_now_then` of the virtual scan's.
void Enter(const LaserScan& scan, const Pose2& T_now_then, float max_range,
           const VirtualBeams& beams) {
  const Pose2 T_robot_laser = T_now_then * scan.T_robot_laser;
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    if (std::isnan(scan.ranges[beam])) continue;
    const double angle = T_robot_laser.theta + scan.Angle(beam);
    const double range = scan.IsHit(beam) ? scan.ranges[beam] : scan.max_range;
    const double x = T_robot_laser.x + range * std::cos(angle);
    const double y = T_robot_laser.y + range * std::sin(angle);
    float& seen = (*beams.ranges)[beams.Index(x, y)];
    if (scan.IsHit(beam)) {
      const auto distance = static_cast<float>(std::hypot(x, y));
      if (distance < max_range && !(distance >= seen)) seen = distance;
    } else if (std::isnan(seen)) {
      seen = kNoReturn;
    }
  }
}

}  // namespace

LaserScan MergeScans(const std::vector<const LaserScan*>& scans) {
  LaserScan merged;
  merged.stamp = scans.front()->stamp;
  merged.log_stamp = scans.front()->log_stamp;
  merged.T_odom_robot = scans.front()->T_odom_robot;
  double step = kCoarsestStep;
  for (const LaserScan* scan : scans) {
    if (scan->angle_step != 0.0) step = std::min(step, std::abs(scan->angle_step));
    const auto reach = static_cast<float>(scan->T_robot_laser.Translation().norm());
    merged.max_range = std::max(merged.max_range, scan->max_range + reach);
  }
  const double beams = std::round(2.0 * kPi / std::max(step, kFinestStep));
  merged.ranges.assign(static_cast<std::size_t>(beams), kInvalidRange);
  merged.angle_step = 2.0 * kPi / beams;
  merged.first_angle = -kPi;
  if (scans.front()->ranges.empty()) merged.ranges.clear();  // read without beams
  for (const LaserScan* scan : scans) {
    const bool moved = merged.T_odom_robot && scan->T_odom_robot;
    Enter(*scan, moved ? Between(*merged.T_odom_robot, *scan->T_odom_robot) : Pose2{},
          merged.max_range, {merged.angle_step, &merged.ranges});
  }
  return merged;
}

void ScanMerger::Add(LaserScan scan, std::size_t scanner) {
  newest_ = scan.stamp;
  latest_[scanner].push_back(std::move(scan));
  for (std::size_t other = 1; other < latest_.size() && latest_.front().empty(); ++other) {
    std::deque<LaserScan>& others = latest_[other];
    while (!others.empty() && others.front().stamp < newest_ - kFarthestApart) others.pop_front();
  }
}

/// Nothing that still comes can be nearer in time than what is there.
bool ScanMerger::IsComplete() const {
  return finished_ || newest_ > latest_.front().front().stamp + kFarthestApart;
}

std::optional<LaserScan> ScanMerger::Next() {
  if (latest_.front().empty() || !IsComplete()) return std::nullopt;
  const LaserScan first = std::move(latest_.front().front());
  latest_.front().pop_front();
  std::vector<const LaserScan*> scans{&first};
  const auto apart = [&first](const LaserScan& scan) { return std::abs(scan.stamp - first.stamp); };
  for (std::size_t scanner = 1; scanner < latest_.size(); ++scanner) {
    std::deque<LaserScan>& others = latest_[scanner];
    while (!others.empty() && others.front().stamp < first.stamp - kFarthestApart) {
      others.pop_front();
    }
    const auto nearest = std::min_element(
        others.begin(), others.end(),
        [&apart](const LaserScan& a, const LaserScan& b) { return apart(a) < apart(b); });
    if (nearest != others.end() && apart(*nearest) <= kFarthestApart) scans.push_back(&*nearest);
  }
  return MergeScans(scans);
}

}  // namespace masked_mapper
