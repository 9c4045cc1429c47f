// SPDX-License-Identifier: BSD-3-Clause
#include "wheels_by_closures.hpp"

#include <algorithm>
#include <cmath>

#include "masked_mapper/geometry/median.hpp"
#include "masked_mapper/geometry/pose2.hpp"
#include "masked_mapper/motion/motion_options.hpp"

namespace masked_mapper {
namespace {

constexpr double kLongestWay = 10.0;  // m by wheels along a tie
constexpr double kMostTurn = 0.3;     // rad along a straight one, all turns taken positive

struct Way {
  double travelled_m = 0.0;
  double turned_rad = 0.0;  // all turns taken positive
};

// By wheels, from the start to each node.
std::vector<Way> WaysToNodes(const BuildingMap& map) {
  std::vector<Way> ways;
  Way way;
  const TrajectoryPose* before = nullptr;
  for (const TrajectoryPose& pose : map.trajectory) {
    if (before != nullptr) {
      const Pose2 step = Between(before->T_odom_robot, pose.T_odom_robot);
      way.travelled_m += step.Translation().norm();
      way.turned_rad += std::abs(step.theta);
    }
    before = &pose;
    // Nodes are made at poses.
    while (ways.size() <= static_cast<std::size_t>(pose.node_before)) ways.push_back(way);
  }
  return ways;
}

double Squared(double x) { return x * x; }

// The factor of a variance at which normal errors are as the errors are; `ratios`: squared errors
// over the variance expected of each. By their median, which wrong closures hardly move, and two
// sigmas of their number to spare; 1 where there are too few.
double VarianceFactor(std::vector<double> ratios) {
  constexpr double kMedianChi2 = 0.4549;  // of one degree of freedom
  const auto n = static_cast<double>(ratios.size());
  const auto better = static_cast<std::size_t>(std::ceil(0.5 * n + std::sqrt(n)));
  if (ratios.empty() || better > ratios.size()) return 1.0;
  const auto last = ratios.begin() + static_cast<std::ptrdiff_t>(better - 1);
  std::nth_element(ratios.begin(), last, ratios.end());
  return *last / kMedianChi2;
}

// Of a sigma, as where scans tell.
double SigmaScale(double variance_factor) {
  return std::clamp(std::sqrt(variance_factor), WheelNoiseOptions().least_scale, 1.0);
}

// The median, where it is surely another than `expected`; else that.
double SureMedian(std::vector<double> values, double expected) {
  constexpr std::size_t kFewest = 10;
  constexpr double kMostSigmas = 4.0;
  if (values.size() < kFewest) return expected;
  const double median = Median(values);
  for (double& value : values) value = std::abs(value - median);
  // Of normal errors: their sigma from the median of their sizes, and that of a median from it.
  const double sigma =
      1.2533 * 1.4826 * Median(values) / std::sqrt(static_cast<double>(values.size()));
  return std::abs(median - expected) > kMostSigmas * sigma ? median : expected;
}

// Wheels that pull to one side err in proportion to the way, a random walk by its root: what they
// pull is counted as if it were one over as long a way as lies between places that close.
double PullVariance(const std::vector<WheelTie>& straight) {
  constexpr double kFar = 100.0;  // m
  std::vector<double> rad_per_m;
  rad_per_m.reserve(straight.size());
  for (const WheelTie& tie : straight) rad_per_m.push_back(tie.turn_error_rad / tie.travelled_m);
  return Squared(SureMedian(std::move(rad_per_m), 0.0)) * kFar;
}

}  // namespace

std::vector<WheelTie> WheelTies(const BuildingMap& map) {
  constexpr double kShortest = 2.0;  // m; a match errs by a few centimetres, however long it is
  const std::vector<Way> ways = WaysToNodes(map);
  std::vector<WheelTie> ties;
  for (const Closure& closure : map.closures) {
    if (closure.state != ClosureState::kValidated) continue;
    const Way& older = ways[static_cast<std::size_t>(closure.older)];
    const Way& newer = ways[static_cast<std::size_t>(closure.newer)];
    WheelTie tie;
    tie.travelled_m = newer.travelled_m - older.travelled_m;
    if (tie.travelled_m < kShortest || tie.travelled_m > kLongestWay) continue;
    tie.turned_rad = newer.turned_rad - older.turned_rad;
    const Pose2 by_wheels = Between(map.graph.node(closure.older).T_odom_robot,
                                    map.graph.node(closure.newer).T_odom_robot);
    const Pose2& by_match = closure.T_older_newer.mean;
    tie.counted_m = by_wheels.Translation().norm();
    tie.matched_m = by_match.Translation().norm();
    tie.turn_error_rad = WrapAngle(by_wheels.theta - by_match.theta);
    ties.push_back(tie);
  }
  return ties;
}

std::optional<LearntWheels> WheelsByClosures(const std::vector<WheelTie>& ties,
                                             const DeadReckoningOptions& wheels) {
  // Nearly straight ways tell of travel; the others of turns, as if travel erred not at all.
  std::vector<WheelTie> straight;
  std::vector<WheelTie> turning;
  for (const WheelTie& tie : ties) {
    (tie.turned_rad <= kMostTurn ? straight : turning).push_back(tie);
  }
  std::vector<double> ratios;
  for (const WheelTie& tie : straight) ratios.push_back(tie.matched_m / tie.counted_m);
  LearntWheels learnt;
  learnt.travel_factor = SureMedian(std::move(ratios), 1.0);
  const double travel_variance = Squared(DegToRad(wheels.sigma_heading_deg_per_sqrt_m));
  const double turn_variance = Squared(DegToRad(wheels.sigma_heading_deg_per_sqrt_rad));
  const double position_variance = Squared(wheels.sigma_position_per_sqrt_m);
  std::vector<double> by_travel;
  std::vector<double> by_length;
  for (const WheelTie& tie : straight) {
    by_travel.push_back(Squared(tie.turn_error_rad) / (travel_variance * tie.travelled_m));
    by_length.push_back(Squared(tie.matched_m - learnt.travel_factor * tie.counted_m) /
                        (position_variance * tie.counted_m));
  }
  std::vector<double> by_turns;
  for (const WheelTie& tie : turning) {
    by_turns.push_back(Squared(tie.turn_error_rad) / (turn_variance * tie.turned_rad));
  }
  const double pull = PullVariance(straight) / travel_variance;
  const double travel = SigmaScale(VarianceFactor(std::move(by_travel)) + pull);
  const double turn = SigmaScale(VarianceFactor(std::move(by_turns)));
  const double position = SigmaScale(VarianceFactor(std::move(by_length)));
  learnt.noise = wheels;
  learnt.noise.sigma_heading_deg_per_sqrt_m *= travel;
  learnt.noise.sigma_heading_deg_per_sqrt_rad *= turn;
  learnt.noise.sigma_position_per_sqrt_m *= position;
  constexpr double kWorthAnotherMap = 0.5;
  if (std::min({travel, turn, position}) > kWorthAnotherMap && learnt.travel_factor == 1.0) {
    return std::nullopt;
  }
  return learnt;
}

}  // namespace masked_mapper
