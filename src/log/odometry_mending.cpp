// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_mending.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "masked_mapper/geometry/pose2.hpp"
#include "odometry_at_scans.hpp"

namespace masked_mapper {
namespace {

/// Scans with another clock than the rest, put in order with it, and given the odometry of then.
class ScanClock {
 public:
  explicit ScanClock(double ahead_s) : ahead_s_(ahead_s) {}

  void Add(Observation observation) {
    const double newest = Stamp(observation);
    if (auto* scan = std::get_if<LaserScan>(&observation)) {
      // The wheels' own stamps stay, also those that a scan brought.
      if (scan->T_odom_robot) Wait(OdometryReading{scan->stamp, *scan->T_odom_robot});
      scan->T_odom_robot.reset();
      scan->stamp -= ahead_s_;
    }
    Wait(std::move(observation));
    Release(newest - std::max(ahead_s_, 0.0));
  }

  void Finish() {
    if (!waiting_.empty()) Release(waiting_.rbegin()->first);
    at_scans_.Finish();
  }

  std::optional<Observation> Next() {
    std::optional<std::pair<Observation, std::size_t>> next = at_scans_.Next();
    if (!next) return std::nullopt;
    return std::move(next->first);
  }

 private:
  void Wait(Observation observation) {
    const double stamp = Stamp(observation);
    waiting_.emplace(stamp, std::move(observation));
  }

  // What comes later has no earlier stamp.
  void Release(double until) {
    const auto end = waiting_.upper_bound(until);
    for (auto it = waiting_.begin(); it != end; ++it) at_scans_.Add(std::move(it->second), 0);
    waiting_.erase(waiting_.begin(), end);
  }

  double ahead_s_;
  std::multimap<double, Observation> waiting_;
  OdometryAtScans at_scans_;
};

/// The wheels' path, made anew of the steps that they tell.
class WheelPath {
 public:
  explicit WheelPath(const OdometryMending& mending) : mending_(mending) {}

  Pose2 At(const Pose2& T_odom_robot) {
    const bool is_as_told =
        mending_.travel_factor == 1.0 && mending_.turn_factor == 1.0 && !mending_.turns_left_out;
    if (is_as_told) return T_odom_robot;
    if (last_) {
      Pose2 step = Between(*last_, T_odom_robot);
      if (mending_.turns_left_out) step = {std::hypot(step.x, step.y), 0.0, 0.0};
      step.x *= mending_.travel_factor;
      step.y *= mending_.travel_factor;
      step.theta = WrapAngle(step.theta * mending_.turn_factor);
      mended_ = mended_ * step;
    }
    last_ = T_odom_robot;
    return mended_;
  }

 private:
  OdometryMending mending_;
  std::optional<Pose2> last_;
  Pose2 mended_;
};

class MendedLog final : public LogReader {
 public:
  MendedLog(std::unique_ptr<LogReader> log, OdometryMending mending)
      : log_(std::move(log)), mending_(std::move(mending)), path_(mending_) {
    if (mending_.scan_clock_s != 0.0) clock_.emplace(mending_.scan_clock_s);
  }

  std::optional<Observation> Next() override {
    while (std::optional<Observation> observation = NextInOrder()) {
      if (auto* reading = std::get_if<OdometryReading>(&*observation)) {
        if (IsLeftOut(reading->stamp)) continue;
        reading->T_odom_robot = path_.At(reading->T_odom_robot);
      } else if (auto* scan = std::get_if<LaserScan>(&*observation)) {
        if (IsLeftOut(scan->stamp)) scan->T_odom_robot.reset();
        if (scan->T_odom_robot) scan->T_odom_robot = path_.At(*scan->T_odom_robot);
      }
      return observation;
    }
    return std::nullopt;
  }

  const LogStatistics& Statistics() const override { return log_->Statistics(); }
  double Progress() const override { return log_->Progress(); }

 private:
  std::optional<Observation> NextInOrder() {
    if (!clock_) return log_->Next();
    while (true) {
      if (std::optional<Observation> next = clock_->Next()) return next;
      if (is_at_end_) return std::nullopt;
      if (std::optional<Observation> read = log_->Next()) {
        clock_->Add(std::move(*read));
      } else {
        is_at_end_ = true;
        clock_->Finish();
      }
    }
  }

  // Stamps do not step back.
  bool IsLeftOut(double stamp) {
    while (span_ < mending_.left_out.size() && mending_.left_out[span_].end < stamp) ++span_;
    return span_ < mending_.left_out.size() && mending_.left_out[span_].Contains(stamp);
  }

  std::unique_ptr<LogReader> log_;
  OdometryMending mending_;
  WheelPath path_;
  std::optional<ScanClock> clock_;
  std::size_t span_ = 0;
  bool is_at_end_ = false;
};

}  // namespace

std::unique_ptr<LogReader> Mended(std::unique_ptr<LogReader> log, OdometryMending mending) {
  if (mending.IsNone()) return log;
  return std::make_unique<MendedLog>(std::move(log), std::move(mending));
}

}  // namespace masked_mapper
