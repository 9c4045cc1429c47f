// SPDX-License-Identifier: BSD-3-Clause
#include "unbroken_way.hpp"

#include <cmath>

namespace masked_mapper {
UnbrokenWay::UnbrokenWay(const MotionOptions& options, bool wheels_are_due)
    : options_(ScansAlone(options)), wheels_are_due_(wheels_are_due) {}

void UnbrokenWay::Follow(const Observation& observation, const Sink& sink) {
  if (const auto* reading = std::get_if<OdometryReading>(&observation)) {
    wheels_are_due_ = true;
    // The wheels are believed again from the first scan that they tell of.
    if (scans_) return;
    Hear(reading->T_odom_robot);
    sink(OdometryReading{reading->stamp, T_way_robot_});
    return;
  }
  const auto* scan = std::get_if<LaserScan>(&observation);
  if (scan != nullptr) FollowScan(*scan);
  const bool is_as_told =
      scan == nullptr || !wheels_are_due_ || (scan->T_odom_robot && !T_way_odom_);
  if (is_as_told) {
    sink(observation);
    return;
  }
  LaserScan followed = *scan;
  followed.T_odom_robot = T_way_robot_;
  sink(followed);
  if (!scan->T_odom_robot) sink(OdometryReading{scan->stamp, T_way_robot_});
}

void UnbrokenWay::FollowScan(const LaserScan& scan) {
  if (scan.T_odom_robot) {
    wheels_are_due_ = true;
    if (scans_) {
      // The way up to here is still that of scans; wheels tell of what follows.
      scans_->Observe(scan);
      T_way_robot_ = T_way_silence_ * scans_->T_odom_robot();
      T_way_odom_ = T_way_robot_ * Inverse(*scan.T_odom_robot);
      silences_.back().span.end = scan.stamp;
      scans_.reset();
    } else {
      Hear(*scan.T_odom_robot);
    }
  } else if (wheels_are_due_) {
    if (!scans_) {
      scans_.emplace(options_);
      T_way_silence_ = T_way_robot_;
      if (last_scan_) scans_->Observe(*last_scan_);
      silences_.push_back({{last_scan_ ? last_scan_->stamp : scan.stamp, scan.stamp}, 0.0});
    }
    scans_->Observe(scan);
    T_way_robot_ = T_way_silence_ * scans_->T_odom_robot();
    Silence& silence = silences_.back();
    silence.span.end = scan.stamp;
    silence.way_sigma_m =
        std::sqrt(scans_->T_node_robot().covariance.topLeftCorner<2, 2>().trace());
  }
  last_scan_ = scan;
}

void UnbrokenWay::Hear(const Pose2& T_odom_robot) {
  T_way_robot_ = T_way_odom_ ? *T_way_odom_ * T_odom_robot : T_odom_robot;
}

}  // namespace masked_mapper
