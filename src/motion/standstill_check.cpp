// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/wheel_check.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/scan_matching/local_map.hpp"

namespace masked_mapper {
namespace {

// A rest of the wheels: less than they would tell of a robot that moves at all.
constexpr double kRest = 0.02;      // m
constexpr double kRestTurn = 0.5;   // deg
constexpr double kShortest = 2.0;   // s; odometry that comes at 1 Hz also seems to rest
constexpr int kContradictions = 3;  // that end a rest's credit
constexpr double kStep = 0.3;       // m by scans from which on the wheels are asked
constexpr double kStepTurn = 10.0;  // deg, the same
constexpr double kFarthest = 1.5;   // m by scans at which the question is dropped, and begun anew
constexpr double kFarthestTurn = 45.0;  // deg, the same
constexpr double kSceneSigma = 0.05;    // m, to tell the same scene from another one
constexpr double kGain = 0.12;  // of the points agree where scans say and not where wheels say
constexpr double kSame = 0.6;   // of them agree where scans say: it is the same scene
// Between two readings: no robot of a building is so fast.
constexpr double kLeap = 0.3;          // m
constexpr double kLeapSpeed = 10.0;    // m/s
constexpr double kLeapGain = 0.05;     // of the points, as kGain; no more than a confirmation
constexpr double kChanged = 0.1;       // m, of a beam
constexpr double kChangedShare = 0.1;  // of the beams; below it scans need not be asked

bool IsBeyond(const Pose2& motion, double distance_m, double turn_deg) {
  return std::hypot(motion.x, motion.y) > distance_m || std::abs(motion.theta) > DegToRad(turn_deg);
}

}  // namespace

StandstillCheck::StandstillCheck(const MotionOptions& options) : options_(ScansAlone(options)) {}

void StandstillCheck::Observe(const OdometryReading& reading) {
  if (last_) {
    const double step = Distance(last_->T_odom_robot, reading.T_odom_robot);
    const double elapsed = std::max(0.0, reading.stamp - last_->stamp);
    if (rest_ && step > kLeap && step > kLeapSpeed * elapsed) rest_->leap_m += step;
  }
  last_ = reading;
}

void StandstillCheck::Observe(const LaserScan& scan) {
  if (scan.T_odom_robot) {
    Observe(OdometryReading{scan.stamp, *scan.T_odom_robot});
    ObserveAtWheels(scan);
  } else if (rest_) {
    EndRest(rest_->span.end);
  }
  last_scan_ = scan;
}

void StandstillCheck::ObserveAtWheels(const LaserScan& scan) {
  if (rest_ && rest_->leap_m > 0.0 && !LeapIsFalse(scan)) rest_->leap_m = 0.0;
  if (!rest_ || rest_->leap_m > 0.0 || scan.size() != anchor_.size()) {
    if (rest_) EndRest(scan.stamp);
    BeginRest(scan);
    return;
  }
  if (IsBeyond(Between(rest_->T_odom_robot, *scan.T_odom_robot), kRest, kRestTurn)) {
    EndRest(scan.stamp);
    BeginRest(scan);
    return;
  }
  rest_->span.end = scan.stamp;
  if (!scans_) {
    if (!HasChanged(scan)) return;
    scans_.emplace(options_);
    scans_->Observe(anchor_);
  }
  scans_->Observe(scan);
  const Pose2& T_anchor_robot = scans_->T_odom_robot();
  const bool contradicts =
      IsBeyond(T_anchor_robot, kStep, kStepTurn) && Contradicts(scan, T_anchor_robot);
  rest_->contradictions += contradicts ? 1 : 0;
  if (contradicts || IsBeyond(T_anchor_robot, kFarthest, kFarthestTurn)) BeginAnchor(scan);
}

void StandstillCheck::BeginRest(const LaserScan& scan) {
  rest_ = Rest{{scan.stamp, scan.stamp}, *scan.T_odom_robot, 0, 0.0};
  BeginAnchor(scan);
}

void StandstillCheck::EndRest(double stamp) {
  rest_->span.end = stamp;
  if (IsFalse(*rest_)) found_.push_back({rest_->span, rest_->leap_m});
  rest_.reset();
}

bool StandstillCheck::IsFalse(const Rest& rest) {
  if (rest.leap_m > 0.0) return true;
  return rest.contradictions >= kContradictions && rest.span.Duration() >= kShortest;
}

void StandstillCheck::BeginAnchor(const LaserScan& scan) {
  anchor_ = scan;
  scans_.reset();
}

// Stamps lie, too: a leap is one when the scene says so.
bool StandstillCheck::LeapIsFalse(const LaserScan& scan) const {
  if (!last_scan_.T_odom_robot) return false;
  LocalMap map(options_.scans.map, Eigen::Vector2d::Zero());
  map.Add(*PointsInRobot(last_scan_), Pose2{});
  const ScanPoints::ConstPtr points = PointsInRobot(scan);
  const Eigen::Vector3d information(1.0, 1.0, 1.0);  // of a metre and a radian
  const Pose2 T_last_now = map.Align(*points, Pose2{}, information.asDiagonal()).T_map_robot;
  const Pose2 by_wheels = Between(*last_scan_.T_odom_robot, *scan.T_odom_robot);
  const double there = map.Agreement(*points, T_last_now, kSceneSigma);
  const double here = map.Agreement(*points, by_wheels, kSceneSigma);
  return there >= kSame && there >= here + kLeapGain;
}

bool StandstillCheck::HasChanged(const LaserScan& scan) const {
  std::size_t both = 0;
  std::size_t changed = 0;
  for (std::size_t beam = 0; beam < scan.size(); ++beam) {
    if (std::isnan(scan.ranges[beam]) || std::isnan(anchor_.ranges[beam])) continue;
    ++both;
    const bool is_same = scan.ranges[beam] == anchor_.ranges[beam] ||
                         std::abs(scan.ranges[beam] - anchor_.ranges[beam]) <= kChanged;
    changed += is_same ? 0 : 1;
  }
  return static_cast<double>(changed) > kChangedShare * static_cast<double>(both);
}

// The anchor's scene fits where scans say that the robot is, and does not where wheels left it.
bool StandstillCheck::Contradicts(const LaserScan& scan, const Pose2& T_anchor_robot) const {
  LocalMap map(options_.scans.map, Eigen::Vector2d::Zero());
  map.Add(*PointsInRobot(anchor_), Pose2{});
  const ScanPoints::ConstPtr points = PointsInRobot(scan);
  const double there = map.Agreement(*points, T_anchor_robot, kSceneSigma);
  const double here = map.Agreement(*points, Pose2{}, kSceneSigma);
  return there >= kSame && there >= here + kGain;
}

std::vector<FalseRest> StandstillCheck::Find() const {
  std::vector<FalseRest> found = found_;
  if (rest_ && IsFalse(*rest_)) found.push_back({rest_->span, rest_->leap_m});
  return found;
}

}  // namespace masked_mapper
