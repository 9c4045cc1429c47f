// SPDX-License-Identifier: BSD-3-Clause
#include "evidence_validator.hpp"

#include <algorithm>
#include <limits>

#include "loop_evidence.hpp"
#include "masked_mapper/text/check.hpp"

namespace masked_mapper {
namespace {

const Closure& ClosureOf(ClosureId id, const std::vector<Closure>& closures) {
  return closures[static_cast<std::size_t>(id)];
}

}  // namespace

ProjectionSearch& EvidenceValidator::LastSearch::From(NodeId node, const PoseGraph& graph) {
  const bool is_known =
      from_ == node && nodes_ == graph.nodes().size() && edges_ == graph.edges().size();
  if (!is_known) search_.emplace(graph, node);
  from_ = node;
  nodes_ = graph.nodes().size();
  edges_ = graph.edges().size();
  return *search_;
}

std::vector<ClosureId> EvidenceValidator::Judge(const PoseGraph& graph,
                                                const std::vector<ClosureId>& matches,
                                                std::vector<Closure>& closures) {
  standings_.resize(closures.size());
  AskAgain(graph, closures);
  for (const ClosureId id : matches) {
    const Closure& match = ClosureOf(id, closures);
    const auto nodes = static_cast<NodeId>(graph.nodes().size());
    Check(match.older >= 0 && match.newer >= 0 && match.older < nodes && match.newer < nodes &&
              match.older != match.newer,
          "the ends of a match are two nodes of the graph");
    AskWay(graph, id, closures);
    AskWitnesses(graph, id, closures);
    waiting_.push_back(id);
    std::vector<ClosureId> heard{id};
    for (const Witness& witness : StandingOf(id).witnesses) heard.push_back(witness.id);
    Admit(graph, heard, closures);
  }
  std::sort(entered_.begin(), entered_.end());
  return entered_;
}

// What entered is an edge by now: for those that it was a witness for it is a way.
void EvidenceValidator::AskAgain(const PoseGraph& graph, std::vector<Closure>& closures) {
  const std::vector<ClosureId> entered = std::move(entered_);
  entered_.clear();
  if (entered.empty()) return;
  std::vector<ClosureId> asked;
  for (const ClosureId id : waiting_) {
    std::vector<Witness>& witnesses = StandingOf(id).witnesses;
    const auto is_edge = [&](const Witness& witness) {
      return std::binary_search(entered.begin(), entered.end(), witness.id);
    };
    const auto gone = std::remove_if(witnesses.begin(), witnesses.end(), is_edge);
    if (gone == witnesses.end()) continue;
    witnesses.erase(gone, witnesses.end());
    AskWay(graph, id, closures);
    asked.push_back(id);
  }
  Admit(graph, asked, closures);
}

void EvidenceValidator::AskWay(const PoseGraph& graph, ClosureId id,
                               const std::vector<Closure>& closures) {
  const Closure& closure = ClosureOf(id, closures);
  // Without limit: a way that comes back is less sure on its way.
  const ProjectedNode* way = from_newer_.From(closure.newer, graph).Find(closure.older);
  StandingOf(id).by_way =
      way == nullptr ? 0.0 : LoopEvidence(way->T_source_node * closure.T_older_newer);
}

void EvidenceValidator::AskWitnesses(const PoseGraph& graph, ClosureId id,
                                     const std::vector<Closure>& closures) {
  // A trace (Eq. 2). Witnesses from farther off than the way is unsure say less than the way.
  constexpr double kReach = 2.0;
  const Closure& asked = ClosureOf(id, closures);
  ProjectionSearch& from_newer = from_newer_.From(asked.newer, graph);
  ProjectionSearch& from_older = from_older_.From(asked.older, graph);
  const ProjectedNode* way = from_newer.Find(asked.older);
  const double reach = way == nullptr ? kHoweverUnsure : std::max(kReach, way->cost);
  for (const ClosureId other : waiting_) {
    const Closure& witness = ClosureOf(other, closures);
    if (graph.node(witness.older).floor != graph.node(asked.older).floor) continue;
    for (const bool same_way : {true, false}) {
      const NodeId beside_newer = same_way ? witness.newer : witness.older;
      const NodeId beside_older = same_way ? witness.older : witness.newer;
      const ProjectedNode* to_older = from_older.Find(beside_older, reach);
      if (to_older == nullptr) continue;
      const ProjectedNode* to_newer = from_newer.Find(beside_newer);
      if (to_newer == nullptr) continue;
      const UncertainPose2 across =
          same_way ? Inverse(witness.T_older_newer) : witness.T_older_newer;
      const UncertainPose2 loop =
          to_newer->T_source_node * across * Inverse(to_older->T_source_node) * asked.T_older_newer;
      const double nats = LoopEvidence(loop);
      if (nats <= 0.0) continue;
      StandingOf(id).witnesses.push_back({other, nats});
      StandingOf(other).witnesses.push_back({id, nats});
      break;
    }
  }
}

double EvidenceValidator::EvidenceFor(ClosureId id, const PoseGraph& graph,
                                      const std::vector<Closure>& closures) const {
  const Standing& standing = standings_[static_cast<std::size_t>(id)];
  const auto place_of = [&](ClosureId one) {
    return graph.node(ClosureOf(one, closures).newer).T_world_robot;
  };
  double nats = standing.by_way;
  std::vector<Pose2> places{place_of(id)};
  for (const Witness& witness : standing.witnesses) {
    const Pose2 place = place_of(witness.id);
    double apart = std::numeric_limits<double>::infinity();
    for (const Pose2& known : places) apart = std::min(apart, Distance(place, known));
    nats += std::min(witness.nats, MostEvidenceOfWitness(apart));
    places.push_back(place);
  }
  return nats;
}

void EvidenceValidator::Admit(const PoseGraph& graph, const std::vector<ClosureId>& ids,
                              std::vector<Closure>& closures) {
  for (const ClosureId id : ids) {
    Closure& closure = closures[static_cast<std::size_t>(id)];
    if (closure.state == ClosureState::kValidated) continue;
    const Standing& standing = StandingOf(id);
    closure.votes = static_cast<int>(standing.witnesses.size()) + (standing.by_way > 0.0 ? 1 : 0);
    if (EvidenceFor(id, graph, closures) < kEnoughNats) continue;
    closure.state = ClosureState::kValidated;
    closure.reason = ClosureReason::kEnoughVotes;
    entered_.push_back(id);
    waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), id), waiting_.end());
  }
}

}  // namespace masked_mapper
