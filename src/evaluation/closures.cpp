// SPDX-License-Identifier: BSD-3-Clause
#include "closures.hpp"

#include <algorithm>
#include <cmath>

#include "shortest_path.hpp"

namespace masked_mapper {
namespace {

bool OnOneFloor(const StampedPose& a, const StampedPose& b) {
  return std::abs(a.z - b.z) < kSameFloorHeight;
}

/// Metres driven up to each node; true steps where they are known, else the map's.
std::vector<double> TravelTo(const std::vector<StampedPose>& nodes,
                             const std::vector<std::optional<StampedPose>>& truth) {
  std::vector<double> travel(nodes.size(), 0.0);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const bool known = truth[i - 1] && truth[i];
    travel[i] =
        travel[i - 1] + (known ? Distance(truth[i - 1]->T_world_robot, truth[i]->T_world_robot)
                               : Distance(nodes[i - 1].T_world_robot, nodes[i].T_world_robot));
  }
  return travel;
}

std::vector<bool> BesideFloorChange(const std::vector<StampedPose>& nodes) {
  std::vector<bool> beside(nodes.size(), false);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (!OnOneFloor(nodes[i - 1], nodes[i])) beside[i - 1] = beside[i] = true;
  }
  return beside;
}

std::size_t CountClosed(const MappedGraph& graph, const std::vector<ValidatedClosure>& true_ones,
                        const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                        double walk_m) {
  const std::vector<StampedPose>& nodes = graph.nodes;
  LengthGraph walks(nodes.size());
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    walks.AddEdge(i - 1, i, Distance(nodes[i - 1].T_world_robot, nodes[i].T_world_robot));
  }
  for (const ValidatedClosure& closure : true_ones) {
    walks.AddEdge(closure.a, closure.b, std::hypot(closure.T_a_b.x, closure.T_a_b.y));
  }
  std::size_t closed = 0;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i == 0 || pairs[i].first != pairs[i - 1].first) {
      lengths = walks.LengthsFrom({{pairs[i].first, 0.0}}, walk_m);
    }
    if (std::isfinite(lengths[pairs[i].second])) ++closed;
  }
  return closed;
}

}  // namespace

ClosureTolerance ToleranceOf(const Truth& truth) {
  if (truth.exact) return {0.5, 5.0};
  return {1.0, 15.0};
}

std::vector<std::pair<std::size_t, std::size_t>> TrueRevisits(
    const std::vector<StampedPose>& nodes, const std::vector<std::optional<StampedPose>>& truth,
    const RevisitOptions& options) {
  const std::vector<double> travel = TravelTo(nodes, truth);
  const std::vector<bool> beside_floor_change = BesideFloorChange(nodes);
  std::vector<std::size_t> by_x;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (truth[i] && !beside_floor_change[i]) by_x.push_back(i);
  }
  const auto pose = [&truth](std::size_t i) -> const Pose2& { return truth[i]->T_world_robot; };
  std::stable_sort(by_x.begin(), by_x.end(),
                   [&](std::size_t a, std::size_t b) { return pose(a).x < pose(b).x; });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    for (std::size_t j = i + 1; j < by_x.size(); ++j) {
      const auto [a, b] = std::minmax(by_x[i], by_x[j]);
      if (std::abs(pose(b).x - pose(a).x) > options.distance_m) break;
      const double turn_deg = RadToDeg(std::abs(WrapAngle(pose(b).theta - pose(a).theta)));
      if (Distance(pose(a), pose(b)) <= options.distance_m && turn_deg <= options.heading_deg &&
          travel[b] - travel[a] > options.travel_m && OnOneFloor(*truth[a], *truth[b])) {
        pairs.emplace_back(a, b);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::optional<double> ClosureError::Precision() const {
  if (checked == 0) return std::nullopt;
  return static_cast<double>(checked - false_closures.size()) / static_cast<double>(checked);
}

std::optional<double> ClosureError::Recall() const {
  if (true_pairs == 0) return std::nullopt;
  return static_cast<double>(closed_pairs) / static_cast<double>(true_pairs);
}

ClosureError CheckClosures(const MappedGraph& graph, const std::vector<ValidatedClosure>& closures,
                           const std::vector<std::optional<StampedPose>>& truth,
                           const ClosureTolerance& tolerance, const RevisitOptions& options) {
  ClosureError error;
  error.validated = closures.size();
  std::vector<ValidatedClosure> true_ones;
  for (const ValidatedClosure& closure : closures) {
    const std::optional<StampedPose>& a = truth.at(closure.a);
    const std::optional<StampedPose>& b = truth.at(closure.b);
    if (!a || !b) continue;
    ++error.checked;
    const Pose2 left = Between(Between(a->T_world_robot, b->T_world_robot), closure.T_a_b);
    const double translation = std::hypot(left.x, left.y);
    const double rotation_deg = RadToDeg(std::abs(left.theta));
    if (translation > tolerance.translation_m || rotation_deg > tolerance.rotation_deg ||
        !OnOneFloor(*a, *b)) {
      error.false_closures.push_back({graph.nodes.at(closure.a).stamp,
                                      graph.nodes.at(closure.b).stamp, translation, rotation_deg});
    } else {
      true_ones.push_back(closure);
    }
  }
  const auto pairs = TrueRevisits(graph.nodes, truth, options);
  error.true_pairs = pairs.size();
  error.closed_pairs = CountClosed(graph, true_ones, pairs, options.walk_m);
  return error;
}

}  // namespace masked_mapper
