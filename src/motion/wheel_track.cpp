// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStandRadius = 0.02;  // m, below which a robot has not moved
constexpr double kLeastTravel = 1.0;   // m, less in a whole log means wheels that do not report

}  // namespace

void WheelTrack::Observe(const OdometryReading& reading) {
  const Eigen::Vector2d position = reading.T_odom_robot.Translation();
  if (!std::isfinite(reading.stamp) || !position.allFinite()) return;
  if (stands_.empty()) {
    stands_.push_back({reading.stamp, reading.stamp, position, 0.0});
    return;
  }
  Stand& last = stands_.back();
  if (reading.stamp < last.last) return;
  const double moved = (position - last.position_in_odom).norm();
  if (moved < kStandRadius) {
    last.last = reading.stamp;
  } else {
    stands_.push_back({reading.stamp, reading.stamp, position, last.travelled + moved});
  }
}

bool WheelTrack::Travels() const {
  return !stands_.empty() && stands_.back().travelled >= kLeastTravel;
}

std::size_t WheelTrack::StandAt(double stamp) const {
  const auto after =
      std::upper_bound(stands_.begin(), stands_.end(), stamp,
                       [](double value, const Stand& stand) { return value < stand.first; });
  return after == stands_.begin() ? 0 : static_cast<std::size_t>(after - stands_.begin()) - 1;
}

double WheelTrack::TravelledAt(double stamp) const {
  const std::size_t i = StandAt(stamp);
  const Stand& stand = stands_[i];
  if (stamp <= stand.last || i + 1 == stands_.size()) return stand.travelled;
  const Stand& next = stands_[i + 1];
  const double fraction = (stamp - stand.last) / (next.first - stand.last);
  return stand.travelled + fraction * (next.travelled - stand.travelled);
}

double WheelTrack::Travel(double start, double end) const {
  return stands_.empty() ? 0.0 : TravelledAt(end) - TravelledAt(start);
}

TimeSpan WheelTrack::StayAround(double stamp, double radius) const {
  if (stands_.empty()) return {-kInfinity, kInfinity};
  const std::size_t center = StandAt(stamp);
  const auto is_near = [&](std::size_t i) {
    return (stands_[i].position_in_odom - stands_[center].position_in_odom).norm() <= radius;
  };
  std::size_t first = center;
  while (first > 0 && is_near(first - 1)) --first;
  std::size_t last = center;
  while (last + 1 < stands_.size() && is_near(last + 1)) ++last;
  return {first == 0 ? -kInfinity : stands_[first].first,
          last + 1 == stands_.size() ? kInfinity : stands_[last].last};
}

TimeSpan WheelTrack::LongestStay(double start, double end, double radius) const {
  const auto shared = [&](const TimeSpan& span) {
    return std::min(span.end, end) - std::max(span.start, start);
  };
  TimeSpan longest = StayAround(start, radius);
  if (stands_.empty()) return longest;
  // The robot stands longest somewhere inside the longest stay: stays around long stands suffice,
  // and where there is none, every moment is as good.
  const std::size_t last = StandAt(end);
  for (std::size_t i = StandAt(start); i <= last; ++i) {
    const bool is_covered = longest.end >= stands_[i].last && longest.start <= stands_[i].first;
    if (is_covered && stands_[i].last - stands_[i].first < 0.5) continue;
    const TimeSpan stay = StayAround(stands_[i].first, radius);
    if (shared(stay) > shared(longest)) longest = stay;
  }
  return longest;
}

std::vector<TimeSpan> WheelTrack::Stays(double radius, double min_duration) const {
  std::vector<TimeSpan> stays;
  for (std::size_t i = 0; i < stands_.size();) {
    // Where it comes to rest is at the rim of where it stays: the middle of the time is not.
    std::size_t last = i;
    while (last + 1 < stands_.size() &&
           (stands_[last + 1].position_in_odom - stands_[i].position_in_odom).norm() <= radius) {
      ++last;
    }
    const double near_for = stands_[last].last - stands_[i].first;
    if (near_for < 0.5 * min_duration) {
      ++i;
      continue;
    }
    TimeSpan stay = StayAround(stands_[i].first + 0.5 * near_for, radius);
    if (!stays.empty()) stay.start = std::max(stay.start, stays.back().end);
    if (stay.Duration() < min_duration) {
      ++i;
      continue;
    }
    stays.push_back(stay);
    while (i < stands_.size() && stands_[i].last <= stay.end) ++i;
  }
  return stays;
}

}  // namespace masked_mapper
