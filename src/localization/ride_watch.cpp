// SPDX-License-Identifier: BSD-3-Clause
#include "ride_watch.hpp"

#include <cmath>
#include <deque>
#include <variant>

namespace masked_mapper {
namespace {

constexpr double kWindow = 240.0;    // s; the weather does little in it
constexpr double kLookEvery = 0.8;   // s
constexpr double kSettled = 5.0;     // s; until then stairs may only pause
constexpr double kSame = 3.0;        // s, by which the end of a ride may look otherwise later
constexpr double kCabRest = 3.0;     // s, that wheels rest in a cab when a ride is noticed
constexpr double kCabRadius = 0.25;  // m

template <class Reading>
void Forget(std::deque<Reading>& readings, double before) {
  while (!readings.empty() && readings.front().stamp < before) readings.pop_front();
}

}  // namespace

void RideWatch::Observe(const Observation& observation) {
  newest_ = Stamp(observation);
  if (const auto* scan = std::get_if<LaserScan>(&observation)) {
    if (scan->T_odom_robot) readings_.odometry.push_back({scan->stamp, *scan->T_odom_robot});
  } else if (const auto* odometry = std::get_if<OdometryReading>(&observation)) {
    readings_.odometry.push_back(*odometry);
  } else if (const auto* pressure = std::get_if<PressureReading>(&observation)) {
    readings_.pressure.push_back(*pressure);
  } else if (const auto* acceleration = std::get_if<AccelerationReading>(&observation)) {
    readings_.acceleration.push_back(*acceleration);
  }
  may_tell_ |= !readings_.pressure.empty() || !readings_.acceleration.empty();
  Forget(readings_.odometry, newest_ - kWindow);
  Forget(readings_.pressure, newest_ - kWindow);
  Forget(readings_.acceleration, newest_ - kWindow);
}

void RideWatch::NotePose(const Pose2& T_odom_robot) {
  if (T_odom_rest_ && Distance(*T_odom_rest_, T_odom_robot) <= kCabRadius) return;
  T_odom_rest_ = T_odom_robot;
  moved_at_ = newest_;
}

bool RideWatch::IsResting() const { return newest_ - moved_at_ >= kCabRest; }

bool RideWatch::IsDue() const { return may_tell_ && newest_ >= looked_ + kLookEvery; }

std::optional<RideNews> RideWatch::News() {
  looked_ = newest_;
  for (const FloorTransit& transit : MeasuredTransits(readings_, options_)) {
    // What the beginning of the last minutes cuts was told when it was whole; and one that was told
    // may look a little otherwise later.
    const bool is_cut = std::isinf(transit.start) && !std::isinf(transit.end);
    if (is_cut || transit.end <= told_to_ + kSame) continue;
    const bool goes_on = transit.start < told_to_;
    if (goes_on && !transit.climb) continue;
    RideNews news{transit.climb, transit.climb_sigma, newest_ >= transit.end + kSettled};
    if (goes_on) *news.climb_m -= told_climb_m_;
    if (news.is_over) {
      told_to_ = transit.end;
      told_climb_m_ = transit.climb.value_or(0.0);
    }
    return news;
  }
  return std::nullopt;
}

}  // namespace masked_mapper
