// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "masked_mapper/geometry/median.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "turn_fit.hpp"

namespace masked_mapper {
namespace {

using Stretch = WheelCheck::Stretch;
using WheelPose = WheelCheck::WheelPose;

constexpr double kMostAhead = 8.0;   // s, of the clocks in question
constexpr double kClockStep = 0.02;  // s
// Less is what drivers and buses take, and what matching forgives: 0.2 s are 9 degrees where a
// robot turns at 45 degrees a second.
constexpr double kLeastAhead = 0.2;    // s
constexpr double kApart = 1.0;         // s between clocks that are not the same
constexpr double kLongestGap = 2.0;    // s without wheels, across which nothing is read
constexpr double kLeastTurning = 2.5;  // rad of turning by scans below which nothing is said
constexpr std::size_t kFewest = 12;    // stretches, the same
constexpr double kStraight = 8.0;      // deg up to which a stretch tells of the way
constexpr double kWay = 0.2;           // m of a stretch that tells of the way
constexpr double kSureOfWay = 0.1;     // of the way, sigma
// Smaller faults are part of the noise that wheels are given. In turns real wheels also lag behind
// the scans, and seem by up to a fifth to tell of too much or too little.
constexpr double kLeastFault = 0.1;
constexpr double kLeastTurnFault = 0.25;
constexpr double kSure = 4.0;      // sigmas
constexpr double kFitting = 0.25;  // of the squares of the turns may be left where wheels tell them
constexpr double kMirrored = -0.3;  // of turns: the scanner hangs (FindMountFault)
constexpr double kDead = 0.05;      // of the way is told by wheels that tell nothing
constexpr double kUseless = 0.6;    // at the best clock: the wheels tell of other turns

/// Where the wheels were at any stamp.
class Wheels {
 public:
  explicit Wheels(const std::vector<WheelPose>& poses) : poses_(poses) {}

  std::optional<WheelPose> At(double stamp) const { return At(stamp, IndexBehind(stamp)); }

  /// Of the first pose not before a stamp.
  std::size_t IndexBehind(double stamp) const {
    const auto behind =
        std::lower_bound(poses_.begin(), poses_.end(), stamp,
                         [](const WheelPose& pose, double value) { return pose.stamp < value; });
    return static_cast<std::size_t>(behind - poses_.begin());
  }

  /// The same of the heading alone, looked for from `near` on, which becomes the pose behind it: it
  /// is a few poses away from what it was for a stamp nearby.
  std::optional<double> HeadingAt(double stamp, std::size_t* near) const {
    while (*near > 0 && poses_[*near - 1].stamp >= stamp) --*near;
    while (*near < poses_.size() && poses_[*near].stamp < stamp) ++*near;
    const std::optional<double> fraction = FractionAt(stamp, *near);
    if (!fraction) return std::nullopt;
    if (*fraction == 1.0) return poses_[*near].heading_rad;
    const double before_rad = poses_[*near - 1].heading_rad;
    return before_rad + *fraction * (poses_[*near].heading_rad - before_rad);
  }

 private:
  /// Of the way from the pose before to the one behind a stamp; 1: at that one.
  std::optional<double> FractionAt(double stamp, std::size_t after) const {
    if (after == poses_.size()) return std::nullopt;
    if (poses_[after].stamp == stamp) return 1.0;
    if (after == 0) return std::nullopt;
    const double between = poses_[after].stamp - poses_[after - 1].stamp;
    if (between > kLongestGap) return std::nullopt;
    return (stamp - poses_[after - 1].stamp) / between;
  }

  std::optional<WheelPose> At(double stamp, std::size_t after) const {
    const std::optional<double> fraction = FractionAt(stamp, after);
    if (!fraction) return std::nullopt;
    if (*fraction == 1.0) return poses_[after];
    const WheelPose& a = poses_[after - 1];
    const WheelPose& b = poses_[after];
    return WheelPose{stamp,
                     a.position_in_odom + *fraction * (b.position_in_odom - a.position_in_odom),
                     a.heading_rad + *fraction * (b.heading_rad - a.heading_rad)};
  }

  const std::vector<WheelPose>& poses_;
};

double Way(const Pose2& motion) { return std::hypot(motion.x, motion.y); }

std::vector<StretchPair> Paired(const std::vector<Stretch>& stretches, const Wheels& wheels,
                                double ahead_s) {
  std::vector<StretchPair> pairs;
  for (const Stretch& stretch : stretches) {
    const std::optional<WheelPose> a = wheels.At(stretch.span.start - ahead_s);
    const std::optional<WheelPose> b = wheels.At(stretch.span.end - ahead_s);
    if (!a || !b) continue;
    Pose2 by_wheels = Between({a->position_in_odom.x(), a->position_in_odom.y(), a->heading_rad},
                              {b->position_in_odom.x(), b->position_in_odom.y(), 0.0});
    by_wheels.theta = b->heading_rad - a->heading_rad;
    pairs.push_back({by_wheels, stretch.by_scans, stretch.way_sigma_m});
  }
  return pairs;
}

std::vector<TurnPair> TurnsOf(const std::vector<StretchPair>& pairs) {
  std::vector<TurnPair> turns;
  turns.reserve(pairs.size());
  for (const StretchPair& pair : pairs) {
    turns.push_back({pair.by_wheels.theta, pair.by_scans.theta});
  }
  return turns;
}

/// The turns of all stretches by one clock after the other.
class TurnsByClock {
 public:
  TurnsByClock(const std::vector<Stretch>& stretches, const Wheels& wheels)
      : stretches_(stretches), wheels_(wheels) {
    near_.reserve(stretches.size());
    for (const Stretch& stretch : stretches) {
      near_.emplace_back(wheels.IndexBehind(stretch.span.start),
                         wheels.IndexBehind(stretch.span.end));
    }
  }

  const std::vector<TurnPair>& At(double ahead_s) {
    turns_.clear();
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      const Stretch& stretch = stretches_[i];
      const std::optional<double> a =
          wheels_.HeadingAt(stretch.span.start - ahead_s, &near_[i].first);
      const std::optional<double> b =
          wheels_.HeadingAt(stretch.span.end - ahead_s, &near_[i].second);
      if (a && b) turns_.push_back({*b - *a, stretch.by_scans.theta});
    }
    return turns_;
  }

 private:
  const std::vector<Stretch>& stretches_;
  const Wheels& wheels_;
  std::vector<std::pair<std::size_t, std::size_t>> near_;  ///< poses of the wheels, of each stretch
  std::vector<TurnPair> turns_;
};

/// The clock at which turns by wheels leave least of those by scans.
std::optional<Estimated> FindClock(const std::vector<Stretch>& stretches, const Wheels& wheels) {
  TurnsByClock by_clock(stretches, wheels);
  const std::vector<TurnPair> as_stamped = by_clock.At(0.0);
  const double at_zero = FitTurns(as_stamped).left;
  // Nothing is left that another clock could explain.
  const double noise = DegToRad(kTurnSigmaDeg) * DegToRad(kTurnSigmaDeg);
  if (!as_stamped.empty() && at_zero < noise) return std::nullopt;
  if (Turning(as_stamped) < kLeastTurning) return std::nullopt;
  Estimated best{0.0, 0.0};
  double least = at_zero;
  std::size_t count = as_stamped.size();
  const int steps = static_cast<int>(kMostAhead / kClockStep);
  std::vector<double> left(static_cast<std::size_t>(2 * steps + 1), at_zero);
  const auto left_at = [&left](int step) -> double& {
    const int place = step + steps;
    return left[static_cast<std::size_t>(place)];
  };
  for (int i = -steps; i <= steps; ++i) {
    const std::vector<TurnPair>& pairs = by_clock.At(kClockStep * i);
    if (pairs.size() < kFewest || 2 * pairs.size() < stretches.size()) continue;
    const TurnFit fit = FitTurns(pairs);
    left_at(i) = fit.left;
    if (fit.factor <= 0.0 || fit.left >= least) continue;
    if (fit.left > kFitting * fit.without) continue;
    least = fit.left;
    best.value = kClockStep * i;
    count = pairs.size();
  }
  if (std::abs(best.value) < kLeastAhead) return std::nullopt;
  // So much better that chance is out of the question: what is left at zero is no noise of theirs.
  if (at_zero < 3.0 * least + noise) return std::nullopt;
  // A robot that does the same again and again fits itself at several clocks.
  for (int i = -steps; i <= steps; ++i) {
    const bool is_apart = std::abs(kClockStep * i - best.value) > kApart;
    if (is_apart && left_at(i) < 2.0 * least + noise) return std::nullopt;
  }
  // The curvature of the sum of squares about its minimum.
  const auto at = static_cast<std::size_t>(std::lround(best.value / kClockStep) + steps);
  if (at > 4 && at + 5 < left.size()) {
    const double width = 5.0 * kClockStep;
    const double curvature =
        (left[at - 5] + left[at + 5] - 2.0 * least) / (width * width) * static_cast<double>(count);
    if (curvature > 0.0) best.sigma = std::sqrt(2.0 * std::max(least, 1e-6) / curvature);
  }
  return best;
}

/// The middle of what wheels tell of each stretch, over what scans do; a dead wheel makes it 0.
Estimated Middle(const std::vector<double>& ratios) {
  Estimated middle;
  middle.value = Median(ratios);
  std::vector<double> deviations;
  deviations.reserve(ratios.size());
  for (const double ratio : ratios) deviations.push_back(std::abs(ratio - middle.value));
  // Of a median, from the median deviation.
  middle.sigma = 1.25 * 1.48 * Median(deviations) / std::sqrt(static_cast<double>(ratios.size()));
  return middle;
}

/// A factor where it is surely other than one by more than the wheels' noise.
std::optional<Estimated> IfSurely(const Estimated& factor, double least_fault) {
  const double off = std::abs(factor.value - 1.0);
  if (off <= least_fault || off <= kSure * factor.sigma) return std::nullopt;
  return factor;
}

void JudgeTurns(const std::vector<TurnPair>& pairs, WheelFault* fault) {
  if (pairs.size() < kFewest || Turning(pairs) < kLeastTurning) return;
  const TurnFit fit = FitTurns(pairs);
  const double noise = DegToRad(kTurnSigmaDeg) * DegToRad(kTurnSigmaDeg);
  if (fit.left > std::max(kUseless * fit.without, 4.0 * noise) && fit.as_told >= fit.left) {
    fault->turns_useless = fit.factor > kMirrored;
    return;
  }
  if (fit.factor <= 0.0 || fit.left > kFitting * fit.without) return;
  fault->turn_factor = IfSurely(FineFactor(pairs, fit.factor), kLeastTurnFault);
}

void JudgeWay(const std::vector<StretchPair>& pairs, WheelFault* fault) {
  std::vector<double> ratios;
  for (const StretchPair& pair : pairs) {
    if (std::abs(pair.by_scans.theta) > DegToRad(kStraight) || Way(pair.by_scans) < kWay) continue;
    if (pair.way_sigma_m > kSureOfWay * Way(pair.by_scans)) continue;
    ratios.push_back(Way(pair.by_wheels) / Way(pair.by_scans));
  }
  if (ratios.size() < kFewest) return;
  const Estimated middle = Middle(ratios);
  const double spread = middle.sigma * std::sqrt(static_cast<double>(ratios.size()));
  if (middle.value < kDead || spread > kUseless * middle.value) {
    fault->travel_useless = true;
    return;
  }
  fault->travel_factor =
      IfSurely({1.0 / middle.value, middle.sigma / (middle.value * middle.value)}, kLeastFault);
}

}  // namespace

WheelReport Compare(const std::vector<Stretch>& stretches,
                    const std::vector<WheelPose>& wheel_poses) {
  WheelReport report;
  const Wheels wheels(wheel_poses);
  report.fault.scan_clock_s = FindClock(stretches, wheels);
  const double ahead_s = report.fault.scan_clock_s ? report.fault.scan_clock_s->value : 0.0;
  report.stretches = Paired(stretches, wheels, ahead_s);
  JudgeTurns(TurnsOf(report.stretches), &report.fault);
  JudgeWay(report.stretches, &report.fault);
  return report;
}

}  // namespace masked_mapper
