// SPDX-License-Identifier: BSD-3-Clause
// Gauss-Newton by Ceres: Levenberg-Marquardt that starts with next to no damping, since a warm
// start is close; Ceres shrinks the region by itself where a step fails.
#include "masked_mapper/optimization/pose_graph_optimizer.hpp"

#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>
#include <ceres/version.h>
#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numeric>
#include <utility>
#include <vector>

#include "edge_residual.hpp"
#include "masked_mapper/pose_graph/dijkstra_projection.hpp"

namespace masked_mapper {
namespace {

using PoseBlock = std::array<double, 3>;

class EdgeCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit EdgeCost(const UncertainPose2& T_from_to) : residual_(T_from_to) {}

  bool Evaluate(const double* const* poses, double* residual, double** jacobians) const override {
    residual_.Evaluate(poses[0], poses[1], residual, jacobians ? jacobians[0] : nullptr,
                       jacobians ? jacobians[1] : nullptr);
    return true;
  }

 private:
  EdgeResidual residual_;
};

// Ceres logs through glog, which writes to standard error unless told not to; a library is silent.
class QuietCeres {
 public:
  QuietCeres() : before_(FLAGS_minloglevel) { FLAGS_minloglevel = google::GLOG_FATAL; }
  ~QuietCeres() { FLAGS_minloglevel = before_; }
  QuietCeres(const QuietCeres&) = delete;
  QuietCeres& operator=(const QuietCeres&) = delete;

 private:
  int before_;
};

ceres::Solver::Options SolverOptions(const OptimizerOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // As fast as SuiteSparse here, and no BLAS in it: the same bytes whichever BLAS a machine has.
#if CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR < 2
  solver.sparse_linear_algebra_library_type = ceres::CX_SPARSE;
#else  // which Ceres has no more
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
#endif
  solver.num_threads = 1;  // more may not repeat bit for bit
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.initial_trust_region_radius = 1e16;
  solver.max_trust_region_radius = 1e32;
  solver.jacobi_scaling = false;  // measured: all columns are of one kind, scaling only costs
  solver.logging_type = ceres::SILENT;
  return solver;
}

std::vector<PoseBlock> PosesOf(const PoseGraph& graph) {
  std::vector<PoseBlock> poses;
  poses.reserve(graph.nodes().size());
  for (const Node& node : graph.nodes()) {
    poses.push_back({node.T_world_robot.x, node.T_world_robot.y, node.T_world_robot.theta});
  }
  return poses;
}

// What a solve takes in: edges, and the nodes at their ends that it must not move.
struct Part {
  std::vector<EdgeId> edges;
  std::vector<NodeId> fixed;
};

using Costs = std::deque<EdgeCost>;  // one for each edge of a part; Ceres holds pointers to them

Costs CostsOf(const PoseGraph& graph, const Part& part) {
  Costs costs;
  for (const EdgeId id : part.edges) {
    costs.emplace_back(graph.edges()[static_cast<std::size_t>(id)].T_from_to);
  }
  return costs;
}

double Chi2(const PoseGraph& graph, const Part& part, const Costs& costs,
            const std::vector<PoseBlock>& poses) {
  double chi2 = 0.0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const Edge& edge = graph.edges()[static_cast<std::size_t>(part.edges[i])];
    const double* const ends[2] = {poses[static_cast<std::size_t>(edge.from)].data(),
                                   poses[static_cast<std::size_t>(edge.to)].data()};
    double residual[3];
    costs[i].Evaluate(ends, residual, nullptr);
    chi2 += residual[0] * residual[0] + residual[1] * residual[1] + residual[2] * residual[2];
  }
  return chi2;
}

// The lowest node of every connected component, in order: what the gauge is fixed to.
std::vector<NodeId> FirstOfEachComponent(const PoseGraph& graph) {
  std::vector<NodeId> first;
  std::vector<bool> seen(graph.nodes().size(), false);
  std::vector<NodeId> open;
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    if (seen[i]) continue;
    first.push_back(static_cast<NodeId>(i));
    seen[i] = true;
    open.push_back(static_cast<NodeId>(i));
    while (!open.empty()) {
      const NodeId node = open.back();
      open.pop_back();
      for (const EdgeId id : graph.EdgesOf(node)) {
        const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
        const NodeId next = edge.from == node ? edge.to : edge.from;
        if (seen[static_cast<std::size_t>(next)]) continue;
        seen[static_cast<std::size_t>(next)] = true;
        open.push_back(next);
      }
    }
  }
  return first;
}

std::vector<PoseBlock> ProjectedPoses(const PoseGraph& graph, const std::vector<NodeId>& gauge) {
  std::vector<PoseBlock> poses = PosesOf(graph);
  for (const NodeId root : gauge) {
    const Pose2 T_world_root = graph.nodes()[static_cast<std::size_t>(root)].T_world_robot;
    for (const ProjectedNode& projected : DijkstraProjection(graph, root)) {
      const Pose2 T = T_world_root * projected.T_source_node.mean;
      poses[static_cast<std::size_t>(projected.node)] = {T.x, T.y, T.theta};
    }
  }
  return poses;
}

struct Solution {
  std::vector<PoseBlock> poses;
  double chi2 = 0.0;
  int iterations = 0;
  bool converged = false;
};

Solution SolveFrom(std::vector<PoseBlock> start, const OptimizerOptions& options,
                   const PoseGraph& graph, const Part& part, Costs& costs) {
  const QuietCeres quiet;
  Solution solution{std::move(start)};
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.disable_all_safety_checks = true;
  ceres::Problem problem(ownership);
  const auto block = [&](NodeId node) {
    return solution.poses[static_cast<std::size_t>(node)].data();
  };
  // Edges come in the order of ids, so that the elimination order is the same every time.
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const Edge& edge = graph.edges()[static_cast<std::size_t>(part.edges[i])];
    problem.AddResidualBlock(&costs[i], nullptr, block(edge.from), block(edge.to));
  }
  for (const NodeId fixed : part.fixed) {
    if (problem.HasParameterBlock(block(fixed))) problem.SetParameterBlockConstant(block(fixed));
  }
  ceres::Solver::Summary solved;
  ceres::Solve(SolverOptions(options), &problem, &solved);
  solution.chi2 = 2.0 * solved.final_cost;
  solution.iterations = static_cast<int>(solved.iterations.size()) - 1;
  solution.converged = solved.termination_type == ceres::CONVERGENCE;
  return solution;
}

void SetPoses(const std::vector<PoseBlock>& poses, PoseGraph& graph) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    graph.SetPose(static_cast<NodeId>(i), {poses[i][0], poses[i][1], WrapAngle(poses[i][2])});
  }
}

// Ours: poses whose residuals are on average ten times what the covariances promise may lie outside
// the basin of the right minimum (a long loop that closes for the first time with its heading far
// off).
bool FitsPoorly(double chi2, std::size_t edges) {
  constexpr double kPoorRatio = 100.0;
  return chi2 > kPoorRatio * 3.0 * static_cast<double>(edges);
}

// How far two poses that ought to be one are apart, as a multiple of what is settled.
double Unsettled(const UpdateOptions& options, const Pose2& one, const Pose2& other) {
  return std::max(Distance(one, other) / options.settled_m,
                  std::abs(WrapAngle(one.theta - other.theta)) / DegToRad(options.settled_deg));
}

double PullOf(const UpdateOptions& options, const PoseGraph& graph, const Edge& edge) {
  const Pose2 T_from_to =
      Between(graph.node(edge.from).T_world_robot, graph.node(edge.to).T_world_robot);
  return Unsettled(options, T_from_to, edge.T_from_to.mean);
}

// The nodes nearest to the ends of `edges`, by number of edges, `count` of them or a few more.
std::vector<NodeId> NodesAround(const PoseGraph& graph, const std::vector<EdgeId>& edges,
                                std::size_t count) {
  std::vector<NodeId> nodes;
  std::vector<bool> seen(graph.nodes().size(), false);
  const auto see = [&](NodeId node) {
    if (seen[static_cast<std::size_t>(node)]) return;
    seen[static_cast<std::size_t>(node)] = true;
    nodes.push_back(node);
  };
  for (const EdgeId id : edges) {
    see(graph.edges()[static_cast<std::size_t>(id)].from);
    see(graph.edges()[static_cast<std::size_t>(id)].to);
  }
  for (std::size_t i = 0; i < nodes.size() && nodes.size() < count; ++i) {
    for (const EdgeId id : graph.EdgesOf(nodes[i])) {
      see(graph.edges()[static_cast<std::size_t>(id)].from);
      see(graph.edges()[static_cast<std::size_t>(id)].to);
    }
  }
  return nodes;
}

// All edges that touch `moving`; what they lead to beyond stays, and node 0 always. A component
// that moves as a whole is held at its first node.
Part PartAround(const PoseGraph& graph, const std::vector<NodeId>& moving) {
  Part part;
  std::vector<bool> moves(graph.nodes().size(), false);
  for (const NodeId node : moving) moves[static_cast<std::size_t>(node)] = node != 0;
  for (const NodeId node : moving) {
    const std::vector<EdgeId>& edges = graph.EdgesOf(node);
    part.edges.insert(part.edges.end(), edges.begin(), edges.end());
  }
  std::sort(part.edges.begin(), part.edges.end());
  part.edges.erase(std::unique(part.edges.begin(), part.edges.end()), part.edges.end());
  for (const EdgeId id : part.edges) {
    const Edge& edge = graph.edges()[static_cast<std::size_t>(id)];
    for (const NodeId end : {edge.from, edge.to}) {
      if (!moves[static_cast<std::size_t>(end)]) part.fixed.push_back(end);
    }
  }
  if (part.fixed.empty()) {
    part.fixed.push_back(*std::min_element(moving.begin(), moving.end()));
  }
  return part;
}

}  // namespace

OptimizationSummary Optimize(const OptimizerOptions& options, PoseGraph& graph) {
  OptimizationSummary summary;
  summary.converged = true;
  if (graph.edges().empty()) return summary;

  Part whole;
  whole.edges.resize(graph.edges().size());
  std::iota(whole.edges.begin(), whole.edges.end(), 0);
  whole.fixed = FirstOfEachComponent(graph);
  Costs costs = CostsOf(graph, whole);
  std::vector<PoseBlock> poses = PosesOf(graph);
  summary.initial_chi2 = Chi2(graph, whole, costs, poses);

  Solution solution;
  const bool poor_start = FitsPoorly(summary.initial_chi2, costs.size());
  if (poor_start) {
    // The projection spreads over closures and odometry at once, by the surest paths.
    solution = SolveFrom(ProjectedPoses(graph, whole.fixed), options, graph, whole, costs);
  }
  if (!poor_start || !solution.converged || FitsPoorly(solution.chi2, costs.size())) {
    Solution warm = SolveFrom(std::move(poses), options, graph, whole, costs);
    warm.iterations += solution.iterations;
    if (!poor_start || warm.chi2 < solution.chi2) solution = std::move(warm);
  }

  summary.final_chi2 = solution.chi2;
  summary.iterations = solution.iterations;
  summary.converged = solution.converged;
  SetPoses(solution.poses, graph);
  return summary;
}

PoseGraphOptimizer::PoseGraphOptimizer(const UpdateOptions& options) : options_(options) {}

OptimizationSummary PoseGraphOptimizer::Update(PoseGraph& graph) {
  OptimizationSummary summary;
  summary.converged = true;
  // Where edges were removed, ids mean other edges now; Optimize() has seen to the poses.
  known_edges_ = std::min(known_edges_, graph.edges().size());
  // An edge that is settled can be unsettled only by a solve that moves one of its ends, and every
  // solve takes in all edges of what it moves: it need not be looked at again.
  std::vector<EdgeId> pulling;
  double pull = 0.0;
  for (; known_edges_ < graph.edges().size(); ++known_edges_) {
    const double off = PullOf(options_, graph, graph.edges()[known_edges_]);
    if (off < 1.0) continue;
    pulling.push_back(static_cast<EdgeId>(known_edges_));
    pull = std::max(pull, off);
  }
  if (pulling.empty()) return summary;

  std::vector<PoseBlock> poses = PosesOf(graph);
  constexpr std::size_t kGrowth = 3;
  auto count = static_cast<std::size_t>(std::max(2, options_.first_part_nodes));
  for (bool first = true; pull <= options_.far_off; first = false, count *= kGrowth) {
    const std::vector<NodeId> moving = NodesAround(graph, pulling, count);
    if (2 * moving.size() > graph.nodes().size()) break;
    if (!first && moving.size() * kGrowth < count) return summary;  // that was the whole component
    const Part part = PartAround(graph, moving);
    Costs costs = CostsOf(graph, part);
    summary.initial_chi2 = Chi2(graph, part, costs, poses);
    Solution solution = SolveFrom(std::move(poses), options_.solver, graph, part, costs);
    summary.final_chi2 = solution.chi2;
    summary.iterations = solution.iterations;
    summary.converged = solution.converged;
    poses = std::move(solution.poses);
    double moved = 0.0;
    for (const NodeId node : moving) {
      const PoseBlock& pose = poses[static_cast<std::size_t>(node)];
      const Pose2 T_world_robot{pose[0], pose[1], WrapAngle(pose[2])};
      moved = std::max(moved, Unsettled(options_, graph.node(node).T_world_robot, T_world_robot));
      graph.SetPose(node, T_world_robot);
    }
    // What holds out against its surroundings may ask for more than they can give.
    const bool holds_out = std::any_of(pulling.begin(), pulling.end(), [&](EdgeId id) {
      return PullOf(options_, graph, graph.edge(id)) >= 1.0;
    });
    if (moved < 1.0 && !holds_out) return summary;
  }
  return Optimize(options_.solver, graph);
}

double EdgeChi2(const PoseGraph& graph, const Edge& edge) {
  return EdgeResidual(edge.T_from_to)
      .Chi2(graph.nodes()[static_cast<std::size_t>(edge.from)].T_world_robot,
            graph.nodes()[static_cast<std::size_t>(edge.to)].T_world_robot);
}

}  // namespace masked_mapper
