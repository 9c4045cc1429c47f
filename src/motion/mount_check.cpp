// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/mount_check.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kMostScans = 1000;
constexpr std::size_t kEnough = 40;      // stretches of a kind after which no more are needed
constexpr std::size_t kLeastTurns = 12;  // stretches below which nothing is said
constexpr std::size_t kLeastStraights = 20;
constexpr double kTurn = 6.0;          // deg of a stretch by wheels that make it a turn
constexpr double kStraight = 3.0;      // deg up to which it is straight
constexpr double kLength = 0.15;       // m of a straight stretch
constexpr double kLeastYaw = 5.0;      // deg; less is left to the map, which bears it
constexpr double kLeastOffset = 0.15;  // m; the same

MotionOptions ScansAlone(MotionOptions options) {
  options.source = MotionSource::kScans;
  return options;
}

double Askew(const Pose2& by_wheels, const Pose2& by_scans) {
  return WrapAngle(std::atan2(by_scans.y, by_scans.x) - std::atan2(by_wheels.y, by_wheels.x));
}

}  // namespace

MountCheck::MountCheck(const MotionOptions& options) : scans_(ScansAlone(options)) {}

bool MountCheck::IsSettled() const {
  return observed_ >= kMostScans || (turns_.size() >= kEnough && straights_.size() >= kEnough);
}

void MountCheck::Observe(const LaserScan& scan) {
  if (!scan.T_odom_robot) return;
  ++observed_;
  T_robot_laser_ = scan.T_robot_laser;
  scans_.Observe(scan);
  if (!begin_) {
    begin_ = Stretch{*scan.T_odom_robot, scans_.T_odom_robot()};
    return;
  }
  const Stretch stretch{Between(begin_->by_wheels, *scan.T_odom_robot),
                        Between(begin_->by_scans, scans_.T_odom_robot())};
  const double travel = std::hypot(stretch.by_wheels.x, stretch.by_wheels.y);
  const double turn = RadToDeg(std::abs(stretch.by_wheels.theta));
  if (travel < kLength && turn < kTurn) return;
  begin_ = Stretch{*scan.T_odom_robot, scans_.T_odom_robot()};
  // Scans that lost track say nothing; half a turn between two scans has no sign.
  if (std::hypot(stretch.by_scans.x, stretch.by_scans.y) > 2.0 * travel + 0.5 || turn > 90.0)
    return;
  if (turn >= kTurn && turns_.size() < kEnough) turns_.push_back(stretch);
  if (turn <= kStraight && straights_.size() < kEnough) straights_.push_back(stretch);
}

bool MountCheck::IsUpsideDown() const {
  std::size_t against = 0;
  std::size_t along = 0;
  for (const Stretch& turn : turns_) {
    const double ratio = turn.by_scans.theta / turn.by_wheels.theta;
    against += ratio < -0.3 && ratio > -3.0;
    along += ratio > 0.3 && ratio < 3.0;
  }
  return against >= kLeastTurns && against >= 4 * along;
}

// With R the yaw of the fault, scans see every straight turned by -R.
double MountCheck::Yaw() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Stretch& straight : straights_) {
    const double askew = Askew(straight.by_wheels, straight.by_scans);
    sum += Eigen::Vector2d(std::cos(askew), std::sin(askew));
  }
  const double mean = std::atan2(sum.y(), sum.x());
  const auto agreeing =
      std::count_if(straights_.begin(), straights_.end(), [&](const Stretch& straight) {
        return std::abs(WrapAngle(Askew(straight.by_wheels, straight.by_scans) - mean)) <
               DegToRad(kLeastYaw);
      });
  const bool is_clear =
      straights_.size() >= kLeastStraights &&
      static_cast<double>(agreeing) > 0.7 * static_cast<double>(straights_.size());
  return is_clear && std::abs(mean) > DegToRad(kLeastYaw) ? -mean : 0.0;
}

// Seen from a scanner that sits e off its place, a turn R moves the robot by (R - 1) e more.
Eigen::Vector2d MountCheck::Offset() const {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double before = 0.0;
  for (const Stretch& turn : turns_) {
    const double c = std::cos(turn.by_scans.theta);
    const double s = std::sin(turn.by_scans.theta);
    Eigen::Matrix2d lever;
    lever << c - 1.0, -s, s, c - 1.0;
    const Eigen::Vector2d more = turn.by_scans.Translation() - turn.by_wheels.Translation();
    normal += lever.transpose() * lever;
    right += lever.transpose() * more;
    before += more.squaredNorm();
  }
  if (turns_.size() < kLeastTurns) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d offset = normal.ldlt().solve(right);
  const double after = before - right.dot(offset);  // squares left, of least squares
  const bool is_clear = offset.allFinite() && after < 0.4 * before;
  return is_clear && offset.norm() > kLeastOffset ? offset : Eigen::Vector2d(0.0, 0.0);
}

MountFault MountCheck::Find() const {
  MountFault fault;
  fault.upside_down = IsUpsideDown();
  if (fault.upside_down) return fault;
  fault.yaw = Yaw();
  if (fault.yaw == 0.0) fault.offset = Offset();
  return fault;
}

std::string MountCheck::Warning() const {
  const MountFault fault = Find();
  if (fault.IsNone()) return {};
  if (fault.upside_down) {
    return "scans turn the other way than the wheels: the scanner seems to be mounted upside down "
           "(--set log.upside_down=true, or false if it is set)";
  }
  const double yaw_deg = RadToDeg(WrapAngle(T_robot_laser_.theta + fault.yaw));
  const Eigen::Vector2d place = T_robot_laser_.Translation() + fault.offset;
  return std::string("wheels and scans agree best with the scanner ") +
         (fault.yaw != 0.0 ? "looking elsewhere" : "sitting elsewhere") +
         " than the log says (--set log.laser_x=" + FixedText(place.x(), 2) +
         " --set log.laser_y=" + FixedText(place.y(), 2) +
         " --set log.laser_theta_deg=" + FixedText(yaw_deg, 1) + ")";
}

}  // namespace masked_mapper
