// SPDX-License-Identifier: BSD-3-Clause
// What a new node costs before and after matching: Dijkstra projection, candidates, loop
// validation.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "loop_closure/evidence_validator.hpp"
#include "loop_closure/vote_validator.hpp"
#include "masked_mapper/loop_closure/loop_closer.hpp"
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"

namespace masked_mapper {
namespace {

// A drive along the lanes of a grid, over and over: closures to the rounds before, right to a few
// centimetres, and where every tenth match is wrong.
class GridDrive {
 public:
  explicit GridDrive(int nodes) {
    graph_.AddFloor({});
    for (NodeId i = 0; i < nodes; ++i) {
      const int step = i % (kSide * kSide);
      const int lane = step / kSide;
      const int along = lane % 2 == 0 ? step % kSide : kSide - 1 - step % kSide;
      Node node;
      node.T_world_robot = {5.0 * lane, 5.0 * along, lane % 2 == 0 ? kPi / 2 : -kPi / 2};
      node.scan = 0;
      graph_.AddNode(node);
      if (i > 0) graph_.AddEdge({i - 1, i, Measured(i - 1, i, 1.0), EdgeKind::kOdometry});
    }
  }

  // Matches of a node with those of earlier rounds at its place and next to it.
  std::vector<Closure> Matches(NodeId newer) {
    std::uniform_int_distribution<int> ten(0, 9);
    std::vector<Closure> matches;
    for (NodeId round = newer - kSide * kSide; round >= 0; round -= kSide * kSide) {
      for (const NodeId older : {round, round + 1}) {
        if (matches.size() >= 5) return matches;
        Closure match;
        match.older = older;
        match.newer = newer;
        match.T_older_newer = Measured(older, newer, 1.0);
        if (ten(random_) == 0) {
          match.T_older_newer.mean = match.T_older_newer.mean * Pose2{1.0, 1.0, 0.3};
        }
        matches.push_back(match);
      }
    }
    return matches;
  }

  void Close(const Closure& match) {
    graph_.AddEdge({match.older, match.newer, match.T_older_newer, EdgeKind::kClosure});
  }

  const PoseGraph& graph() const { return graph_; }

 private:
  static constexpr int kSide = 30;

  UncertainPose2 Measured(NodeId a, NodeId b, double scale) {
    std::normal_distribution<double> normal;
    const Eigen::Vector3d sigma = scale * Eigen::Vector3d(0.04, 0.04, 0.006);
    const Pose2 T = Between(graph_.nodes()[static_cast<std::size_t>(a)].T_world_robot,
                            graph_.nodes()[static_cast<std::size_t>(b)].T_world_robot);
    return {{T.x + sigma.x() * normal(random_), T.y + sigma.y() * normal(random_),
             T.theta + sigma.z() * normal(random_)},
            sigma.cwiseAbs2().asDiagonal()};
  }

  std::mt19937 random_{1};
  PoseGraph graph_;
};

void Project(benchmark::State& state) {
  GridDrive drive(static_cast<int>(state.range(0)));
  for (NodeId a = 900; a < static_cast<NodeId>(state.range(0)); a += 3) {
    for (const Closure& match : drive.Matches(a)) drive.Close(match);
  }
  const auto source = static_cast<NodeId>(state.range(0) - 1);
  for (auto _ : state) benchmark::DoNotOptimize(DijkstraProjection(drive.graph(), source));
}
BENCHMARK(Project)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMicrosecond);

void Candidates(benchmark::State& state) {
  const GridDrive drive(static_cast<int>(state.range(0)));
  const auto source = static_cast<NodeId>(state.range(0) - 1);
  const std::vector<ProjectedNode> projection = DijkstraProjection(drive.graph(), source);
  for (auto _ : state) {
    benchmark::DoNotOptimize(FindCandidates(drive.graph(), source, projection, {}));
  }
}
BENCHMARK(Candidates)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMicrosecond);

// All matches of a drive over many rounds, judged as they come.
template <class Validator, class... Options>
void JudgeDrive(benchmark::State& state, const Options&... options) {
  double judged = 0.0;
  double validated = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    GridDrive drive(static_cast<int>(state.range(0)));
    Validator validator(options...);
    std::vector<Closure> closures;
    judged = validated = 0.0;
    for (NodeId a = 900; a < static_cast<NodeId>(state.range(0)); a += 10) {
      std::vector<ClosureId> ids;
      for (const Closure& match : drive.Matches(a)) {
        ids.push_back(static_cast<ClosureId>(closures.size()));
        closures.push_back(match);
      }
      state.ResumeTiming();
      const std::vector<ClosureId> valid = validator.Judge(drive.graph(), ids, closures);
      state.PauseTiming();
      judged += static_cast<double>(ids.size());
      validated += static_cast<double>(valid.size());
      for (const ClosureId id : valid) drive.Close(closures[static_cast<std::size_t>(id)]);
    }
    state.ResumeTiming();
  }
  state.counters["hypotheses"] = judged;
  state.counters["validated"] = validated;
}
void JudgeByEvidence(benchmark::State& state) { JudgeDrive<EvidenceValidator>(state); }
void JudgeByVotes(benchmark::State& state) { JudgeDrive<VoteValidator>(state, ValidatorOptions()); }
BENCHMARK(JudgeByEvidence)->Arg(5000)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(JudgeByVotes)->Arg(5000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace masked_mapper
