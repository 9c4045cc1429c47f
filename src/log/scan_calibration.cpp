// SPDX-License-Identifier: BSD-3-Clause
#include "scan_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "angle_as_meant.hpp"
#include "masked_mapper/geometry/median.hpp"
#include "masked_mapper/geometry/pose2.hpp"

namespace masked_mapper {
namespace {

constexpr std::uint64_t kScansOfFirstLook = 300;
constexpr std::size_t kPosesKept = 1000;
constexpr double kMoved = 0.5;          // m or rad: the laser's offset shows only in motion
constexpr double kLargestOffset = 5.0;  // m, of a laser on a robot
constexpr double kPlainOffset = 1.5;    // m, believed of a robot that does not move
constexpr double kOffsetSpread = 0.02;  // m and rad, of poses written with few digits
constexpr double kOffsetShare = 0.9;
constexpr double kLimitContradicted = 0.01;  // share of ranges beyond the stated limit
constexpr double kBeyondFarthest = 1.001;
constexpr double kLeastLimit = 1.0;  // m; a stated limit below is no limit
constexpr double kFullTurn = 2.0 * kPi;

double Motion(const Pose2& T_w_a, const Pose2& T_w_b) {
  return std::max(Distance(T_w_a, T_w_b), std::abs(WrapAngle(T_w_a.theta - T_w_b.theta)));
}

/// Median pose, if most poses agree with it.
std::optional<Pose2> CommonPose(const std::vector<Pose2>& poses) {
  if (poses.empty()) return std::nullopt;
  std::vector<double> x, y, theta;
  for (const Pose2& pose : poses) {
    x.push_back(pose.x);
    y.push_back(pose.y);
    theta.push_back(WrapAngle(pose.theta - poses.front().theta));
  }
  const Pose2 median{Median(x), Median(y), WrapAngle(Median(theta) + poses.front().theta)};
  const auto agreeing = std::count_if(poses.begin(), poses.end(), [&](const Pose2& pose) {
    return Motion(pose, median) <= kOffsetSpread;
  });
  if (static_cast<double>(agreeing) < kOffsetShare * static_cast<double>(poses.size())) {
    return std::nullopt;
  }
  return median;
}

/// Removes what only the digits of the log put there: an offset is known to a tenth of a
/// millimetre.
Pose2 Rounded(const Pose2& pose) {
  const auto round = [](double value) { return std::round(value * 1e4) / 1e4 + 0.0; };
  return {round(pose.x), round(pose.y), round(pose.theta)};
}

/// A resolution without a field of view is believed when it makes one that scanners have.
bool IsUsualFieldOfView(std::size_t beams, double resolution) {
  for (const double usual_deg : {90.0, 100.0, 180.0, 190.0, 220.0, 240.0, 270.0, 360.0}) {
    for (const double steps : {static_cast<double>(beams), static_cast<double>(beams) - 1.0}) {
      if (std::abs(RadToDeg(steps * resolution) - usual_deg) < 0.01 * usual_deg) return true;
    }
  }
  return false;
}

/// A scan's own limit is kept as long as nothing but "no return" lies beyond. A parameter is kept
/// when the log's word is just that number: else the word knows better (FR079: 80.99, and the
/// word 81.91).
bool WordAgrees(const RangeLimitFinder::Finding& finding, double declared, bool states_own) {
  return states_own ? finding.no_return >= 0.99 * declared
                    : std::abs(finding.far_value - declared) < 1e-3;
}

}  // namespace

BeamGeometry FlaserGeometry(std::size_t beams, double field_of_view) {
  if (beams < 2) return {0.0, field_of_view};
  const double steps = static_cast<double>(beams % 2 == 0 ? beams : beams - 1);
  return {-0.5 * field_of_view, field_of_view / steps};
}

BeamGeometry RobotLaserGeometry(const CarmenScan& scan) {
  const double steps = static_cast<double>(scan.beams) - 1.0;
  const double span = scan.field_of_view;
  const bool has_span = span > 0.0 && span <= 1.01 * kFullTurn;
  const bool step_agrees =
      has_span && std::abs(scan.angle_step * steps - span) <= 1.5 * scan.angle_step;
  double step = scan.angle_step;
  if (!step_agrees && has_span && steps > 0.0) step = span / steps;
  if (step <= 0.0 || step * steps > 1.01 * kFullTurn) return FlaserGeometry(scan.beams, kPi);
  return {AngleAsMeant(scan.start_angle), AngleAsMeant(step)};
}

BeamGeometry ScanCalibration::Geometry(const CarmenScan& scan) const {
  if (!scan.is_flaser) return RobotLaserGeometry(scan);
  if (field_of_view_ == 0.0 && resolution_ > 0.0 && IsUsualFieldOfView(scan.beams, resolution_)) {
    const double steps = static_cast<double>(scan.beams % 2 == 0 ? scan.beams : scan.beams - 1);
    return {-0.5 * steps * resolution_, resolution_};
  }
  return FlaserGeometry(scan.beams, field_of_view_ > 0.0 ? field_of_view_ : kPi);
}

LaserScan ScanCalibration::Apply(CarmenScan scan, std::uint64_t* invalid_ranges) const {
  LaserScan result;
  result.stamp = scan.stamp;
  result.log_stamp = scan.stamp;
  const BeamGeometry geometry = Geometry(scan);
  const double sense = upside_down_ ? -1.0 : 1.0;
  result.first_angle = sense * geometry.first_angle;
  result.angle_step = sense * geometry.angle_step;
  const std::size_t kind = scan.is_flaser ? 1 : 0;
  result.T_robot_laser = T_robot_laser_[kind];
  result.T_odom_robot = odometry_is_lasers_[kind]
                            ? scan.T_odom_laser * Inverse(T_robot_laser_[kind])
                            : scan.T_odom_robot;
  float no_return = no_return_;
  result.max_range = static_cast<float>(max_range_);
  if (trust_scans_own_limit_ && !scan.is_flaser && scan.maximum_range >= kLeastLimit &&
      scan.maximum_range < RangeLimitFinder::kAbsurdRange) {
    result.max_range = static_cast<float>(scan.maximum_range);
    if (scan.maximum_range != max_range_) no_return = result.max_range;
  }
  // A word for "no return" may be absurd as a distance; other absurd values are mistakes.
  const bool word_is_absurd =
      std::isfinite(no_return) && no_return >= RangeLimitFinder::kAbsurdRange;
  result.ranges = std::move(scan.ranges);
  const auto min_range = static_cast<float>(min_range_);
  const float first_odd = std::min(no_return, RangeLimitFinder::kAbsurdRange);
  for (float& range : result.ranges) {
    if (range >= min_range && range < first_odd) continue;
    const bool absurd =
        !(range >= 0.0F) || (range >= RangeLimitFinder::kAbsurdRange && std::isfinite(range) &&
                             !(word_is_absurd && range >= no_return));
    if (absurd) ++*invalid_ranges;
    range = !absurd && range >= no_return ? kNoReturn : kInvalidRange;
  }
  return result;
}

void CalibrationFinder::Add(const CarmenScan& scan) {
  ++scans_;
  const std::size_t kind = scan.is_flaser ? 1 : 0;
  if (last_stamp_[1 - kind] == scan.stamp) ++twins_;
  last_stamp_[kind] = scan.stamp;
  if (!scan.is_flaser) scan_limit_ = std::max(scan_limit_, scan.maximum_range);
  Poses& poses = poses_[kind];
  if (!poses.first_robot) {
    poses.first_robot = scan.T_odom_robot;
    poses.first_laser = scan.T_odom_laser;
  }
  poses.robot_moved = std::max(poses.robot_moved, Motion(*poses.first_robot, scan.T_odom_robot));
  poses.laser_moved = std::max(poses.laser_moved, Motion(*poses.first_laser, scan.T_odom_laser));
  if (poses.T_robot_laser.size() < kPosesKept) {
    poses.T_robot_laser.push_back(Between(scan.T_odom_robot, scan.T_odom_laser));
  }
  const double step = scan.is_flaser ? FlaserGeometry(scan.beams, kPi).angle_step
                                     : RobotLaserGeometry(scan).angle_step;
  ranges_.Add(scan.ranges, step, scan.T_odom_robot);
}

void CalibrationFinder::Add(const CarmenParam& param) {
  const char* cursor = param.value.data();
  const std::optional<double> number = ParseNumber(cursor, cursor + param.value.size());
  if (!number || !std::isfinite(*number)) return;
  const double value = *number;
  const bool is_angle_deg = value > 0.0 && value <= 360.0;
  const bool is_offset = std::abs(value) <= kLargestOffset;
  if (param.name == "robot_frontlaser_offset" && is_offset) {
    param_T_robot_laser_.x = value;
  } else if (param.name == "robot_frontlaser_side_offset" && is_offset) {
    param_T_robot_laser_.y = value;
  } else if (param.name == "robot_frontlaser_angular_offset" && std::abs(value) <= kPi + 0.01) {
    param_T_robot_laser_.theta = WrapAngle(value);
  } else if (param.name == "robot_front_laser_max" || param.name == "robot_frontlaser_max") {
    param_limit_ = value;
  } else if (param.name == "laser_front_laser_resolution" && is_angle_deg) {
    param_resolution_ = DegToRad(value);
  } else if (param.name == "laser_front_laser_fov" && is_angle_deg) {
    param_field_of_view_ = DegToRad(value);
  }
}

std::optional<double> CalibrationFinder::DeclaredLimit() const {
  const double limit = scan_limit_ > 0.0 ? scan_limit_ : param_limit_;
  if (limit < kLeastLimit || limit >= RangeLimitFinder::kAbsurdRange) return std::nullopt;
  if (ranges_.ShareBeyond(limit * kBeyondFarthest) > kLimitContradicted) return std::nullopt;
  return limit;
}

bool CalibrationFinder::IsSettled() const {
  if (scans_ < kScansOfFirstLook || scans_ % 100 != 0) return false;
  if (options_.max_range > 0.0 || DeclaredLimit()) return true;
  const std::optional<RangeLimitFinder::Finding> finding = ranges_.Find();
  return finding && finding->from_places;
}

Pose2 CalibrationFinder::LaserOnRobot(const Poses& poses) const {
  if (options_.laser_x != 0.0 || options_.laser_y != 0.0 || options_.laser_theta_deg != 0.0) {
    return {options_.laser_x, options_.laser_y, WrapAngle(DegToRad(options_.laser_theta_deg))};
  }
  const std::optional<Pose2> common = CommonPose(poses.T_robot_laser);
  if (!common) return param_T_robot_laser_;
  const double offset = common->Translation().norm();
  const bool believed = offset <= (poses.robot_moved > kMoved ? kLargestOffset : kPlainOffset);
  return believed ? Rounded(*common) : param_T_robot_laser_;
}

ScanCalibration CalibrationFinder::Find() const {
  ScanCalibration result;
  result.min_range_ = options_.min_range;
  result.upside_down_ = options_.upside_down;
  result.flaser_is_twin_ = 2 * twins_ > scans_ / 2;
  result.field_of_view_ = options_.field_of_view_deg > 0.0 ? DegToRad(options_.field_of_view_deg)
                                                           : param_field_of_view_;
  result.resolution_ = param_resolution_;
  for (std::size_t kind = 0; kind < 2; ++kind) {
    const Poses& poses = poses_[kind];
    result.T_robot_laser_[kind] = LaserOnRobot(poses);
    result.odometry_is_lasers_[kind] = poses.robot_moved == 0.0 && poses.laser_moved > kMoved;
  }
  const std::optional<RangeLimitFinder::Finding> finding = ranges_.Find();
  const std::optional<double> declared = DeclaredLimit();
  const bool states_own = scan_limit_ > 0.0;
  if (options_.max_range > 0.0) {
    result.max_range_ = options_.max_range;
    result.no_return_ = static_cast<float>(options_.max_range);
  } else if (declared && (!finding || WordAgrees(*finding, *declared, states_own))) {
    result.max_range_ = *declared;
    result.no_return_ = static_cast<float>(*declared);
    if (finding && finding->far_value < *declared) result.no_return_ = finding->no_return;
    result.trust_scans_own_limit_ = states_own;
  } else if (finding && finding->far_value < RangeLimitFinder::kAbsurdRange) {
    result.max_range_ = finding->far_value;
    result.no_return_ = finding->no_return;
  } else {
    // No such word, or one that is no distance: the farthest return tells how far the scanner
    // reaches.
    const double farthest = std::max<double>(ranges_.Farthest(), kLeastLimit);
    result.max_range_ = farthest * kBeyondFarthest;
    result.no_return_ = finding ? finding->no_return : std::numeric_limits<float>::infinity();
  }
  return result;
}

}  // namespace masked_mapper
