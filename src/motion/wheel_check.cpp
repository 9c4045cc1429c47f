// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/wheel_check.hpp"

#include <algorithm>
#include <cmath>

#include "wheel_fit.hpp"

namespace masked_mapper {
namespace {

// Windows: long enough to tell a turn and a way, and no more than a share of the log.
constexpr double kWindow = 6.0;    // s
constexpr double kPause = 1.0;     // s without a scan that end a window
constexpr double kFastest = 0.08;  // s from scan to scan; faster scanners are thinned
constexpr int kFewestScans = 12;   // of a window; slow scanners get longer ones
// Scans that may be matched in the shortest log, and their share of a long one: as they come, and
// where the robot turns, which is rare and tells most.
constexpr std::uint64_t kFirst = 150;
constexpr double kShare = 0.04;
constexpr std::uint64_t kFirstTurning = 400;
constexpr double kShareTurning = 0.06;
constexpr double kChanged = 0.1;       // m of a beam from scan to scan
constexpr double kChangedShare = 0.5;  // of the beams, that make a turn
// Stretches end by whichever comes first.
constexpr double kStretch = 0.25;      // m
constexpr double kStretchTurn = 10.0;  // deg
constexpr double kStretchTime = 1.5;   // s
constexpr double kSureTurn = 1.0;      // deg of sigma up to which scans are sure of a turn
constexpr double kWheelsApart = 0.04;  // s from one pose of the wheels that is kept to the next

}  // namespace

WheelCheck::WheelCheck(const MotionOptions& options) : options_(ScansAlone(options)) {}

void WheelCheck::Observe(const OdometryReading& reading) {
  if (!wheels_.empty() && reading.stamp < wheels_.back().stamp + kWheelsApart) return;
  const Pose2& pose = reading.T_odom_robot;
  const double heading = wheels_.empty() ? pose.theta
                                         : wheels_.back().heading_rad +
                                               WrapAngle(pose.theta - wheels_.back().heading_rad);
  wheels_.push_back({reading.stamp, pose.Translation(), heading});
}

// In a turn nearly every beam changes, also where a robot that drives on sees the same walls.
bool WheelCheck::SeemsToTurn(const LaserScan& scan) const {
  if (scan.size() != last_ranges_.size()) return false;
  std::size_t changed = 0;
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    changed += std::abs(scan.ranges[beam] - last_ranges_[beam]) > kChanged ? 1 : 0;
  }
  return static_cast<double>(changed) > kChangedShare * static_cast<double>(scan.size());
}

bool WheelCheck::IsDue(const LaserScan& scan) const {
  const auto observed = static_cast<double>(observed_);
  const auto most = kFirst + static_cast<std::uint64_t>(kShare * observed);
  const auto most_turning = kFirstTurning + static_cast<std::uint64_t>(kShareTurning * observed);
  return matched_ < most || (matched_ < most + most_turning && SeemsToTurn(scan));
}

void WheelCheck::Observe(const LaserScan& scan) {
  ++observed_;
  if (scan.T_odom_robot) Observe(OdometryReading{scan.stamp, *scan.T_odom_robot});
  if (scans_ && scan.stamp - last_matched_ > kPause) scans_.reset();
  const bool is_due = !scans_ && IsDue(scan);
  last_ranges_ = scan.ranges;
  if (!scans_) {
    if (!is_due) return;
    scans_.emplace(options_);
    window_begin_ = stretch_begin_ = scan.stamp;
    T_window_stretch_ = Pose2{};
    matched_in_window_ = 0;
  } else if (scan.stamp - last_matched_ < kFastest) {
    return;
  }
  scans_->Observe(scan);
  last_matched_ = scan.stamp;
  ++matched_;
  ++matched_in_window_;
  const Pose2 moved = Between(T_window_stretch_, scans_->T_odom_robot());
  if (std::hypot(moved.x, moved.y) >= kStretch || std::abs(moved.theta) >= DegToRad(kStretchTurn) ||
      scan.stamp - stretch_begin_ >= kStretchTime) {
    EndStretch(scan.stamp);
  }
  if (scan.stamp - window_begin_ >= kWindow && matched_in_window_ >= kFewestScans) scans_.reset();
}

void WheelCheck::EndStretch(double stamp) {
  const UncertainPose2& T_stretch_robot = scans_->T_node_robot();
  const Eigen::Matrix3d& covariance = T_stretch_robot.covariance;
  if (covariance(2, 2) <= DegToRad(kSureTurn) * DegToRad(kSureTurn)) {
    stretches_.push_back({{stretch_begin_, stamp},
                          T_stretch_robot.mean,
                          std::sqrt(covariance.topLeftCorner<2, 2>().trace())});
  }
  scans_->StartNode();
  T_window_stretch_ = scans_->T_odom_robot();
  stretch_begin_ = stamp;
}

WheelReport WheelCheck::Find(const std::vector<TimeSpan>& left_out) const {
  std::vector<Stretch> stretches;
  std::copy_if(stretches_.begin(), stretches_.end(), std::back_inserter(stretches),
               [&](const Stretch& stretch) {
                 return std::none_of(left_out.begin(), left_out.end(), [&](const TimeSpan& span) {
                   return span.start <= stretch.span.end && stretch.span.start <= span.end;
                 });
               });
  return Compare(stretches, wheels_);
}

}  // namespace masked_mapper
