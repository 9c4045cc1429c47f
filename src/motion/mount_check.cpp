// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/wheel_check.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "masked_mapper/text/number_text.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kLeastTurns = 12;  // stretches below which nothing is said
constexpr std::size_t kLeastStraights = 12;
constexpr double kTurn = 6.0;          // deg of a stretch by wheels that make it a turn
constexpr double kStraight = 3.0;      // deg up to which it is straight
constexpr double kLength = 0.15;       // m of a straight stretch
constexpr double kLeastYaw = 5.0;      // deg; less is left to the map, which bears it
constexpr double kLeastOffset = 0.15;  // m; the same

double Askew(const Pose2& by_wheels, const Pose2& by_scans) {
  return WrapAngle(std::atan2(by_scans.y, by_scans.x) - std::atan2(by_wheels.y, by_wheels.x));
}

/// The stretches that tell of a mount.
struct Ways {
  std::vector<StretchPair> turns;
  std::vector<StretchPair> straights;
};

Ways Sorted(const std::vector<StretchPair>& stretches) {
  Ways ways;
  for (const StretchPair& stretch : stretches) {
    const double travel = std::hypot(stretch.by_wheels.x, stretch.by_wheels.y);
    const double turn = RadToDeg(std::abs(stretch.by_wheels.theta));
    // Scans that lost track say nothing; half a turn between two scans has no sign.
    if (std::hypot(stretch.by_scans.x, stretch.by_scans.y) > 2.0 * travel + 0.5 || turn > 90.0) {
      continue;
    }
    if (turn >= kTurn) ways.turns.push_back(stretch);
    if (turn <= kStraight && travel >= kLength) ways.straights.push_back(stretch);
  }
  return ways;
}

bool IsUpsideDown(const std::vector<StretchPair>& turns) {
  std::size_t against = 0;
  std::size_t along = 0;
  for (const StretchPair& turn : turns) {
    const double ratio = turn.by_scans.theta / turn.by_wheels.theta;
    against += ratio < -0.3 && ratio > -3.0;
    along += ratio > 0.3 && ratio < 3.0;
  }
  return against >= kLeastTurns && against >= 4 * along;
}

// With R the yaw of the fault, scans see every straight turned by -R.
double Yaw(const std::vector<StretchPair>& straights) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const StretchPair& straight : straights) {
    const double askew = Askew(straight.by_wheels, straight.by_scans);
    sum += Eigen::Vector2d(std::cos(askew), std::sin(askew));
  }
  const double mean = std::atan2(sum.y(), sum.x());
  const auto agreeing =
      std::count_if(straights.begin(), straights.end(), [&](const StretchPair& straight) {
        return std::abs(WrapAngle(Askew(straight.by_wheels, straight.by_scans) - mean)) <
               DegToRad(kLeastYaw);
      });
  const bool is_clear = straights.size() >= kLeastStraights &&
                        static_cast<double>(agreeing) > 0.7 * static_cast<double>(straights.size());
  return is_clear && std::abs(mean) > DegToRad(kLeastYaw) ? -mean : 0.0;
}

// Seen from a scanner that sits e off its place, a turn R moves the robot by (R - 1) e more.
Eigen::Vector2d Offset(const std::vector<StretchPair>& turns) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double before = 0.0;
  for (const StretchPair& turn : turns) {
    const double c = std::cos(turn.by_scans.theta);
    const double s = std::sin(turn.by_scans.theta);
    Eigen::Matrix2d lever;
    lever << c - 1.0, -s, s, c - 1.0;
    const Eigen::Vector2d more = turn.by_scans.Translation() - turn.by_wheels.Translation();
    normal += lever.transpose() * lever;
    right += lever.transpose() * more;
    before += more.squaredNorm();
  }
  if (turns.size() < kLeastTurns) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d offset = normal.ldlt().solve(right);
  const double after = before - right.dot(offset);  // squares left, of least squares
  const bool is_clear = offset.allFinite() && after < 0.4 * before;
  return is_clear && offset.norm() > kLeastOffset ? offset : Eigen::Vector2d(0.0, 0.0);
}

}  // namespace

MountFault FindMountFault(const std::vector<StretchPair>& stretches) {
  const Ways ways = Sorted(stretches);
  MountFault fault;
  fault.upside_down = IsUpsideDown(ways.turns);
  if (fault.upside_down) return fault;
  fault.yaw = Yaw(ways.straights);
  if (fault.yaw == 0.0) fault.offset = Offset(ways.turns);
  return fault;
}

std::string WarningOf(const MountFault& fault, const Pose2& T_robot_laser) {
  if (fault.IsNone()) return {};
  if (fault.upside_down) {
    return "scans turn the other way than the wheels: the scanner seems to be mounted upside down "
           "(--set log.upside_down=true, or false if it is set)";
  }
  const double yaw_deg = RadToDeg(WrapAngle(T_robot_laser.theta + fault.yaw));
  const Eigen::Vector2d place = T_robot_laser.Translation() + fault.offset;
  return std::string("wheels and scans agree best with the scanner ") +
         (fault.yaw != 0.0 ? "looking elsewhere" : "sitting elsewhere") +
         " than the log says (--set log.laser_x=" + FixedText(place.x(), 2) +
         " --set log.laser_y=" + FixedText(place.y(), 2) +
         " --set log.laser_theta_deg=" + FixedText(yaw_deg, 1) + ")";
}

}  // namespace masked_mapper
