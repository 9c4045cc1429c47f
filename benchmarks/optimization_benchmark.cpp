// SPDX-License-Identifier: BSD-3-Clause
// Solving pose graphs: the public ones from the odometry they come with, a graph that grows by one
// closure at a time, and the last audit.
#include <benchmark/benchmark.h>

#include <optional>
#include <random>
#include <string>

#include "masked_mapper/optimization/pose_graph_optimizer.hpp"
#include "optimization/g2o_graph.hpp"

namespace masked_mapper {
namespace {

void SolvePublicGraph(benchmark::State& state, const std::string& file) {
  const std::optional<PoseGraph> graph =
      ReadG2o(std::string(MASKED_MAPPER_REAL_LOGS) + "/g2o/" + file);
  if (!graph) {
    state.SkipWithError("the public graph is not at hand");
    return;
  }
  OptimizationSummary summary;
  for (auto _ : state) {
    state.PauseTiming();
    PoseGraph copy = *graph;
    state.ResumeTiming();
    summary = Optimize({}, copy);
  }
  state.counters["chi2"] = summary.final_chi2;
  state.counters["iterations"] = summary.iterations;
}
BENCHMARK_CAPTURE(SolvePublicGraph, M3500, "M3500.g2o")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SolvePublicGraph, INTEL, "INTEL.g2o")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SolvePublicGraph, MITb, "MITb.g2o")->Unit(benchmark::kMillisecond);

// Rounds of a street grid, 5 m a node, solved; every closure's error is as its covariance says.
PoseGraph StreetGrid(int nodes) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d sigma(0.03, 0.03, 0.005);
  const auto measured = [&](const Pose2& T) {
    return UncertainPose2{{T.x + sigma.x() * normal(random), T.y + sigma.y() * normal(random),
                           T.theta + sigma.z() * normal(random)},
                          sigma.cwiseAbs2().asDiagonal()};
  };
  PoseGraph graph;
  graph.AddFloor({});
  const int side = 40;
  Pose2 T;
  for (NodeId i = 0; i < nodes; ++i) {
    // Lanes up and down, lane after lane, round after round.
    const int step = i % (side * side);
    const int lane = step / side;
    const int along = lane % 2 == 0 ? step % side : side - 1 - step % side;
    T = {5.0 * lane, 5.0 * along, lane % 2 == 0 ? kPi / 2 : -kPi / 2};
    Node node;
    node.T_world_robot = T;
    graph.AddNode(node);
    if (i == 0) continue;
    const auto close = [&](NodeId other, EdgeKind kind) {
      const Pose2& T_other = graph.nodes()[static_cast<std::size_t>(other)].T_world_robot;
      graph.AddEdge({other, i, measured(Between(T_other, T)), kind});
    };
    close(i - 1, EdgeKind::kOdometry);
    if (i >= side * side) close(i - side * side, EdgeKind::kClosure);
    if (lane > 0 && i % 5 == 0) close(i - 2 * (step % side) - 1, EdgeKind::kClosure);
  }
  Optimize({}, graph);
  return graph;
}

// One more closure that pulls by 0.3 m, on a graph that is solved.
template <typename Solve>
void OneMoreClosure(benchmark::State& state, Solve&& solve) {
  const PoseGraph solved = StreetGrid(static_cast<int>(state.range(0)));
  const auto last = static_cast<NodeId>(solved.nodes().size() - 1);
  const NodeId other = last - 79;
  PoseGraph graph = solved;
  Edge edge;
  edge.from = last;
  edge.to = other;
  edge.kind = EdgeKind::kClosure;
  edge.T_from_to.covariance = Eigen::Vector3d(1e-2, 1e-2, 1e-4).asDiagonal();
  edge.T_from_to.mean = Between(solved.nodes()[static_cast<std::size_t>(last)].T_world_robot,
                                solved.nodes()[static_cast<std::size_t>(other)].T_world_robot) *
                        Pose2{0.3, 0.0, 0.0};
  for (auto _ : state) {
    state.PauseTiming();
    graph = solved;
    PoseGraphOptimizer optimizer({});
    optimizer.Update(graph);
    graph = solved;
    graph.AddEdge(edge);
    state.ResumeTiming();
    solve(optimizer, graph);
  }
}

void AddClosureUpdate(benchmark::State& state) {
  OneMoreClosure(state,
                 [](PoseGraphOptimizer& optimizer, PoseGraph& graph) { optimizer.Update(graph); });
}
BENCHMARK(AddClosureUpdate)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMillisecond);

void AddClosureFullSolve(benchmark::State& state) {
  OneMoreClosure(state, [](PoseGraphOptimizer&, PoseGraph& graph) { Optimize({}, graph); });
}
BENCHMARK(AddClosureFullSolve)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMillisecond);

// Wrong closures planted on a graph that is solved; none: what the audit costs when all is right.
void Audit(benchmark::State& state) {
  PoseGraph graph = StreetGrid(1000);
  const auto planted = static_cast<NodeId>(state.range(0));
  for (NodeId i = 0; i < planted; ++i) {
    const NodeId a = 950 - 37 * i;
    const NodeId b = 30 + 23 * i;
    const Pose2 T_a_b = Between(graph.nodes()[static_cast<std::size_t>(a)].T_world_robot,
                                graph.nodes()[static_cast<std::size_t>(b)].T_world_robot);
    graph.AddEdge({a,
                   b,
                   {T_a_b * Pose2{3.0, 1.0, 0.2}, 1e-3 * Eigen::Matrix3d::Identity()},
                   EdgeKind::kClosure});
  }
  std::size_t found = 0;
  for (auto _ : state) {
    state.PauseTiming();
    PoseGraph copy = graph;
    state.ResumeTiming();
    found = AuditClosures({}, {}, copy).size();
  }
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(Audit)->Arg(0)->Arg(1)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace masked_mapper
