// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/floor_joining.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/loop_closure/loop_closer.hpp"
#include "masked_mapper/map/surroundings.hpp"
#include "masked_mapper/map/trajectory.hpp"
#include "piece_search.hpp"

namespace masked_mapper {
namespace {

constexpr double kScanEvery = 0.5;  // m of travel

/// Of each node, counted from one floor to the next.
std::vector<std::size_t> VisitsOf(const PoseGraph& graph) {
  std::vector<std::size_t> visits;
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    const bool is_next = i > 0 && graph.nodes()[i].floor != graph.nodes()[i - 1].floor;
    visits.push_back((i == 0 ? 0 : visits.back()) + (is_next ? 1 : 0));
  }
  return visits;
}

std::vector<bool> TiedToOlderVisits(const BuildingMap& map,
                                    const std::vector<std::size_t>& visits) {
  std::vector<bool> is_tied(visits.size(), false);
  for (const Closure& closure : map.closures) {
    const auto newer = static_cast<std::size_t>(closure.newer);
    const auto older = static_cast<std::size_t>(closure.older);
    if (closure.state == ClosureState::kValidated && visits[older] < visits[newer]) {
      is_tied[newer] = true;
    }
  }
  return is_tied;
}

/// Nodes of older visits alone.
std::vector<Candidate> CandidatesOf(const PoseGraph& graph, NodeId node,
                                    const std::vector<std::size_t>& visits,
                                    const CandidateOptions& options, CandidateSearch& search) {
  std::vector<Candidate> older;
  for (Candidate& candidate : search.Of(graph, node, options)) {
    if (visits[static_cast<std::size_t>(candidate.node)] < visits[static_cast<std::size_t>(node)]) {
      older.push_back(std::move(candidate));
    }
  }
  return older;
}

/// A visit's nodes and poses; those of all visits before it on its floor.
PieceQuestion QuestionOf(const BuildingMap& map, const std::vector<std::size_t>& visits,
                         std::size_t visit) {
  PieceQuestion question;
  std::vector<IndexRange> nodes;  // of every visit
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (i == 0 || visits[i] != visits[i - 1]) nodes.push_back({i, i});
    nodes.back().end = i + 1;
  }
  const auto first_pose = [&](std::size_t node) {
    return static_cast<std::size_t>(
        std::partition_point(map.trajectory.begin(), map.trajectory.end(),
                             [&](const TrajectoryPose& pose) {
                               return static_cast<std::size_t>(pose.node_before) < node;
                             }) -
        map.trajectory.begin());
  };
  const auto floor_of = [&](std::size_t i) { return map.graph.nodes()[nodes[i].begin].floor; };
  for (std::size_t i = 0; i <= visit; ++i) {
    if (floor_of(i) != floor_of(visit)) continue;
    MapPart& part = i == visit ? question.newer : question.older;
    part.nodes.push_back(nodes[i]);
    part.poses.push_back({first_pose(nodes[i].begin), first_pose(nodes[i].end)});
  }
  PiecePrior ride;
  ride.T_world_anchor = map.graph.nodes()[nodes[visit].begin].T_world_robot;
  question.prior = ride;
  return question;
}

/// The nearest older nodes, were the visit moved by `T_older_newer`.
std::vector<Candidate> CandidatesMoved(const BuildingMap& map, NodeId node,
                                       const std::vector<IndexRange>& older,
                                       const Pose2& T_older_newer, const DriveJoinOptions& joins,
                                       const CandidateOptions& options) {
  const Pose2 T_world_robot = T_older_newer * map.graph.node(node).T_world_robot;
  const double sigma_rad = DegToRad(joins.sigma_deg);
  std::vector<Candidate> candidates;
  for (const IndexRange& range : older) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Node& to = map.graph.nodes()[i];
      if (!to.HasScan() || Distance(T_world_robot, to.T_world_robot) > joins.reach_m) continue;
      Candidate candidate;
      candidate.node = static_cast<NodeId>(i);
      candidate.T_new_node.mean = Between(T_world_robot, to.T_world_robot);
      candidate.T_new_node.covariance.diagonal() << joins.sigma_m * joins.sigma_m,
          joins.sigma_m * joins.sigma_m, sigma_rad * sigma_rad;
      candidate.mahalanobis = MahalanobisDistance(
          candidate.T_new_node.mean.Translation(),
          candidate.T_new_node.covariance.topLeftCorner<2, 2>(), options.match_range_m);
      candidates.push_back(std::move(candidate));
    }
  }
  std::stable_sort(
      candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.T_new_node.mean.Translation().norm() < b.T_new_node.mean.Translation().norm();
      });
  const auto most = static_cast<std::size_t>(std::max(0, options.max_matches));
  if (candidates.size() > most) candidates.resize(most);
  return candidates;
}

/// Searches for a visit that nothing ties to the older ones, on the floor as they saw it, and
/// offers its nodes where it is found. Returns how many closures came of it.
std::size_t SearchVisit(const BuildingMap& map, const std::vector<std::size_t>& visits,
                        std::size_t visit, const FloorJoinOptions& joins,
                        const LoopClosureOptions& options, LoopCloser& closer) {
  PieceQuestion question = QuestionOf(map, visits, visit);
  if (question.older.nodes.empty()) return 0;
  question.prior->within_m = joins.ride.within_m;
  question.prior->within_deg = joins.ride.within_deg;
  const PieceSearchResult found = FindPiece(map, question, joins.places, options.matcher);
  if (!found.placement) return 0;
  std::vector<std::pair<NodeId, std::vector<Candidate>>> offers;
  for (const IndexRange& range : question.newer.nodes) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (!map.graph.nodes()[i].HasScan()) continue;
      const auto node = static_cast<NodeId>(i);
      offers.emplace_back(
          node, CandidatesMoved(map, node, question.older.nodes, found.placement->T_older_newer,
                                joins.places, options.candidates));
    }
  }
  std::size_t closures = 0;
  for (const auto& [node, candidates] : offers) {
    if (!candidates.empty()) closures += closer.Close(node, candidates);
  }
  return closures;
}

}  // namespace

void TieVisits(const LoopClosureOptions& options, const FloorJoinOptions& joins, BuildingMap& map) {
  const std::vector<std::size_t> visits = VisitsOf(map.graph);
  constexpr std::size_t kFewest = 3;  // one floor, another, and the first again
  if (visits.empty() || visits.back() + 1 < kFewest) return;
  const std::vector<bool> is_tied = TiedToOlderVisits(map, visits);
  const LookupTableOptions& table = options.matcher.table;
  LoopCloser closer(options, map, [&](NodeId node) {
    const SurroundingsOptions around{options.submaps.half_length_m, kScanEvery, LaidOutBy::kMotion};
    return AsScanPoints(ThinPoints(*PointsAround(map, node, around, table.max_range_m),
                                   table.resolution_m, table.max_range_m));
  });
  CandidateSearch search;
  std::size_t closures = 0;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (!map.graph.nodes()[i].HasScan() || is_tied[i]) continue;
    const auto node = static_cast<NodeId>(i);
    const std::vector<Candidate> older =
        CandidatesOf(map.graph, node, visits, options.candidates, search);
    if (!older.empty()) closures += closer.Close(node, older);
  }
  std::vector<bool> is_tied_visit(visits.back() + 1, false);
  const std::vector<bool> is_tied_now = TiedToOlderVisits(map, visits);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (is_tied_now[i]) is_tied_visit[visits[i]] = true;
  }
  for (std::size_t visit = 0; visit < is_tied_visit.size(); ++visit) {
    if (is_tied_visit[visit]) continue;
    if (closures > 0) BendTrajectory(map.graph, map.trajectory);
    closures += SearchVisit(map, visits, visit, joins, options, closer);
  }
  if (closures == 0) return;
  closer.Finish();
  BendTrajectory(map.graph, map.trajectory);
}

}  // namespace masked_mapper
