// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/motion/floor_timeline.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace masked_mapper {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostLevels = 200;  // more are noise, and go to the nearest
constexpr double kLeastSigma = 1e-3;      // m

/// The level of each spell between transits (one more than transits), numbered by first use.
struct Assignment {
  std::vector<std::size_t> level_of_spell = {0};
  std::size_t level_count = 1;
};

/// Spell by spell: the known level nearest to where the climb leads, if it is near enough.
Assignment AssignInOrder(const std::vector<FloorTransit>& transits, const StoreyOptions& options) {
  Assignment assignment;
  std::vector<double> elevations = {0.0};
  for (const FloorTransit& transit : transits) {
    const std::size_t left = assignment.level_of_spell.back();
    std::optional<std::size_t> reached;
    if (transit.climb) {
      const double elevation = elevations[left] + *transit.climb;
      double nearest = elevations.size() < kMostLevels ? 0.5 * options.min_gap : kInfinity;
      for (std::size_t level = 0; level < elevations.size(); ++level) {
        const double distance = std::abs(elevations[level] - elevation);
        if (distance > nearest) continue;
        nearest = distance;
        reached = level;
      }
      // A climb too small for a floor, and none where it leads: still the floor that was left.
      if (!reached && std::abs(*transit.climb) < LeastClimb(options)) reached = left;
      if (!reached) elevations.push_back(elevation);
    } else if (elevations.size() >= kMostLevels) {
      reached = left;
    } else {
      // From an unknown level on, elevations count from a zero of their own, out of all reach.
      const double highest = *std::max_element(elevations.begin(), elevations.end());
      elevations.push_back(highest + 1e4);
    }
    if (!reached) reached = assignment.level_count++;
    assignment.level_of_spell.push_back(*reached);
  }
  return assignment;
}

std::vector<LevelStep> StepsOf(const std::vector<FloorTransit>& transits,
                               const Assignment& assignment) {
  std::vector<LevelStep> steps;
  for (std::size_t k = 0; k < transits.size(); ++k) {
    const std::size_t from = assignment.level_of_spell[k];
    const std::size_t to = assignment.level_of_spell[k + 1];
    if (!transits[k].climb || from == to) continue;
    steps.push_back({from, to, *transits[k].climb, std::max(transits[k].climb_sigma, kLeastSigma)});
  }
  return steps;
}

/// Levels that all transits together put nearer than half the smallest gap become one.
Assignment MergedWhereNear(Assignment assignment, std::vector<LevelHeight> heights,
                           const StoreyOptions& options) {
  const auto find_equal = [&](std::size_t b) -> std::optional<std::size_t> {
    for (std::size_t a = 0; a < b; ++a) {
      const double gap = std::abs(heights[a].elevation - heights[b].elevation);
      if (heights[a].root == heights[b].root && gap <= 0.5 * options.min_gap) return a;
    }
    return std::nullopt;
  };
  for (std::size_t b = 1; b < heights.size();) {
    const std::optional<std::size_t> a = find_equal(b);
    if (!a) {
      ++b;
      continue;
    }
    for (std::size_t& level : assignment.level_of_spell) {
      if (level == b) level = *a;
      if (level > b) --level;
    }
    heights.erase(heights.begin() + static_cast<std::ptrdiff_t>(b));
    --assignment.level_count;
  }
  return assignment;
}

/// The first level that steps lead to each from.
std::vector<std::size_t> RootsOf(std::size_t level_count, const std::vector<LevelStep>& steps) {
  std::vector<std::size_t> roots(level_count);
  std::iota(roots.begin(), roots.end(), std::size_t{0});
  for (bool changed = true; changed;) {
    changed = false;
    for (const LevelStep& step : steps) {
      const std::size_t root = std::min(roots[step.from], roots[step.to]);
      changed = changed || roots[step.from] != root || roots[step.to] != root;
      roots[step.from] = roots[step.to] = root;
    }
  }
  return roots;
}

/// Of the levels that have one root.
void EstimateAbove(std::size_t root, const std::vector<LevelStep>& steps,
                   std::vector<LevelHeight>& heights) {
  // Unknowns are all but the root, which is 0.
  std::vector<Eigen::Index> unknown(heights.size(), -1);
  Eigen::Index count = 0;
  for (std::size_t level = root + 1; level < heights.size(); ++level) {
    if (heights[level].root == root) unknown[level] = count++;
  }
  if (count == 0) return;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd weighted = Eigen::VectorXd::Zero(count);
  for (const LevelStep& step : steps) {
    if (heights[step.from].root != root) continue;
    const double weight = 1.0 / (step.sigma * step.sigma);
    const Eigen::Index from = unknown[step.from];
    const Eigen::Index to = unknown[step.to];
    if (from >= 0) information(from, from) += weight;
    if (to >= 0) information(to, to) += weight;
    if (from >= 0 && to >= 0) information(from, to) -= weight;
    if (from >= 0 && to >= 0) information(to, from) -= weight;
    if (from >= 0) weighted(from) -= weight * step.climb;
    if (to >= 0) weighted(to) += weight * step.climb;
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(information);
  const Eigen::VectorXd elevations = solver.solve(weighted);
  const Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(count, count));
  for (std::size_t level = root + 1; level < heights.size(); ++level) {
    const Eigen::Index i = unknown[level];
    if (i < 0) continue;
    heights[level].elevation = elevations(i);
    heights[level].sigma = std::sqrt(std::max(0.0, covariance(i, i)));
  }
}

}  // namespace

std::vector<LevelHeight> EstimateLevelHeights(std::size_t level_count,
                                              const std::vector<LevelStep>& steps) {
  std::vector<LevelHeight> heights(level_count);
  const std::vector<std::size_t> roots = RootsOf(level_count, steps);
  for (std::size_t level = 0; level < level_count; ++level) {
    heights[level].root = roots[level];
    heights[level].measured = roots[level] == 0;
  }
  for (std::size_t level = 0; level < level_count; ++level) {
    if (roots[level] == level) EstimateAbove(level, steps, heights);
  }
  return heights;
}

void SettleElevations(const StoreyOptions& options, FloorTimeline& timeline) {
  std::vector<LevelStep> steps;
  for (const FloorChange& change : ChangesOf(timeline)) {
    if (!change.climb || change.from == change.to) continue;
    steps.push_back(
        {change.from, change.to, *change.climb, std::max(change.climb_sigma, kLeastSigma)});
  }
  const std::vector<LevelHeight> heights = EstimateLevelHeights(timeline.levels.size(), steps);
  double highest = 0.0;
  for (std::size_t root = 0; root < heights.size(); ++root) {
    if (heights[root].root != root) continue;
    double lowest = 0.0;
    for (const LevelHeight& height : heights) {
      if (height.root == root) lowest = std::min(lowest, height.elevation);
    }
    const double shift = root == 0 ? 0.0 : highest + options.typical_height - lowest;
    for (std::size_t i = root; i < heights.size(); ++i) {
      if (heights[i].root != root) continue;
      FloorLevel& level = timeline.levels[i];
      level.elevation = heights[i].elevation + shift;
      level.elevation_sigma =
          root == 0 ? heights[i].sigma : std::hypot(options.typical_height, heights[i].sigma);
      level.elevation_measured = level.identity_known = root == 0;
      highest = std::max(highest, level.elevation);
    }
  }
}

FloorTimeline TimelineOfTransits(const std::vector<FloorTransit>& all,
                                 const StoreyOptions& options) {
  // A log that begins or ends between floors: what was before, or comes after, is not in it.
  std::vector<FloorTransit> transits = all;
  const bool starts_in_transit = !transits.empty() && transits.front().start == -kInfinity;
  const double first_arrival = starts_in_transit ? transits.front().end : -kInfinity;
  if (starts_in_transit) transits.erase(transits.begin());
  const bool ends_in_transit = !transits.empty() && transits.back().end == kInfinity;
  const double last_departure = ends_in_transit ? transits.back().start : kInfinity;
  if (ends_in_transit) transits.pop_back();

  Assignment assignment = AssignInOrder(transits, options);
  for (std::size_t before = 0; before != assignment.level_count;) {
    before = assignment.level_count;
    const std::vector<LevelHeight> heights =
        EstimateLevelHeights(before, StepsOf(transits, assignment));
    assignment = MergedWhereNear(std::move(assignment), heights, options);
  }

  FloorTimeline timeline;
  timeline.levels.resize(assignment.level_count);
  timeline.intervals.clear();
  if (starts_in_transit) timeline.intervals.push_back({-kInfinity, 0, true, 0.0, all.front().by});
  timeline.intervals.push_back({first_arrival, 0, false});
  for (std::size_t k = 0; k < transits.size(); ++k) {
    const FloorTransit& transit = transits[k];
    const std::size_t left = assignment.level_of_spell[k];
    const std::size_t reached = assignment.level_of_spell[k + 1];
    const FloorInterval on_the_way{transit.start,      left, true, 0.0, transit.by, transit.climb,
                                   transit.climb_sigma};
    timeline.intervals.push_back(on_the_way);
    if (left != reached) {
      const double middle = std::clamp(transit.middle, transit.start, transit.end);
      timeline.intervals.push_back(on_the_way);
      timeline.intervals.back().start = middle;
      timeline.intervals.back().level = reached;
    }
    timeline.intervals.push_back({transit.end, reached, false});
  }
  if (ends_in_transit) {
    timeline.intervals.push_back(
        {last_departure, assignment.level_of_spell.back(), true, 0.0, all.back().by});
  }
  SettleElevations(options, timeline);
  return timeline;
}

std::vector<FloorTransit> TransitsOf(const FloorTimeline& timeline) {
  std::vector<FloorTransit> transits;
  for (const FloorChange& change : ChangesOf(timeline)) {
    const auto reached = std::find_if(
        timeline.intervals.begin(), timeline.intervals.end(), [&](const FloorInterval& interval) {
          return interval.start > change.t_out && interval.level == change.to;
        });
    const double middle =
        reached == timeline.intervals.end() ? change.t_in : std::min(reached->start, change.t_in);
    transits.push_back(
        {change.t_out, middle, change.t_in, change.climb, change.climb_sigma, change.by});
  }
  return transits;
}

}  // namespace masked_mapper
