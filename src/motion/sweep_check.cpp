// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/sweep_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "masked_mapper/geometry/median.hpp"
#include "masked_mapper/scan_matching/for_each.hpp"
#include "masked_mapper/scan_matching/local_map.hpp"
#include "masked_mapper/text/number_text.hpp"
#include "straightened_scan.hpp"

namespace masked_mapper {
namespace {

constexpr std::size_t kMostPairs = 24;
constexpr std::size_t kLeastPairs = 8;
constexpr std::size_t kMostWithoutWheels = 800;  // scans that are aligned to find how they moved
constexpr std::size_t kMostStated = 1000;        // scans that are asked for what the log states
constexpr double kTogether = 3.0;                // s, between the scans of a pair
constexpr double kNear = 0.7;                    // m, the same
constexpr double kTurned = 40.0;                 // deg, the same
constexpr double kApart = 1.5;                   // s, from pair to pair: one of each turn
constexpr double kLeastBent = 0.02;              // rad over a period, between the scans of a pair
constexpr double kReach = 12.0;                  // m, of what is compared
constexpr std::size_t kMostPoints = 250;         // of a scan
constexpr double kTurn = 2.0 * kPi;              // rad
constexpr double kFitSigma = 0.03;               // m

// Sweeps that are tried, in parts of a turn within the period of the scans.
constexpr int kTried = 4;  // to each side
constexpr double kTriedStep = 0.3;

constexpr double kSigmas = 4.0;  // that overrule what the log states
// Of a turn in the period: scanners turn once in it. Less bends walls little, and is what scans
// alone make of a motion that they know late.
constexpr double kMaterial = 0.4;

std::string TurnText(double seconds_per_rad) { return FixedText(seconds_per_rad * kTurn, 3); }

/// Every so many points, all along the sweep.
ScanPoints Thinned(const ScanPoints& points) {
  ScanPoints thinned;
  const std::size_t stride = 1 + points.size() / kMostPoints;
  for (std::size_t i = 0; i < points.size(); i += stride) thinned.push_back(points[i]);
  return thinned;
}

/// Whether the robot seems to move as none does: the odometry froze and came back, or was matched
/// wrongly.
bool Leaps(const Pose2& step_before, const Pose2& step) {
  constexpr double kLeap = 0.15;  // m or rad; of 0.2 s, to speed up by 3.75 m/s^2
  return (step.AsVector() - step_before.AsVector()).cwiseAbs().maxCoeff() > kLeap;
}

/// Of a turn, what lasts over two steps: a pose that is off makes two that undo each other.
double Lasting(double turn_before, double turn) {
  if (turn_before * turn <= 0.0) return 0.0;
  return std::abs(turn_before) < std::abs(turn) ? turn_before : turn;
}

/// Where a parabola through the largest and its neighbours has its top, in indices; empty when the
/// largest is at an end.
std::optional<double> Top(const std::vector<double>& values) {
  const auto largest = std::max_element(values.begin(), values.end()) - values.begin();
  const auto i = static_cast<std::size_t>(largest);
  if (i == 0 || i + 1 == values.size()) return std::nullopt;
  const double bend = values[i - 1] - 2.0 * values[i] + values[i + 1];
  if (!(bend < 0.0)) return std::nullopt;
  return static_cast<double>(i) + 0.5 * (values[i - 1] - values[i + 1]) / bend;
}

}  // namespace

SweepCheck::SweepCheck(const MotionOptions& options) : scans_alone_(ScansAlone(options)) {}

void SweepCheck::Observe(const LaserScan& scan) {
  if (scan.ranges.empty() || scan.angle_step == 0.0) return;
  if (stated_.empty()) first_stamp_ = scan.stamp;
  last_stamp_ = scan.stamp;
  if (stated_.size() < kMostStated) {
    stated_.push_back(static_cast<float>(scan.beam_time / std::abs(scan.angle_step)));
  }
  const bool has_wheels = scan.T_odom_robot.has_value();
  const bool is_enough = pairs_.size() >= kMostPairs || without_wheels_ >= kMostWithoutWheels;
  if (!has_wheels && is_enough) return;
  without_wheels_ += has_wheels ? 0 : 1;
  Seen seen{std::make_shared<const LaserScan>(scan), has_wheels ? *scan.T_odom_robot : Pose2{},
            Pose2{}, 0.0};
  if (!has_wheels) {
    scans_alone_.Observe(Timed(scan, 0.0));  // nobody knows yet whether what is stated is right
    seen.T_odom_robot = scans_alone_.T_odom_robot();
  }
  if (last_ && last_->scan->T_odom_robot.has_value() == has_wheels) {
    last_->seconds = scan.stamp - last_->scan->stamp;
    last_->T_now_next = Between(last_->T_odom_robot, seen.T_odom_robot);
    if (periods_.size() < kMostStated) {
      periods_.push_back(static_cast<float>(last_->seconds));
    }
    last_->lasting_rad = Lasting(step_before_.theta, last_->T_now_next.theta);
    if (last_->seconds > 0.0 && !Leaps(step_before_, last_->T_now_next)) Enter(*last_);
    step_before_ = last_->T_now_next;
  } else {
    recent_.clear();
  }
  last_ = std::move(seen);
}

void SweepCheck::Enter(const Seen& seen) {
  while (!recent_.empty() && recent_.front().scan->stamp < seen.scan->stamp - kTogether) {
    recent_.pop_front();
  }
  const Seen* other = nullptr;
  double most = kLeastBent / std::max(seen.seconds, 1e-3);
  for (const Seen& before : recent_) {
    const Pose2 moved = Between(before.T_odom_robot, seen.T_odom_robot);
    const double bent = BentApart(before, seen);
    if (bent <= most || moved.Translation().norm() > kNear ||
        std::abs(moved.theta) > DegToRad(kTurned)) {
      continue;
    }
    most = bent;
    other = &before;
  }
  if (other != nullptr) Keep({*other, seen, most});
  recent_.push_back(seen);
}

/// How differently a motion bends two scans, rad/s, as far as it is sure.
double SweepCheck::BentApart(const Seen& a, const Seen& b) {
  return std::min(std::abs(a.T_now_next.theta / a.seconds - b.T_now_next.theta / b.seconds),
                  std::abs(a.lasting_rad / a.seconds - b.lasting_rad / b.seconds));
}

void SweepCheck::Keep(Pair pair) {
  const bool same_turn =
      !pairs_.empty() && pair.second.scan->stamp - pairs_.back().second.scan->stamp < kApart;
  if (same_turn) {
    if (pair.bent_rad_per_s > pairs_.back().bent_rad_per_s) pairs_.back() = std::move(pair);
    return;
  }
  pairs_.push_back(std::move(pair));
  if (pairs_.size() <= kMostPairs) return;
  pairs_.erase(std::min_element(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return a.bent_rad_per_s < b.bent_rad_per_s;
  }));
}

/// A turn of the scanner within the period of its scans.
double SweepCheck::LongestSweep() const { return Median(periods_) / kTurn; }

double SweepCheck::Stated() const {
  const double stated = Median(stated_);
  return stated > 0.0 && stated <= 1.1 * LongestSweep() ? stated : 0.0;
}

/// How well the scans of a pair fit, for each sweep that is tried.
std::vector<double> SweepCheck::Fits(const Pair& pair) const {
  LocalMapOptions options;
  options.reach_m = kReach;
  const Pose2 T_first_second = Between(pair.first.T_odom_robot, pair.second.T_odom_robot);
  Eigen::Matrix3d prior = Eigen::Matrix3d::Zero();
  prior.diagonal() << 100.0, 100.0, 130.0;  // of 0.1 m and 5 deg
  std::vector<double> fits;
  for (int i = -kTried; i <= kTried; ++i) {
    const double seconds_per_rad = kTriedStep * i * LongestSweep();
    const auto points = [&](const Seen& seen) {
      return Thinned(*PointsInRobot(Straightened(Timed(*seen.scan, seconds_per_rad),
                                                 SteadyMotion(seen.T_now_next, seen.seconds))));
    };
    LocalMap map(options, Eigen::Vector2d::Zero());
    map.Add(points(pair.first), Pose2{});
    const ScanPoints second = points(pair.second);
    const Alignment aligned = map.Align(second, T_first_second, prior);
    fits.push_back(map.Agreement(second, aligned.T_map_robot, kFitSigma));
  }
  return fits;
}

std::optional<SweepEstimate> SweepCheck::Measured(int threads) const {
  if (pairs_.size() < kLeastPairs) return std::nullopt;
  std::vector<std::vector<double>> fits(pairs_.size());
  ForEach(pairs_.size(), threads, [&](std::size_t pair) { fits[pair] = Fits(pairs_[pair]); });
  std::vector<double> sum(2 * kTried + 1, 0.0);
  for (const std::vector<double>& of_pair : fits) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += of_pair[i];
  }
  const std::optional<double> top = Top(sum);
  if (!top) return std::nullopt;
  double squares = 0.0;  // of the top without one pair (jackknife)
  for (const std::vector<double>& one : fits) {
    std::vector<double> others = sum;
    for (std::size_t i = 0; i < sum.size(); ++i) others[i] -= one[i];
    const double off = Top(others).value_or(*top + kTried) - *top;
    squares += off * off;
  }
  const auto count = static_cast<double>(fits.size());
  const double unit = kTriedStep * LongestSweep();
  return SweepEstimate{(*top - kTried) * unit, std::sqrt(squares * (count - 1.0) / count) * unit};
}

SweepCheck::Verdict SweepCheck::Find(int threads) const {
  const double stated = Stated();
  const std::optional<SweepEstimate> measured = Measured(threads);
  if (!measured) return {stated, Finding(stated, std::nullopt)};
  const double longest = LongestSweep();
  const auto off = [&](double seconds_per_rad) {
    return std::abs(measured->seconds_per_rad - seconds_per_rad);
  };
  const double tolerance = std::max(kSigmas * measured->sigma, kMaterial * longest);
  if (off(stated) <= tolerance) return {stated, Finding(stated, measured)};
  // Better known than measured, where it is one of these.
  double best = measured->seconds_per_rad;
  double least = tolerance;
  for (const double exact : {0.0, -stated, longest, -longest}) {
    const bool is_guess = std::abs(exact) == longest;
    if (off(exact) > (is_guess ? 2.0 * measured->sigma : least)) continue;
    least = off(exact);
    best = exact;
  }
  return {best, Finding(best, measured)};
}

/// Of a sweep that is used, where it is not the one that the log states.
std::optional<SensorFinding> SweepCheck::Finding(
    double used, const std::optional<SweepEstimate>& measured) const {
  const double stated = Median(stated_);
  if (used == stated) return std::nullopt;
  SensorFinding finding;
  finding.what = "turn of the scanner, s";
  if (stated != 0.0) finding.what += ", " + TurnText(stated) + " by time_increment";
  finding.t_a = first_stamp_;
  finding.t_b = last_stamp_;
  if (measured) {
    finding.value = measured->seconds_per_rad * kTurn;
    finding.sigma = measured->sigma * kTurn;
    finding.what += ", " + TurnText(measured->seconds_per_rad) + " by what turns bend";
  }
  finding.consequence = "scans fit best as they come, and are not straightened";
  if (used != 0.0) {
    finding.consequence = "scans are straightened for " + TurnText(std::abs(used)) +
                          (used < 0.0 ? ", the last beam first" : "");
  } else if (!measured) {
    finding.consequence = "that cannot be, so scans are taken as they come";
  }
  return finding;
}

}  // namespace masked_mapper
