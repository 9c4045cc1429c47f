// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/joining/visit_tying.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include "masked_mapper/loop_closure/candidates.hpp"
#include "masked_mapper/map/surroundings.hpp"
#include "masked_mapper/map/trajectory.hpp"
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"
#include "masked_mapper/scan_matching/correlative_search.hpp"

namespace masked_mapper {
namespace {

constexpr double kScanEvery = 0.5;  // m of travel

/// Where a visit lies is known by the ride already, to a few centimetres: votes of one place
/// suffice.
constexpr int kPlacesNeeded = 1;

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
                                    const CandidateOptions& options) {
  std::vector<Candidate> older;
  for (Candidate& candidate :
       FindCandidates(graph, node, DijkstraProjection(graph, node), options)) {
    if (visits[static_cast<std::size_t>(candidate.node)] < visits[static_cast<std::size_t>(node)]) {
      older.push_back(std::move(candidate));
    }
  }
  return older;
}

}  // namespace

void TieVisits(LoopClosureOptions options, BuildingMap& map) {
  const std::vector<std::size_t> visits = VisitsOf(map.graph);
  constexpr std::size_t kFewest = 3;  // one floor, another, and the first again
  if (visits.empty() || visits.back() + 1 < kFewest) return;
  const std::vector<bool> is_tied = TiedToOlderVisits(map, visits);
  options.validator.places_needed = kPlacesNeeded;
  const LookupTableOptions& table = options.matcher.table;
  LoopCloser closer(options, map, [&](NodeId node) {
    const SurroundingsOptions around{options.submaps.half_length_m, kScanEvery, LaidOutBy::kMotion};
    return AsScanPoints(ThinPoints(*PointsAround(map, node, around, table.max_range_m),
                                   table.resolution_m, table.max_range_m));
  });
  std::size_t closures = 0;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (!map.graph.nodes()[i].HasScan() || is_tied[i]) continue;
    const auto node = static_cast<NodeId>(i);
    const std::vector<Candidate> older = CandidatesOf(map.graph, node, visits, options.candidates);
    if (!older.empty()) closures += closer.Close(node, older);
  }
  if (closures == 0) return;
  closer.Finish();
  BendTrajectory(map.graph, map.trajectory);
}

}  // namespace masked_mapper
