// SPDX-License-Identifier: BSD-3-Clause
#include "path_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "error_statistics.hpp"
#include "shortest_path.hpp"

namespace masked_mapper {
namespace {

/// A graph to walk in, and the lengths of the drive's own steps, from node i to i + 1.
struct Walkable {
  explicit Walkable(std::size_t nodes) : graph(nodes), steps(nodes - 1) {}
  LengthGraph graph;
  std::vector<double> steps;
};

bool IsStep(const GraphEdge& edge) {
  return std::max(edge.from, edge.to) - std::min(edge.from, edge.to) == 1;
}

double LengthIn(const std::vector<StampedPose>& nodes, std::size_t a, std::size_t b) {
  return Distance(nodes[a].T_world_robot, nodes[b].T_world_robot);
}

void SetStep(Walkable& walkable, std::size_t from, double length) {
  walkable.steps[from] = length;
  walkable.graph.AddEdge(from, from + 1, length);
}

/// Of every node, whether an edge leads to the next: none does from one drive to another.
std::vector<bool> LeadsOn(const MappedGraph& graph) {
  std::vector<bool> leads_on(graph.nodes.size(), false);
  for (const GraphEdge& edge : graph.edges) {
    if (IsStep(edge)) leads_on[std::min(edge.from, edge.to)] = true;
  }
  return leads_on;
}

Walkable AsMapped(const MappedGraph& graph) {
  Walkable walkable(graph.nodes.size());
  const std::vector<bool> leads_on = LeadsOn(graph);
  for (std::size_t i = 0; i + 1 < graph.nodes.size(); ++i) {
    if (leads_on[i]) SetStep(walkable, i, LengthIn(graph.nodes, i, i + 1));
  }
  for (const GraphEdge& edge : graph.edges) {
    if (!IsStep(edge)) {
      walkable.graph.AddEdge(edge.from, edge.to, LengthIn(graph.nodes, edge.from, edge.to));
    }
  }
  return walkable;
}

Walkable AsItIs(const MappedGraph& graph, const std::vector<std::optional<StampedPose>>& truth,
                const ClosureTolerance& tolerance, const RevisitOptions& revisits) {
  const auto true_length = [&truth](std::size_t a, std::size_t b) -> std::optional<double> {
    if (!truth[a] || !truth[b]) return std::nullopt;
    return Distance(truth[a]->T_world_robot, truth[b]->T_world_robot);
  };
  Walkable walkable(graph.nodes.size());
  const std::vector<bool> leads_on = LeadsOn(graph);
  for (std::size_t i = 0; i + 1 < graph.nodes.size(); ++i) {
    if (!leads_on[i]) continue;
    SetStep(walkable, i, true_length(i, i + 1).value_or(LengthIn(graph.nodes, i, i + 1)));
  }
  for (const GraphEdge& edge : graph.edges) {
    const std::optional<double> length = true_length(edge.from, edge.to);
    if (IsStep(edge) || !length) continue;
    const double mapped = LengthIn(graph.nodes, edge.from, edge.to);
    const double height = std::abs(truth[edge.from]->z - truth[edge.to]->z);
    if (std::abs(*length - mapped) <= tolerance.translation_m && height < kSameFloorHeight) {
      walkable.graph.AddEdge(edge.from, edge.to, *length);
    }
  }
  for (const auto& [a, b] : TrueRevisits(graph.nodes, truth, revisits)) {
    walkable.graph.AddEdge(a, b, *true_length(a, b));
  }
  return walkable;
}

/// Between nodes `before` and `before` + 1.
struct Place {
  std::size_t before = 0;
  double fraction = 0.0;
};

Place PlaceOf(const std::vector<StampedPose>& nodes, double stamp) {
  const auto behind =
      std::upper_bound(nodes.begin(), nodes.end(), stamp,
                       [](double value, const StampedPose& node) { return value < node.stamp; });
  const auto after = std::clamp<std::size_t>(static_cast<std::size_t>(behind - nodes.begin()), 1,
                                             nodes.size() - 1);
  const double begin = nodes[after - 1].stamp;
  const double duration = nodes[after].stamp - begin;
  return {after - 1, duration > 0.0 ? std::clamp((stamp - begin) / duration, 0.0, 1.0) : 0.0};
}

double ShortestWay(const Walkable& walkable, const Place& from, const Place& to) {
  const double from_step = walkable.steps[from.before];
  const double to_step = walkable.steps[to.before];
  const std::vector<double> lengths =
      walkable.graph.LengthsFrom({{from.before, from.fraction * from_step},
                                  {from.before + 1, (1.0 - from.fraction) * from_step}});
  const double around = std::min(lengths[to.before] + to.fraction * to_step,
                                 lengths[to.before + 1] + (1.0 - to.fraction) * to_step);
  if (from.before != to.before) return around;
  return std::min(around, std::abs(to.fraction - from.fraction) * from_step);
}

/// The error of ways of lengths `mapped` whose true lengths are `real`.
PathLengthError ErrorOf(const std::vector<double>& mapped, const std::vector<double>& real) {
  PathLengthError error;
  // Between drives that nothing ties there is no way.
  const auto is_known = [&](std::size_t i) {
    return std::isfinite(mapped[i]) && std::isfinite(real[i]);
  };
  double count = 0.0;
  for (std::size_t i = 0; i < mapped.size(); ++i) count += is_known(i) ? 1.0 : 0.0;
  std::vector<double> magnitudes;
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    if (!is_known(i)) continue;
    const double too_long = mapped[i] - real[i];
    magnitudes.push_back(std::abs(too_long));
    error.missing_m += std::max(too_long, 0.0) / count;
    error.false_m += std::max(-too_long, 0.0) / count;
  }
  error.error_m = StatisticsOf(magnitudes);
  return error;
}

std::vector<double> ShortestWays(const Walkable& walkable, const std::vector<StampedPose>& nodes,
                                 const std::vector<StampPair>& pairs) {
  std::vector<double> lengths;
  lengths.reserve(pairs.size());
  for (const StampPair& pair : pairs) {
    lengths.push_back(ShortestWay(walkable, PlaceOf(nodes, pair.from), PlaceOf(nodes, pair.to)));
  }
  return lengths;
}

}  // namespace

std::vector<StampPair> DrawStampPairs(double first, double last, const PathLengthOptions& options) {
  std::mt19937_64 generator(options.seed);
  const auto draw = [&] {  // 53 bits, the same on every standard library
    return first + static_cast<double>(generator() >> 11) * 0x1p-53 * (last - first);
  };
  std::vector<StampPair> pairs(options.pairs);
  for (StampPair& pair : pairs) {
    pair.from = draw();
    pair.to = draw();
  }
  return pairs;
}

std::optional<PathLengthError> ComparePathLengths(
    const MappedGraph& graph, const std::vector<std::optional<StampedPose>>& truth,
    const std::vector<StampPair>& pairs, const ClosureTolerance& tolerance,
    const RevisitOptions& revisits) {
  const bool known =
      std::any_of(truth.begin(), truth.end(), [](const auto& pose) { return pose.has_value(); });
  if (graph.nodes.size() < 2 || !known || pairs.empty()) return std::nullopt;
  return ErrorOf(ShortestWays(AsMapped(graph), graph.nodes, pairs),
                 ShortestWays(AsItIs(graph, truth, tolerance, revisits), graph.nodes, pairs));
}

std::optional<PathLengthError> CompareWithCheckedMaps(const MappedGraph& graph,
                                                      const std::vector<MappedGraph>& checked,
                                                      const std::vector<StampPair>& pairs) {
  const auto walkable = [](const MappedGraph& map) { return map.nodes.size() >= 2; };
  if (!walkable(graph) || checked.empty() || pairs.empty()) return std::nullopt;
  if (!std::all_of(checked.begin(), checked.end(), walkable)) return std::nullopt;
  std::vector<double> shortest(pairs.size(), std::numeric_limits<double>::infinity());
  for (const MappedGraph& map : checked) {
    const std::vector<double> lengths = ShortestWays(AsMapped(map), map.nodes, pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      shortest[i] = std::min(shortest[i], lengths[i]);
    }
  }
  return ErrorOf(ShortestWays(AsMapped(graph), graph.nodes, pairs), shortest);
}

}  // namespace masked_mapper
