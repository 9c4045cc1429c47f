// SPDX-License-Identifier: BSD-3-Clause
// Loop validation by evidence, in place of the paper's votes (Section III-E; vote_validator.hpp). A
// match is believed once what speaks for it comes to kEnoughNats:
//   - the surest way through the graph, be it for or against, without limit;
//   - other matches that wait: where the two and the ways between their ends close a loop, each is
//     a witness for the other, for as much as places so far apart are unlikely to look alike both.
// Places and nothing else make witnesses independent. What entered is a way for others.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "masked_mapper/map/closure.hpp"
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"
#include "masked_mapper/pose_graph/pose_graph.hpp"

namespace masked_mapper {

class EvidenceValidator {
 public:
  /// Judges matches, ids of `closures` that are hypotheses there, over the graph and over the
  /// hypotheses judged before. Counts as votes what speaks for each. Closures that became valid by
  /// this call (of `matches`, or older ones) are so in `closures`, and returned in order of ids.
  /// The caller adds their edges to the graph before the next call.
  std::vector<ClosureId> Judge(const PoseGraph& graph, const std::vector<ClosureId>& matches,
                               std::vector<Closure>& closures);

  /// Nats that speak for a closure that was judged.
  double EvidenceFor(ClosureId id, const PoseGraph& graph,
                     const std::vector<Closure>& closures) const;

  /// The state, for a checkpoint (sensor/state_archive.hpp); `closures` as given to Judge().
  template <class Archive>
  void Serialize(Archive& archive, const std::vector<Closure>& closures) {
    archive(standings_, waiting_, entered_);
    bool holds = standings_.size() <= closures.size();
    const auto is_judged = [&](ClosureId id) {
      return id >= 0 && static_cast<std::size_t>(id) < standings_.size();
    };
    for (const Standing& standing : standings_) {
      for (const Witness& witness : standing.witnesses) holds = holds && is_judged(witness.id);
    }
    for (const std::vector<ClosureId>* ids : {&waiting_, &entered_}) {
      for (const ClosureId id : *ids) holds = holds && is_judged(id);
    }
    if (!holds) archive.Refuse("standings of closures that there are not");
  }

 private:
  struct Witness {
    ClosureId id = -1;
    double nats = 0.0;  // of the loop of both

    template <class Archive>
    void Serialize(Archive& archive) {
      archive(id, nats);
    }
  };
  struct Standing {
    double by_way = 0.0;  // nats
    std::vector<Witness> witnesses;

    template <class Archive>
    void Serialize(Archive& archive) {
      archive(by_way, witnesses);
    }
  };

  // The last search from a node, kept for as long as it is of the same node and edges.
  class LastSearch {
   public:
    ProjectionSearch& From(NodeId node, const PoseGraph& graph);

   private:
    std::optional<ProjectionSearch> search_;
    NodeId from_ = -1;
    std::size_t nodes_ = 0;  // of the graph when it was begun
    std::size_t edges_ = 0;
  };

  void AskWay(const PoseGraph& graph, ClosureId id, const std::vector<Closure>& closures);
  void AskWitnesses(const PoseGraph& graph, ClosureId id, const std::vector<Closure>& closures);
  void AskAgain(const PoseGraph& graph, std::vector<Closure>& closures);
  void Admit(const PoseGraph& graph, const std::vector<ClosureId>& ids,
             std::vector<Closure>& closures);
  Standing& StandingOf(ClosureId id) { return standings_[static_cast<std::size_t>(id)]; }

  std::vector<Standing> standings_;  // of the closures, up to the last that was judged
  std::vector<ClosureId> waiting_;   // judged, and not believed so far; in order
  std::vector<ClosureId> entered_;   // by the last call: what they are a way for is asked again
  LastSearch from_newer_;
  LastSearch from_older_;
};

}  // namespace masked_mapper
