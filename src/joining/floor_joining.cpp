// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/floor_joining.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "masked_mapper/loop_closure/submaps.hpp"
#include "masked_mapper/scan_matching/joint_matcher.hpp"

namespace masked_mapper {
namespace {

// A match of one node of the newer level, as what it says of the way from one level to the other.
struct Shift {
  NodeId node = 0;
  Pose2 T_world_node;          ///< where motion puts the node
  Pose2 T_world_matched_node;  ///< where the older level puts it
};

// The second shift, done to the first one's node, in the first one's words.
bool Agree(const Shift& a, const Shift& b, const FloorJoinOptions& options) {
  const Pose2 T_world_a = b.T_world_matched_node * Between(b.T_world_node, a.T_world_node);
  return Distance(T_world_a, a.T_world_matched_node) <= options.agree_m &&
         std::abs(WrapAngle(T_world_a.theta - a.T_world_matched_node.theta)) <=
             DegToRad(options.agree_deg);
}

class LevelMatcher {
 public:
  LevelMatcher(const BuildingMap& map, const FloorJoinOptions& options,
               const LoopClosureOptions& closures)
      : map_(map),
        options_(options),
        refine_(closures.refine),
        matcher_(closures.matcher),
        submaps_(closures.submaps, map) {}

  struct Fit {
    int offered = 0;   ///< nodes of the newer level with a neighbour on the older one
    int agreeing = 0;  ///< of them, those of the largest group that is shifted alike
  };

  /// `older` may be several levels that are one floor.
  Fit Match(FloorId newer, const std::vector<FloorId>& older) {
    Fit fit;
    std::vector<Shift> shifts;
    for (const NodeId node : ScanNodesOn({newer})) {
      const std::vector<NodeId> neighbours = Neighbours(node, older);
      if (neighbours.empty()) continue;
      ++fit.offered;
      for (const NodeId neighbour : neighbours) {
        const std::optional<Shift> shift = MatchPairOf(node, neighbour);
        if (shift) shifts.push_back(*shift);
      }
    }
    for (const Shift& candidate : shifts) {
      std::vector<NodeId> nodes;
      for (const Shift& other : shifts) {
        if (Agree(candidate, other, options_)) nodes.push_back(other.node);
      }
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      fit.agreeing = std::max(fit.agreeing, static_cast<int>(nodes.size()));
    }
    return fit;
  }

 private:
  const Node& At(NodeId node) const { return map_.graph.nodes()[static_cast<std::size_t>(node)]; }

  std::vector<NodeId> ScanNodesOn(const std::vector<FloorId>& floors) const {
    std::vector<NodeId> found;
    const auto count = static_cast<NodeId>(map_.graph.nodes().size());
    for (NodeId node = 0; node < count; ++node) {
      if (At(node).HasScan() && std::count(floors.begin(), floors.end(), At(node).floor) > 0) {
        found.push_back(node);
      }
    }
    return found;
  }

  std::vector<NodeId> Neighbours(NodeId node, const std::vector<FloorId>& floors) const {
    std::vector<std::pair<double, NodeId>> near;
    for (const NodeId other : ScanNodesOn(floors)) {
      const double distance = Distance(At(node).T_world_robot, At(other).T_world_robot);
      if (distance <= options_.reach_m) near.emplace_back(distance, other);
    }
    std::sort(near.begin(), near.end());
    constexpr std::size_t kMost = 2;
    std::vector<NodeId> nearest;
    for (std::size_t i = 0; i < std::min(kMost, near.size()); ++i)
      nearest.push_back(near[i].second);
    return nearest;
  }

  std::optional<Shift> MatchPairOf(NodeId node, NodeId neighbour) {
    const ScanPoints::ConstPtr points_in_node = submaps_.PointsAt(node);
    UncertainPose2 guess;
    guess.mean = Between(At(neighbour).T_world_robot, At(node).T_world_robot);
    const double sigma_m = options_.sigma_m;
    const double sigma_rad = DegToRad(options_.sigma_deg);
    guess.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
    const MatchResult match =
        matcher_.Match({{neighbour, submaps_.PointsAt(neighbour), points_in_node, guess}}).front();
    if (match.outcome != MatchOutcome::kMatched) return std::nullopt;
    Pose2 T_neighbour_node = match.T_reference_query.mean;
    if (refine_) {
      const std::optional<SubmapMatch> refined =
          submaps_.Refine(neighbour, *points_in_node, match.T_reference_query);
      if (!refined) return std::nullopt;
      T_neighbour_node = refined->T_node_robot.mean;
    }
    return Shift{node, At(node).T_world_robot, At(neighbour).T_world_robot * T_neighbour_node};
  }

  const BuildingMap& map_;
  const FloorJoinOptions& options_;
  bool refine_;
  JointMatcher matcher_;
  Submaps submaps_;
};

// The level that the robot came from when it first reached `level`.
std::optional<std::size_t> ReachedFrom(const FloorTimeline& floors, std::size_t level) {
  for (std::size_t i = 1; i < floors.intervals.size(); ++i) {
    if (floors.intervals[i].level == level) return floors.intervals[i - 1].level;
  }
  return std::nullopt;
}

// Levels that are another are taken out, and the rest count on without a gap.
FloorTimeline Merged(const FloorTimeline& floors, const std::vector<std::size_t>& is_level) {
  FloorTimeline merged;
  merged.levels.clear();
  std::vector<std::size_t> place(floors.levels.size());
  for (std::size_t level = 0; level < floors.levels.size(); ++level) {
    if (is_level[level] != level) continue;
    place[level] = merged.levels.size();
    merged.levels.push_back(floors.levels[level]);
    merged.levels.back().identity_known = true;
  }
  merged.intervals = floors.intervals;
  for (FloorInterval& interval : merged.intervals) {
    interval.level = place[is_level[interval.level]];
  }
  return merged;
}

}  // namespace

bool HasUnknownFloors(const FloorTimeline& floors) {
  return std::any_of(floors.levels.begin(), floors.levels.end(),
                     [](const FloorLevel& level) { return !level.identity_known; });
}

FloorJoining JoinFloors(const BuildingMap& map, const FloorTimeline& floors,
                        const FloorJoinOptions& options, const LoopClosureOptions& closures) {
  const std::vector<std::string> names = FloorNames(floors.levels);
  std::vector<std::size_t> is_level(floors.levels.size());
  FloorJoining joining;
  LevelMatcher matcher(map, options, closures);
  for (std::size_t level = 0; level < floors.levels.size(); ++level) {
    is_level[level] = level;
    if (floors.levels[level].identity_known) continue;
    const std::optional<std::size_t> from = ReachedFrom(floors, level);
    for (std::size_t older = 0; older < level; ++older) {
      if (is_level[older] != older || (from && is_level[*from] == older)) continue;
      std::vector<FloorId> parts;
      for (std::size_t part = older; part < level; ++part) {
        if (is_level[part] == older) parts.push_back(static_cast<FloorId>(part));
      }
      const LevelMatcher::Fit fit = matcher.Match(static_cast<FloorId>(level), parts);
      if (fit.agreeing < options.min_places || fit.agreeing < options.min_share * fit.offered) {
        continue;
      }
      is_level[level] = older;
      joining.any_joined = true;
      joining.notes.push_back(
          "floor " + names[older] + " was met again: " + std::to_string(fit.agreeing) + " of " +
          std::to_string(fit.offered) + " places fit it, and no sensor tells floors apart");
      break;
    }
  }
  joining.floors = Merged(floors, is_level);
  return joining;
}

}  // namespace masked_mapper
