// SPDX-License-Identifier: BSD-3-Clause
#include "loop_search.hpp"

#include <algorithm>
#include <cstdlib>
#include <queue>
#include <tuple>

#include "masked_mapper/geometry/uncertain_pose2.hpp"
#include "masked_mapper/text/check.hpp"

namespace masked_mapper {
namespace {

struct Entry {
  int unvalidated;
  double trace;
  NodeId node;
};

struct Later {
  bool operator()(const Entry& a, const Entry& b) const {
    return std::tie(a.unvalidated, a.trace, a.node) > std::tie(b.unvalidated, b.trace, b.node);
  }
};

template <typename T>
bool Holds(const std::vector<T>& items, T item) {
  return std::find(items.begin(), items.end(), item) != items.end();
}

}  // namespace

void RemovedSteps::Add(const PathStep& step) {
  if (step.edge >= 0) {
    edges_.push_back(step.edge);
  } else {
    closures_.push_back(step.closure);
  }
}

bool RemovedSteps::HoldsEdge(EdgeId id) const { return Holds(edges_, id); }

bool RemovedSteps::HoldsClosure(ClosureId id) const { return Holds(closures_, id); }

void LoopSearch::Add(ClosureId id, const Closure& closure) {
  const auto last = static_cast<std::size_t>(std::max(closure.older, closure.newer));
  if (closures_of_.size() <= last) closures_of_.resize(last + 1);
  closures_of_[static_cast<std::size_t>(closure.older)].push_back(id);
  closures_of_[static_cast<std::size_t>(closure.newer)].push_back(id);
}

void LoopSearch::Drop(ClosureId id, const Closure& closure) {
  for (const NodeId end : {closure.older, closure.newer}) {
    std::vector<ClosureId>& ids = closures_of_[static_cast<std::size_t>(end)];
    ids.erase(std::remove(ids.begin(), ids.end(), id), ids.end());
  }
}

LoopSearch::Reached& LoopSearch::At(NodeId node) {
  Reached& reached = reached_[static_cast<std::size_t>(node)];
  if (reached.search != search_) {
    reached.search = search_;
    reached.settled = false;
    reached.ways = 0;
    reached.parent = -1;
  }
  return reached;
}

std::optional<LeastErrorPath> LoopSearch::Find(const PoseGraph& graph,
                                               const std::vector<Closure>& closures, NodeId from,
                                               NodeId to, const RemovedSteps& removed) {
  reached_.resize(graph.nodes().size());
  closures_of_.resize(graph.nodes().size());
  ++search_;
  std::priority_queue<Entry, std::vector<Entry>, Later> queue;
  At(from).unvalidated = 0;
  At(from).trace = 0.0;
  queue.push({0, 0.0, from});
  bool found = false;
  while (!queue.empty() && !found) {
    const NodeId node = queue.top().node;
    queue.pop();
    Reached& here = At(node);
    if (here.settled) continue;
    here.settled = true;
    if (node == from) {
      here.T_from_node = {};
    } else {
      const UncertainPose2& before = At(here.parent).T_from_node;
      if (here.edge >= 0) {
        const Edge& edge = graph.edges()[static_cast<std::size_t>(here.edge)];
        here.T_from_node = before * (edge.to == node ? edge.T_from_to : Inverse(edge.T_from_to));
      } else {
        const Closure& taken = closures[static_cast<std::size_t>(here.closure)];
        here.T_from_node =
            before * (taken.newer == node ? taken.T_older_newer : Inverse(taken.T_older_newer));
      }
    }
    if (node == to) {
      found = true;
      break;
    }
    const ComposedTrace trace(here.T_from_node);
    const auto offer = [&](NodeId next, const UncertainPose2& T, bool forward, int unvalidated,
                           EdgeId edge, ClosureId closure) {
      Reached& there = At(next);
      if (there.settled) return;
      const double trace_there = forward ? trace.With(T) : trace.WithInverse(T);
      ++there.ways;
      if (there.parent >= 0 &&
          std::tie(there.unvalidated, there.trace) <= std::tie(unvalidated, trace_there)) {
        return;
      }
      there.unvalidated = unvalidated;
      there.trace = trace_there;
      there.edge = edge;
      there.closure = closure;
      there.parent = node;
      queue.push({unvalidated, trace_there, next});
    };
    for (const EdgeId id : graph.EdgesOf(node)) {
      if (removed.HoldsEdge(id)) continue;
      const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
      const bool forward = edge.from == node;
      offer(forward ? edge.to : edge.from, edge.T_from_to, forward, here.unvalidated, id, -1);
    }
    for (const ClosureId id : closures_of_[static_cast<std::size_t>(node)]) {
      if (removed.HoldsClosure(id)) continue;
      const Closure& closure = closures[static_cast<std::size_t>(id)];
      const bool forward = closure.older == node;
      const bool is_validated = closure.state == ClosureState::kValidated;
      offer(forward ? closure.newer : closure.older, closure.T_older_newer, forward,
            here.unvalidated + (is_validated ? 0 : 1), -1, id);
    }
  }
  if (!found) return std::nullopt;
  LeastErrorPath path;
  path.T_from_to = At(to).T_from_node;
  path.unvalidated = At(to).unvalidated;
  for (NodeId node = to; node != from; node = At(node).parent) {
    const Reached& reached = At(node);
    path.steps.push_back({reached.edge, reached.closure, node, reached.ways});
  }
  std::reverse(path.steps.begin(), path.steps.end());
  return path;
}

const PathStep& MostRedundantStep(const LeastErrorPath& path) {
  Check(!path.steps.empty(), "a path has a step");
  const auto last = static_cast<std::int64_t>(path.steps.size()) - 1;
  const auto from_middle = [&](std::int64_t i) { return std::abs(2 * i - last); };
  std::int64_t best = 0;
  for (std::int64_t i = 1; i <= last; ++i) {
    const int ways = path.steps[static_cast<std::size_t>(i)].ways;
    const int best_ways = path.steps[static_cast<std::size_t>(best)].ways;
    if (ways > best_ways || (ways == best_ways && from_middle(i) < from_middle(best))) best = i;
  }
  return path.steps[static_cast<std::size_t>(best)];
}

}  // namespace masked_mapper
